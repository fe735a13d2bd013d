//! How far a closed polygon is from lying in a plane: the energy that the annealing of the paper minimizes.
//!
//! Based on: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, section 3.1 (E_PE, d_PE, n_i).

use crate::math::Vec3;

/// `E_PE`: the sum, over all vertices, of the angle in radians between the planes of the corners there and at the
/// next vertex, from 0 to π/2 each. O(m).
///
/// It is zero for every planar polygon. With the angle between the normals as vectors, each change between a
/// convex and a concave corner would cost π in the plane, and concavities would not be kept, as the paper
/// wants them to be.
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
