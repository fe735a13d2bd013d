//! The shape of patches: smooth where it should be, and independent of place, size and names.

use super::{METHODS, all_but_the_largest, fill, with_method};
use crate::boundary::select::Selection;
use crate::fixtures::{self, Arrays};
use crate::math::Vec3;
use crate::methods::method::Method;
use crate::quality::deviation::compare;

fn sphere_with_hole() -> Arrays {
    fixtures::sphere(16).jittered(0.004, 21).cut(|c| c[2] > 0.7)
}

#[test]
fn flat_holes_get_flat_patches_by_every_method() {
    let sheet = fixtures::sheet_with_islands(2).mapped(|p| [p[0], p[1], 0.0]);
    for arrays in [sheet, fixtures::touching_holes(4)] {
        for method in METHODS {
            let filled = fill(&arrays, &all_but_the_largest(), &with_method(method));
            assert_eq!(filled.recounted(), 0);
            assert!(
                filled.new_points().iter().all(|p| p.z.abs() < 1e-9),
                "{method}"
            );
            let area = |triangles: &[[u32; 3]]| -> f64 {
                let corners = triangles.iter().map(|t| t.map(|v| filled.after.point(v)));
                corners
                    .map(|[a, b, c]| (b - a).cross(&(c - a)).z / 2.0)
                    .sum()
            };
            let whole = filled
                .boundary
                .loops
                .iter()
                .map(|l| l.vector_area[2])
                .sum::<f64>();
            let expected = -filled
                .boundary
                .loops
                .iter()
                .zip(&filled.report.holes)
                .filter(|(_, h)| h.status != crate::HoleStatus::Kept)
                .map(|(l, _)| l.vector_area[2])
                .sum::<f64>();
            assert!(
                (area(filled.new_triangles()) - expected).abs() < 1e-9,
                "{whole}"
            );
        }
    }
}

#[test]
fn a_faired_cap_meets_the_sphere_where_a_membrane_has_a_crease() {
    let arrays = sphere_with_hole();
    let of = |method| {
        let filled = fill(&arrays, &Selection::default(), &with_method(method));
        assert_eq!(filled.report.holes[0].method, Some(method));
        let off = |p: &Vec3| (p.norm() - 1.0).abs();
        let farthest = filled.new_points().iter().map(off).fold(0.0, f64::max);
        (filled.largest_crease_at_the_rims(), farthest)
    };
    let (membrane, c1, c2) = (of(Method::Membrane), of(Method::FairC1), of(Method::FairC2));
    assert!(
        membrane.0 > 0.5 && c1.0 < 0.35 && c2.0 < 0.35,
        "{membrane:?} {c1:?} {c2:?}"
    );
    assert!(
        membrane.1 > 0.2 && c1.1 < 0.06 && c2.1 < 0.03,
        "{membrane:?} {c1:?} {c2:?}"
    );
}

#[test]
fn new_triangles_are_as_regular_and_as_large_as_those_round_the_hole() {
    let arrays = sphere_with_hole();
    for method in [Method::Membrane, Method::FairC1, Method::FairC2] {
        let filled = fill(&arrays, &Selection::default(), &with_method(method));
        let hole = &filled.report.holes[0];
        assert!(
            hole.min_angle.is_some_and(|a| a > 0.35),
            "{method}: {:?}",
            hole.min_angle
        );
        let mean_area = |range: std::ops::Range<usize>| {
            let count = range.len() as f64;
            let areas = range.map(|f| {
                let [a, b, c] = filled.after.corners(f as u32);
                (b - a).cross(&(c - a)).norm() / 2.0
            });
            areas.sum::<f64>() / count
        };
        let old = filled.before.triangles().len();
        let ratio = mean_area(old..filled.after.triangles().len()) / mean_area(0..old);
        assert!((0.5..2.0).contains(&ratio), "{method}: {ratio}");
    }
}

#[test]
fn size_place_and_direction_do_not_change_the_shape() {
    let arrays = sphere_with_hole();
    for method in METHODS {
        let original = fill(&arrays, &Selection::default(), &with_method(method));
        for (scale, angle, offset) in [
            (1e-4, 0.0, [0.0; 3]),
            (1e4, 0.0, [0.0; 3]),
            (1.0, 1.0, [0.0; 3]),
            (1.0, 0.0, [2e4, -2e4, 1e4]),
            (1e-4, 2.0, [1.0, 2.0, -2.0]),
            (1e4, 3.0, [0.0, 2e8, 0.0]),
        ] {
            let moved = fill(
                &arrays.moved(scale, angle, offset),
                &Selection::default(),
                &with_method(method),
            );
            assert_eq!(moved.new_triangles(), original.new_triangles());
            let new = original.new_points().iter().map(|&p| p.into()).collect();
            let expected = Arrays::new(new, Vec::new()).moved(scale, angle, offset);
            for (p, q) in moved.new_points().iter().zip(&expected.positions) {
                let off = (p - Vec3::from(*q)).norm() / (2.0 * scale);
                assert!(off < 1e-6, "{method} {scale} {angle}: {off}");
            }
        }
    }
}

#[test]
fn the_order_of_vertices_and_triangles_does_not_change_the_shape() {
    let arrays = sphere_with_hole();
    for method in METHODS {
        let of = |arrays: &Arrays| fill(arrays, &Selection::default(), &with_method(method)).after;
        let original = of(&arrays);
        for seed in 0..4 {
            let other = of(&arrays.shuffled(seed));
            let apart = compare(
                other.positions(),
                other.triangles(),
                original.positions(),
                original.triangles(),
            );
            let apart = apart.unwrap();
            // In edges of the mesh, which are about 0.1 long.
            assert!(
                apart.symmetric_rms < 0.002,
                "{method} {seed}: {}",
                apart.symmetric_rms
            );
            assert!(
                apart.hausdorff < 0.03,
                "{method} {seed}: {}",
                apart.hausdorff
            );
        }
    }
}
