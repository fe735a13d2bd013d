//! A closed polyline in space as a hole: nothing lies round it but what its normals say.

use super::hole::{Hole, LocalIndex};
use crate::error::{Error, ErrorKind, Result};
use crate::math::{Vec3, cross_normal, unit};
use crate::patch::{HoleShape, Surroundings};

/// Rings of triangles made up round the rim: what the method of the highest order reads.
const RINGS: usize = 2;

impl Hole {
    /// The hole that the closed polyline through `points` bounds. The patch runs along it in its direction.
    ///
    /// `normals`, one for each vertex, make the surroundings: [`RINGS`] rings of triangles that go on from the rim
    /// outwards, perpendicular to the normals and as wide as the edges are long. Without normals, or where a
    /// normal is along the polyline, there is nothing round the rim.
    ///
    /// # Errors
    /// [`ErrorKind::Geometry`] when all points coincide or the polyline is too long for double precision.
    pub(super) fn of_polyline(points: &[Vec3], normals: Option<&[Vec3]>) -> Result<Self> {
        let n = points.len();
        let next = |i: usize| (i + 1) % n;
        let center = points.iter().sum::<Vec3>() / n as f64;
        let lengths: Vec<f64> = (0..n)
            .map(|i| (points[next(i)] - points[i]).norm())
            .collect();
        let scale = lengths.iter().sum::<f64>() / n as f64;
        if !(scale.is_finite() && center.iter().all(|c| c.is_finite())) {
            return Err(geometry("the polyline is too long for double precision"));
        }
        if scale == 0.0 {
            return Err(geometry("the points of the polyline coincide"));
        }
        let rim: Vec<Vec3> = points.iter().map(|p| (p - center) / scale).collect();
        let edge_lengths: Vec<f64> = (0..n)
            .map(|i| (lengths[(i + n - 1) % n] + lengths[i]) / (2.0 * scale))
            .collect();
        let surroundings = normals
            .and_then(|normals| surroundings(&rim, normals, &edge_lengths))
            .unwrap_or_default();
        let outside_normals = (0..n)
            .map(|i| {
                let t = surroundings.triangles.get(2 * i)?;
                let corner = |v: u32| match (v as usize).checked_sub(n) {
                    Some(outside) => surroundings.points[outside],
                    None => rim[v as usize],
                };
                let normal = unit(cross_normal(&corner(t[0]), &corner(t[1]), &corner(t[2])));
                (normal != Vec3::zeros()).then_some(normal)
            })
            .collect();
        let mut joined: Vec<(u32, u32)> = (0..n)
            .map(|i| (i.min(next(i)) as u32, i.max(next(i)) as u32))
            .collect();
        joined.sort_unstable();
        Ok(Self {
            rim: (0..n as u32).collect(),
            // No triangle lies there; that there is one says that the edge is on the rim and no bridge.
            outside_faces: vec![Some(0); n],
            shape: HoleShape {
                points: rim,
                polygon: (0..n as u32).collect(),
                outside_normals,
                edge_lengths,
                surroundings,
                joined,
            },
            halfedges: Vec::new(),
            rim_index: LocalIndex::new((0..n as u32).map(|i| (i, i)).collect()),
            center,
            scale,
            is_in_mesh: false,
        })
    }
}

/// The polyline as the only loop of a mesh without triangles.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] for fewer than three points, or normals that are not one for each point or not
/// finite.
pub(super) fn check(points: &[[f64; 3]], normals: Option<&[[f64; 3]]>) -> Result<()> {
    let invalid = |message: String| Err(Error::new(ErrorKind::InvalidInput, message));
    if points.len() < 3 {
        return invalid(format!(
            "a polyline of {} points encloses no area",
            points.len()
        ));
    }
    let Some(normals) = normals else {
        return Ok(());
    };
    if normals.len() != points.len() {
        return invalid(format!(
            "{} normals for {} points",
            normals.len(),
            points.len()
        ));
    }
    match normals
        .iter()
        .position(|n| !n.iter().all(|c| c.is_finite()))
    {
        Some(i) => invalid(format!("normal {i} is not finite")),
        None => Ok(()),
    }
}

/// Rings of triangles round the rim. `None` when some vertex has no direction outwards.
fn surroundings(rim: &[Vec3], normals: &[Vec3], widths: &[f64]) -> Option<Surroundings> {
    let n = rim.len();
    let outwards: Option<Vec<Vec3>> = (0..n)
        .map(|i| {
            let along = unit(rim[(i + 1) % n] - rim[(i + n - 1) % n]);
            let outwards = unit(along.cross(&unit(normals[i])));
            (outwards != Vec3::zeros()).then_some(outwards)
        })
        .collect();
    let outwards = outwards?;
    let mut around = Surroundings::default();
    for ring in 1..=RINGS {
        for i in 0..n {
            let width = ring as f64 * widths[i];
            around.points.push(rim[i] + outwards[i] * width);
            around.levels.push(ring as u32);
        }
        let (inner, outer) = (((ring - 1) * n) as u32, (ring * n) as u32);
        for i in 0..n as u32 {
            let j = (i + 1) % n as u32;
            // Against the polyline, as the triangles on the other side of an edge run.
            around.triangles.push([inner + j, inner + i, outer + i]);
            around.triangles.push([inner + j, outer + i, outer + j]);
        }
    }
    Some(around)
}

fn geometry(message: &str) -> Error {
    Error::new(ErrorKind::Geometry, message)
}
