//! A closed polyline in space as a hole: nothing lies round it but what its normals say.

use super::cut::MeshPlace;
use crate::error::{Error, Result};
use crate::hole::Hole;
use crate::math::{Vec3, cross_normal, unit};
use crate::surroundings::Surroundings;

/// Rings of triangles made up round the rim: what the method of the highest order reads.
const RINGS: usize = 2;

/// What is known round a closed polyline, which is the only loop of a mesh without triangles.
#[derive(Debug)]
pub(crate) struct Polyline {
    normals: Option<Vec<Vec3>>,
}

impl Polyline {
    /// The polyline through `points`.
    ///
    /// # Errors
    /// [`InvalidInput`](crate::ErrorKind::InvalidInput) for fewer than three points, or normals that are not one for
    /// each point or not finite.
    pub(super) fn new(points: &[[f64; 3]], normals: Option<&[[f64; 3]]>) -> Result<Self> {
        check(points, normals)?;
        let normals = normals.map(|n| n.iter().map(|&n| Vec3::from(n)).collect());
        Ok(Self { normals })
    }

    /// The hole that the polyline through `points` bounds. The patch runs along it in its direction.
    ///
    /// Normals make the surroundings: [`RINGS`] rings of triangles that go on from the rim outwards, perpendicular to
    /// the normals and as wide as the edges are long. Without normals, or where a normal is along the polyline, there is
    /// nothing round the rim.
    ///
    /// # Errors
    /// [`Geometry`](crate::ErrorKind::Geometry) when all points coincide or the polyline is too long for double
    /// precision.
    pub(super) fn cut_out(&self, points: &[Vec3]) -> Result<(Hole, MeshPlace)> {
        let n = points.len();
        let next = |i: usize| (i + 1) % n;
        let center = points.iter().sum::<Vec3>() / n as f64;
        let lengths: Vec<f64> = (0..n)
            .map(|i| (points[next(i)] - points[i]).norm())
            .collect();
        let scale = lengths.iter().sum::<f64>() / n as f64;
        if !(scale.is_finite() && center.iter().all(|c| c.is_finite())) {
            let message = "the polyline is too long for double precision";
            return Err(Error::geometry(message));
        }
        if scale == 0.0 {
            return Err(Error::geometry("the points of the polyline coincide"));
        }
        let rim: Vec<Vec3> = points.iter().map(|p| (p - center) / scale).collect();
        let edge_lengths: Vec<f64> = (0..n)
            .map(|i| (lengths[(i + n - 1) % n] + lengths[i]) / (2.0 * scale))
            .collect();
        let normals = self.normals.as_deref();
        let surroundings = normals
            .and_then(|normals| surroundings(&rim, normals, &edge_lengths))
            .unwrap_or_else(|| Surroundings::bare(rim));
        let outside_normals = (0..n)
            .map(|i| {
                let t = surroundings.triangles().get(2 * i)?;
                let [a, b, c] = t.map(|v| surroundings.point(v));
                let normal = unit(cross_normal(&a, &b, &c));
                (normal != Vec3::zeros()).then_some(normal)
            })
            .collect();
        let mut joined: Vec<(u32, u32)> = (0..n)
            .map(|i| (i.min(next(i)) as u32, i.max(next(i)) as u32))
            .collect();
        joined.sort_unstable();
        let hole = Hole {
            surroundings,
            polygon: (0..n as u32).collect(),
            outside_normals,
            is_bridge: vec![false; n],
            edge_lengths,
            joined,
        };
        Ok((hole, MeshPlace::of_points(n, center, scale)))
    }
}

/// Fails for fewer than three points, or normals that are not one for each point or not finite.
fn check(points: &[[f64; 3]], normals: Option<&[[f64; 3]]>) -> Result<()> {
    let invalid = |message: String| Err(Error::invalid(message));
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
    let (mut points, mut levels) = (rim.to_vec(), vec![0; n]);
    let mut triangles = Vec::new();
    for ring in 1..=RINGS {
        for i in 0..n {
            let width = ring as f64 * widths[i];
            points.push(rim[i] + outwards[i] * width);
            levels.push(ring as u32);
        }
        let (inner, outer) = (((ring - 1) * n) as u32, (ring * n) as u32);
        for i in 0..n as u32 {
            let j = (i + 1) % n as u32;
            // Against the polyline, as the triangles on the other side of an edge run.
            triangles.push([inner + j, inner + i, outer + i]);
            triangles.push([inner + j, outer + i, outer + j]);
        }
    }
    Some(Surroundings::new(n, points, levels, triangles))
}
