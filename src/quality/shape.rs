//! Shape of triangles. All angles are in radians.

use crate::math::{Vec3, cross_normal};

/// The smallest angle of a triangle in radians: zero when it has no area, NaN when a coordinate is
/// not finite.
pub(crate) fn smallest_angle([a, b, c]: &[Vec3; 3]) -> f64 {
    if a == b || b == c || c == a {
        return 0.0;
    }
    // All three angles have the same opposite side, twice the area: the smallest has the longest adjacent one.
    let double_area = cross_normal(a, b, c).norm();
    let adjacent = |tip: &Vec3, p: &Vec3, q: &Vec3| (p - tip).dot(&(q - tip));
    double_area.atan2(
        adjacent(a, b, c)
            .max(adjacent(b, c, a))
            .max(adjacent(c, a, b)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_triangles_have_their_known_shape() {
        let o = Vec3::zeros();
        let equilateral = [o, Vec3::x(), Vec3::new(0.5, 0.75f64.sqrt(), 0.0)];
        assert!((smallest_angle(&equilateral).to_degrees() - 60.0).abs() < 1e-12);
        let half_square = [o, Vec3::x(), Vec3::y()];
        assert!((smallest_angle(&half_square).to_degrees() - 45.0).abs() < 1e-12);
    }

    #[test]
    fn triangles_without_area_are_the_worst() {
        let o = Vec3::zeros();
        for t in [
            [o, o, o],
            [o, o, Vec3::x()],
            [o, Vec3::x(), Vec3::x() * 3.0],
        ] {
            assert_eq!(smallest_angle(&t), 0.0, "{t:?}");
        }
    }

    proptest! {
        #[test]
        fn shape_does_not_depend_on_the_corner_order_and_stays_in_its_range(
            a in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0], b in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0],
            c in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0], scale in prop_oneof![Just(1.0), Just(1e-6), Just(1e6)],
        ) {
            let t = [a, b, c].map(|p| Vec3::from(p) * scale);
            let turned = [t[2], t[0], t[1]];
            let angle = smallest_angle(&t);
            prop_assert!((0.0..=60.0 + 1e-9).contains(&angle.to_degrees()));
            prop_assert!((angle - smallest_angle(&turned)).abs() < 1e-9);
        }
    }
}
