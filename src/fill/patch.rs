//! A patch that passed every check, with its place in the mesh, and what the report says of it.

use super::attributes::CarriedAttributes;
use super::report::{Attempt, HoleReport, HoleStatus};
use crate::boundary::opening::Opening;
use crate::error::{Error, ErrorKind};
use crate::math::Vec3;
use crate::math::aabb::Aabb;
use crate::mesh::trimesh::TriMesh;
use crate::methods::auto::prediction::Prediction;
use crate::methods::method::Method;
use crate::quality::self_intersection::AppendedPatch;

/// A patch that may be stitched into the mesh.
#[derive(Clone)]
pub(crate) struct Patch {
    pub(crate) method: Method,
    /// The other methods that were tried.
    pub(crate) tried: Vec<Attempt>,
    /// Rim vertices in the mesh.
    pub(super) rim: Vec<u32>,
    /// The edges that it closes, in the mesh's vertices and as its triangles run along them.
    pub(super) rim_edges: Vec<[u32; 2]>,
    /// New vertices in the mesh's coordinates.
    pub(super) points: Vec<Vec3>,
    /// Indices below the rim count are rim vertices, the others new ones.
    pub(super) triangles: Vec<[u32; 3]>,
    /// For each halfedge of the triangles the other one of its edge.
    pub(super) twins: Vec<u32>,
    pub(super) self_intersections: usize,
    pub(super) min_angle: f64,
    pub(super) attributes: CarriedAttributes,
    /// How the surface was predicted, if a method did so.
    pub(super) prediction: Option<Prediction>,
}

/// Why there is no patch, and what was tried.
#[derive(Clone)]
pub(crate) struct PatchFailure {
    pub(crate) error: Error,
    pub(crate) tried: Vec<Attempt>,
}

impl From<Error> for PatchFailure {
    fn from(error: Error) -> Self {
        Self {
            error,
            tried: Vec::new(),
        }
    }
}

/// A patch, or why there is none.
pub(crate) type Outcome = Result<Patch, PatchFailure>;

impl Patch {
    /// The triangles in the indices of a mesh with `vertex_count` vertices before the new ones.
    pub(super) fn triangles_after(&self, vertex_count: usize) -> Vec<[u32; 3]> {
        in_mesh(&self.rim, &self.triangles, vertex_count)
    }

    /// The patch as the tests for intersections see it.
    pub(super) fn appended<'a>(&'a self, triangles: &'a [[u32; 3]]) -> AppendedPatch<'a> {
        AppendedPatch {
            points: &self.points,
            triangles,
            twins: &self.twins,
        }
    }

    /// The box round it, rim included.
    pub(super) fn bounds(&self, mesh: &TriMesh) -> Aabb {
        let rim: Vec<Vec3> = self.rim.iter().map(|&v| mesh.point(v)).collect();
        let rim = Aabb::around(&rim);
        if self.points.is_empty() {
            rim
        } else {
            rim.union(&Aabb::around(&self.points))
        }
    }

    /// Enters the patch in the report of its hole, as appended to so many vertices and triangles.
    fn enter(&self, [vertices, triangles]: [usize; 2], report: &mut HoleReport) {
        report.method = Some(self.method);
        report.new_vertices = vertices as u32..(vertices + self.points.len()) as u32;
        report.new_triangles = triangles as u32..(triangles + self.triangles.len()) as u32;
        report.self_intersections = self.self_intersections;
        report.min_angle = Some(self.min_angle);
        report.prediction.clone_from(&self.prediction);
        report.tried.clone_from(&self.tried);
        if self.self_intersections > 0 {
            report.reason = format!("{} pairs of triangles intersect", self.self_intersections);
        }
    }
}

/// The triangles of a patch in the indices of a mesh with `vertex_count` vertices before the new ones.
pub(super) fn in_mesh(rim: &[u32], triangles: &[[u32; 3]], vertex_count: usize) -> Vec<[u32; 3]> {
    let global = |v: u32| match (v as usize).checked_sub(rim.len()) {
        Some(new) => (vertex_count + new) as u32,
        None => rim[v as usize],
    };
    triangles.iter().map(|t| t.map(global)).collect()
}

/// Enters in the reports of all rims of an opening, which are ordered by the loops' ids, how the filling ended: with a
/// patch that is appended to `size` vertices and triangles, or without one.
pub(super) fn record(
    opening: &Opening,
    outcome: Result<&Patch, &PatchFailure>,
    size: [usize; 2],
    seconds: f64,
    reports: &mut [HoleReport],
) {
    let outer = opening.id();
    for &id in opening.rims() {
        let Ok(i) = reports.binary_search_by_key(&id, |r| r.id) else {
            continue;
        };
        let report = &mut reports[i];
        report.clear();
        match outcome {
            Ok(_) => report.status = HoleStatus::Filled,
            Err(failure) => {
                report.status = match failure.error.kind() {
                    ErrorKind::Cancelled => HoleStatus::Cancelled,
                    _ => HoleStatus::Failed,
                };
                report.cause = Some(failure.error.kind());
                report.reason = failure.error.to_string();
            }
        }
        if id == outer {
            report.seconds = seconds;
            match outcome {
                Ok(patch) => patch.enter(size, report),
                Err(failure) => report.tried.clone_from(&failure.tried),
            }
        } else {
            report.reason = match outcome {
                Ok(_) => format!("joined to the patch of hole {outer}"),
                Err(_) => format!("with hole {outer}: {}", report.reason),
            };
        }
    }
}
