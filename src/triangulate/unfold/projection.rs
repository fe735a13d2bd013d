//! The last step of an unfolding: the polygon laid onto a plane, if that makes no two of its points meet.
//!
//! Based on: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, section 3.1.
//!
//! The motion is linear: a vertex with the height h above the plane has (1 - t) h at time t. For t < 1 that is
//! an affine map of the whole polygon, which never makes two points one. So the motion is free of crossings
//! just when its end is, that is when the projected polygon is simple; this is decided by exact predicates.

use super::super::simple_polygon::{Point2, find_contact};
use crate::math::Vec3;
use crate::math::plane::principal_axes;

/// The polygon projected onto its plane of least squares, if it is simple there.
pub(super) fn onto_best_plane(points: &[Vec3]) -> Option<Vec<Point2>> {
    let (centroid, axes) = principal_axes(points);
    simple(points, &centroid, &axes[0], &axes[1])
}

fn simple(points: &[Vec3], origin: &Vec3, x: &Vec3, y: &Vec3) -> Option<Vec<Point2>> {
    let flat: Vec<Point2> = points
        .iter()
        .map(|p| [(p - origin).dot(x), (p - origin).dot(y)])
        .collect();
    (flat.iter().flatten().all(|c| c.is_finite()) && find_contact(&flat).is_none()).then_some(flat)
}
