//! Shape of triangles: smallest angle and aspect ratio. All angles are in radians.

use super::{Surface, quantile};
use crate::math::{Vec3, cross_normal};

/// The smallest angle of a triangle in radians: zero when it has no area, NaN when a coordinate is
/// not finite.
pub(crate) fn smallest_angle([a, b, c]: &[Vec3; 3]) -> f64 {
    if a == b || b == c || c == a {
        return 0.0;
    }
    let double_area = cross_normal(a, b, c).norm();
    let angle = |tip: &Vec3, p: &Vec3, q: &Vec3| double_area.atan2((p - tip).dot(&(q - tip)));
    angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
}

/// Longest edge over the diameter of the inscribed circle, scaled so that the equilateral triangle
/// has one; infinite when the triangle has no area.
pub(crate) fn aspect_ratio([a, b, c]: &[Vec3; 3]) -> f64 {
    let lengths = [(b - a).norm(), (c - b).norm(), (a - c).norm()];
    let longest = lengths[0].max(lengths[1]).max(lengths[2]);
    let double_area = cross_normal(a, b, c).norm();
    if double_area > 0.0 {
        longest * lengths.iter().sum::<f64>() / (12f64.sqrt() * double_area)
    } else {
        f64::INFINITY
    }
}

/// The triangle shapes of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShapeSummary {
    /// Smallest of all angles, in radians.
    pub(crate) smallest_angle: f64,
    /// The smallest angle that 95 % of the triangles exceed, in radians.
    pub(crate) angle_p5: f64,
    /// Mean over the triangles of the smallest angle, in radians.
    pub(crate) angle_mean: f64,
    /// Largest aspect ratio.
    pub(crate) worst_aspect: f64,
    /// Mean aspect ratio; infinite when any triangle has no area.
    pub(crate) aspect_mean: f64,
}

/// Summarises the triangle shapes; `None` when there is no triangle.
///
/// O(n log n) for n triangles.
pub(crate) fn summarize(surface: Surface<'_>) -> Option<ShapeSummary> {
    let faces = 0..surface.triangles.len();
    let mut angles: Vec<f64> = faces
        .clone()
        .map(|f| smallest_angle(&surface.corners(f)))
        .collect();
    angles.sort_unstable_by(f64::total_cmp);
    let count = angles.len() as f64;
    let aspects = faces.map(|f| aspect_ratio(&surface.corners(f)));
    let (worst_aspect, aspect_sum) = aspects.fold((0.0, 0.0), |(worst, sum): (f64, f64), x| {
        (worst.max(x), sum + x)
    });
    Some(ShapeSummary {
        smallest_angle: *angles.first()?,
        angle_p5: quantile(&angles, 0.05)?,
        angle_mean: angles.iter().sum::<f64>() / count,
        worst_aspect,
        aspect_mean: aspect_sum / count,
    })
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
        assert!((aspect_ratio(&equilateral) - 1.0).abs() < 1e-12);
        let half_square = [o, Vec3::x(), Vec3::y()];
        assert!((smallest_angle(&half_square).to_degrees() - 45.0).abs() < 1e-12);
        let expected = 2f64.sqrt() * (2.0 + 2f64.sqrt()) / 12f64.sqrt();
        assert!((aspect_ratio(&half_square) - expected).abs() < 1e-12);
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
            assert_eq!(aspect_ratio(&t), f64::INFINITY, "{t:?}");
        }
    }

    #[test]
    fn the_summary_is_over_all_triangles_and_empty_has_none() {
        assert_eq!(
            summarize(Surface {
                points: &[],
                triangles: &[]
            }),
            None
        );
        let points = [
            Vec3::zeros(),
            Vec3::x(),
            Vec3::y(),
            Vec3::new(0.5, 0.75f64.sqrt(), 0.0),
        ];
        let surface = Surface {
            points: &points,
            triangles: &[[0, 1, 2], [0, 1, 3], [0, 1, 1]],
        };
        let summary = summarize(surface).expect("there are triangles");
        assert_eq!(summary.smallest_angle, 0.0);
        assert!((summary.angle_mean.to_degrees() - 35.0).abs() < 1e-12);
        assert!((summary.angle_p5.to_degrees() - 4.5).abs() < 1e-12);
        assert_eq!(summary.worst_aspect, f64::INFINITY);
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
            prop_assert!(aspect_ratio(&t) >= 1.0 - 1e-9);
            prop_assert!((aspect_ratio(&t) / aspect_ratio(&turned) - 1.0).abs() < 1e-6);
        }
    }
}
