//! The last step of an unfolding: projects the polygon to its least squares plane, if the result is simple.
//!
//! The projection is a motion without crossings if the result is simple. Think of the heights above the plane as
//! multiplied by 1 - t, with t from 0 to 1. For t < 1 this is an affine map of space with an inverse, so no two points
//! meet. At t = 1, exact predicates decide whether the polygon is simple.
//!
//! Source: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, section 3.1. Cost: that of finding contacts, O(m log m) for most polygons.

use crate::error::Result;
use crate::job::Job;
use crate::math::Vec3;
use crate::math::plane::principal_axes;
use crate::triangulate::simple_polygon::{Point2, find_contact};

/// The polygon projected to its least squares plane; `None` if it is not simple there.
///
/// # Errors
/// `Cancelled` when the job is cancelled.
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
