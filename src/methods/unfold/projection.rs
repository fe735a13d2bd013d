//! The last step of an unfolding: the polygon laid onto a plane, if that makes no two of its points meet.
//!
//! Based on: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, section 3.1.
//!
//! The motion is linear: a vertex with the height h above the plane has (1 - t) h at time t. For t < 1 that is
//! an affine map of the whole polygon, which never makes two points one. So the motion is free of crossings
//! just when its end is, that is when the projected polygon is simple; this is decided by exact predicates.

use crate::error::Result;
use crate::job::Job;
use crate::math::Vec3;
use crate::math::plane::principal_axes;
use crate::triangulate::simple_polygon::{Point2, find_contact};

/// The polygon projected onto its plane of least squares, if it is simple there.
///
/// # Errors
/// `Cancelled` when the job is stopped.
pub(super) fn onto_best_plane(points: &[Vec3], job: &Job<'_>) -> Result<Option<Vec<Point2>>> {
    let (centroid, [x, y, _]) = principal_axes(points);
    let flat: Vec<Point2> = points
        .iter()
        .map(|p| [(p - centroid).dot(&x), (p - centroid).dot(&y)])
        .collect();
    let is_simple =
        flat.iter().flatten().all(|c| c.is_finite()) && find_contact(&flat, job)?.is_none();
    Ok(is_simple.then_some(flat))
}
