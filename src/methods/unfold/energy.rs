//! The planarity energy of a closed polygon, which the annealing minimizes. It is zero for a polygon in a plane.
//!
//! Based on: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, section 3.1 (E_PE, d_PE, n_i).

use crate::math::Vec3;

/// `E_PE`: the sum of the angles between the planes of successive corners, in radians. Each angle is between 0 and π/2.
/// O(m).
///
/// The angle is that of planes, not of oriented normals. With oriented normals, each change between a convex and a
/// concave corner of a planar polygon would cost π, and the polygon would lose its concave corners.
pub(super) fn planarity(points: &[Vec3]) -> f64 {
    let m = points.len();
    let normal = |i: usize| {
        let middle = points[(i + 1) % m];
        (points[i % m] - middle).cross(&(points[(i + 2) % m] - middle))
    };
    let mut sum = 0.0;
    let mut here = normal(0);
    for i in 0..m {
        let next = normal(i + 1);
        sum += here.cross(&next).norm().atan2(here.dot(&next).abs());
        here = next;
    }
    sum
}
