//! The point of a triangle closest to a given point.
//!
//! It is the foot of the perpendicular if that lies inside, otherwise the closest point of the three edges. A triangle
//! that is too thin for an accurate normal is treated as its edges, so the result is a point of the triangle for every
//! input.

use crate::math::segments::closest_on_segment;
use crate::math::{Vec3, cross_normal};

/// A triangle is treated as its edges if twice its area, divided by the square of its longest edge, is below this. The
/// direction of its normal is then lost in rounding errors of the cross product (2^-52 for each term).
const FLAT: f64 = 1e-13;

/// The point of the triangle closest to `p`.
pub(crate) fn closest_on_triangle(p: &Vec3, [a, b, c]: &[Vec3; 3]) -> Vec3 {
    let normal = cross_normal(a, b, c);
    let normal_sq = normal.norm_squared();
    let longest_sq = (b - a)
        .norm_squared()
        .max((c - b).norm_squared())
        .max((a - c).norm_squared());
    let thin = normal_sq <= (FLAT * longest_sq).powi(2);
    let left_of = |from: &Vec3, to: &Vec3| normal.dot(&(to - from).cross(&(p - from))) >= 0.0;
    if !thin && left_of(a, b) && left_of(b, c) && left_of(c, a) {
        return p - normal * (normal.dot(&(p - a)) / normal_sq);
    }
    let mut best = closest_on_segment(p, a, b);
    for (from, to) in [(b, c), (c, a)] {
        let candidate = closest_on_segment(p, from, to);
        if (p - candidate).norm_squared() < (p - best).norm_squared() {
            best = candidate;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vec3(range: std::ops::Range<f64>) -> impl Strategy<Value = Vec3> {
        [range.clone(), range.clone(), range].prop_map(|[x, y, z]| Vec3::new(x, y, z))
    }

    /// The smallest distance over a fine barycentric grid.
    fn grid_distance(p: &Vec3, [a, b, c]: &[Vec3; 3]) -> f64 {
        let n = 60;
        let mut best = f64::INFINITY;
        for i in 0..=n {
            for j in 0..=n - i {
                let (u, v) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
                best = best.min((a + (b - a) * u + (c - a) * v - p).norm());
            }
        }
        best
    }

    proptest! {
        #[test]
        fn no_grid_point_is_closer_and_some_grid_point_is_nearly_as_close(
            p in vec3(-2.0..2.0), a in vec3(-1.0..1.0), b in vec3(-1.0..1.0), c in vec3(-1.0..1.0),
        ) {
            let distance = (closest_on_triangle(&p, &[a, b, c]) - p).norm();
            let grid = grid_distance(&p, &[a, b, c]);
            prop_assert!(distance <= grid + 1e-12);
            prop_assert!(grid <= distance + 0.1);
        }
    }

    #[test]
    fn every_region_gives_its_own_kind_of_answer() {
        let t = [
            Vec3::zeros(),
            Vec3::new(4.0, 0.0, 0.0),
            Vec3::new(0.0, 4.0, 0.0),
        ];
        for (p, expected) in [
            ([1.0, 1.0, 5.0], [1.0, 1.0, 0.0]),
            ([-1.0, -1.0, 1.0], [0.0, 0.0, 0.0]),
            ([6.0, -1.0, 0.0], [4.0, 0.0, 0.0]),
            ([2.0, -3.0, 1.0], [2.0, 0.0, 0.0]),
            ([4.0, 4.0, 0.0], [2.0, 2.0, 0.0]),
        ] {
            assert_eq!(closest_on_triangle(&p.into(), &t), Vec3::from(expected));
        }
    }

    #[test]
    fn degenerate_triangles_answer_with_a_point_of_theirs() {
        let o = Vec3::zeros();
        let x = Vec3::x();
        let p = Vec3::new(0.5, 1.0, 0.0);
        assert_eq!(closest_on_triangle(&p, &[o, o, o]), o);
        assert_eq!(closest_on_triangle(&p, &[o, o, x]), x * 0.5);
        assert_eq!(closest_on_triangle(&p, &[o, x * 0.25, x]), x * 0.5);
        let sliver = [o, x, Vec3::new(0.5, 1e-15, 0.0)];
        assert!((closest_on_triangle(&p, &sliver) - x * 0.5).norm() < 1e-12);
    }
}
