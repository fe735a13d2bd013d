//! The rim of a hole as the sections read it: positions, normals, and distances along it. `O(m)` for `m` rim vertices.

use crate::error::{Error, Result};
use crate::hole::Hole;
use crate::math::{Vec3, unit};

/// A closed polygon in the patch's orientation, with normals of the known surface along it.
#[derive(Clone, Debug)]
pub(super) struct Rim {
    pub(super) points: Vec<Vec3>,
    /// Unit normal of the known triangle at each edge.
    pub(super) edge_normals: Vec<Vec3>,
    /// Unit normal of the known surface at each vertex. If there are none, those of the edges are used.
    pub(super) vertex_normals: Option<Vec<Vec3>>,
    /// See [`mean_edge_length`]; `EdgeLen` in the paper.
    pub(super) edge_length: f64,
    /// Distance of each vertex along the rim from the first one, and the perimeter.
    pub(super) arcs: Vec<f64>,
}

impl Rim {
    pub(super) fn new(
        points: Vec<Vec3>,
        edge_normals: Vec<Vec3>,
        vertex_normals: Option<Vec<Vec3>>,
        edge_length: f64,
    ) -> Self {
        let mut arcs = Vec::with_capacity(points.len() + 1);
        arcs.push(0.0);
        for (i, p) in points.iter().enumerate() {
            arcs.push(arcs[i] + (points[(i + 1) % points.len()] - p).norm());
        }
        Self {
            points,
            edge_normals,
            vertex_normals,
            edge_length,
            arcs,
        }
    }

    /// The number of vertices.
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether a vertex lies strictly between two places, given by their distances along the rim.
    pub(super) fn has_vertex_between(&self, from: f64, to: f64) -> bool {
        let arcs = &self.arcs[..self.len()];
        let next = arcs.partition_point(|a| *a <= from);
        let before = arcs.partition_point(|a| *a < to);
        if from < to {
            next < before
        } else {
            next < arcs.len() || before > 0
        }
    }

    pub(super) fn perimeter(&self) -> f64 {
        self.arcs[self.points.len()]
    }
}

/// Refuses holes with islands and rims that pass a vertex twice. Sections need one simple curve.
///
/// # Errors
/// [`crate::ErrorKind::Topology`].
pub(super) fn check_simple(hole: &Hole) -> Result<()> {
    let mut seen = vec![false; hole.rim().len()];
    let is_simple = hole.polygon.len() == hole.rim().len()
        && hole
            .polygon
            .iter()
            .all(|&v| !std::mem::replace(&mut seen[v as usize], true));
    if is_simple {
        return Ok(());
    }
    Err(Error::topology(
        "the hole has an island, or its rim passes a vertex twice; methods with sections need one simple curve",
    ))
}

/// The normals of the known triangles along the rim. A triangle without area gets the normal of the last one before it
/// that has an area.
///
/// # Errors
/// [`crate::ErrorKind::Geometry`] if none has an area.
pub(super) fn edge_normals(hole: &Hole) -> Result<Vec<Vec3>> {
    let m = hole.polygon.len();
    let Some(first) = hole.outside_normals.iter().position(Option::is_some) else {
        return Err(Error::geometry("no triangle along the rim has an area"));
    };
    let mut normals = vec![Vec3::zeros(); m];
    let mut last = Vec3::zeros();
    for k in 0..m {
        let i = (first + k) % m;
        last = hole.outside_normals[i].unwrap_or(last);
        normals[i] = unit(last);
    }
    Ok(normals)
}

/// Mean edge length of the known triangles that touch the rim, but at most 1, the mean length of the rim's edges. The
/// bound matters on a horn, whose triangles can be long in the direction away from the rim.
pub(super) fn mean_edge_length(hole: &Hole) -> f64 {
    let around = &hole.surroundings;
    let rim_count = hole.rim().len();
    let (mut sum, mut count) = (0.0, 0.0);
    for t in around.triangles() {
        if t.iter().all(|&v| v as usize >= rim_count) {
            continue;
        }
        for k in 0..3 {
            sum += (around.point(t[k]) - around.point(t[(k + 1) % 3])).norm();
            count += 1.0;
        }
    }
    if sum > 0.0 {
        (sum / count).min(1.0)
    } else {
        1.0
    }
}
