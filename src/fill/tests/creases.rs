//! Creases and corners that run into holes, on shapes whose missing part is known.

use super::{Filled, all_but_the_largest, fill, with_method};
use crate::boundary::select::Selection;
use crate::fixtures::{Arrays, cube, grid, sheet, sphere, torus};
use crate::methods::method::Method;

/// The height of a sheet.
type Height = fn(f64, f64) -> f64;

/// What lies on the shape, by its distance.
type Distance = fn([f64; 3]) -> f64;

/// Fills by `auto`; everything that holds for any fill is checked.
fn filled(arrays: &Arrays, selection: &Selection) -> Filled {
    let filled = fill(arrays, selection, &with_method(Method::Auto));
    filled.check();
    filled
}

/// Creases in all patches.
fn crease_count(filled: &Filled) -> usize {
    let predictions = filled
        .report
        .holes
        .iter()
        .filter_map(|h| h.prediction.as_ref());
    predictions.map(|p| p.crease_count).sum()
}

fn reasons(filled: &Filled) -> Vec<&str> {
    let predictions = filled
        .report
        .holes
        .iter()
        .filter_map(|h| h.prediction.as_ref());
    predictions
        .filter_map(|p| p.without_creases.as_deref())
        .collect()
}

/// The largest distance of new vertices and of the centers of new triangles from the shape: a triangle across a
/// crease has a center off it.
fn deviation(filled: &Filled, distance: impl Fn([f64; 3]) -> f64) -> f64 {
    let points = filled.after.positions();
    let old = filled.before.positions().len();
    let centers = filled.new_triangles().iter().map(|t| {
        let [a, b, c] = t.map(|v| points[v as usize]);
        [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0)
    });
    let all = points[old..].iter().copied().chain(centers);
    all.map(distance).fold(0.0, f64::max)
}

fn from_cube(p: [f64; 3]) -> f64 {
    let largest = p.iter().fold(0.0, |a: f64, c| a.max(c.abs()));
    (largest - 1.0).abs()
}

/// Without the triangles nearer to `at` than `radius`.
fn cut_ball(arrays: &Arrays, at: [f64; 3], radius: f64) -> Arrays {
    arrays.cut(|c| {
        let squared: f64 = c.iter().zip(&at).map(|(c, a)| (c - a) * (c - a)).sum();
        squared < radius * radius
    })
}

#[test]
fn edges_and_corners_of_a_cube_come_back() {
    let whole = cube(16);
    let holes = [([1.0, 1.0, 0.1], 1), ([0.2, -1.0, 1.0], 1), ([1.0; 3], 3)];
    for (at, count) in holes {
        let filled = filled(&cut_ball(&whole, at, 0.4), &Selection::default());
        assert_eq!(crease_count(&filled), count, "{:?}", reasons(&filled));
        let deviation = deviation(&filled, from_cube);
        assert!(deviation < 1e-9, "{at:?}: {deviation:e}");
    }
}

#[test]
fn the_answer_turns_with_the_model() {
    let whole = cut_ball(&cube(16), [1.0, 1.0, 1.0], 0.45);
    let moved = whole.moved(100.0, 0.7, [3.0, -5.0, 40.0]);
    let back = |p: [f64; 3]| {
        let shifted = Arrays::new(vec![[p[0] - 3.0, p[1] + 5.0, p[2] - 40.0]], Vec::new());
        shifted.moved(0.01, -0.7, [0.0; 3]).positions[0]
    };
    let filled = filled(&moved, &Selection::default());
    assert_eq!(crease_count(&filled), 3, "{:?}", reasons(&filled));
    assert!(deviation(&filled, |p| from_cube(back(p))) < 1e-9);
}

#[test]
fn valleys_and_ridges_come_back() {
    let shapes: [(Height, usize); 2] = [
        (|x, _| (x - 12.0).abs(), 1),
        (|x, _| -2.0 * (x - 12.0).abs(), 1),
    ];
    for (i, (height, count)) in shapes.into_iter().enumerate() {
        let whole = sheet(24, height);
        let holed = whole.cut(|c| (c[0] - 12.0).hypot(c[1] - 12.3) < 4.4);
        let filled = filled(&holed, &all_but_the_largest());
        assert_eq!(crease_count(&filled), count, "{i}: {:?}", reasons(&filled));
        let deviation = deviation(&filled, |p| (p[2] - height(p[0], p[1])).abs());
        assert!(deviation < 1e-9, "{i}: {deviation:e}");
    }
}

#[test]
fn the_round_edge_of_a_cylinder_comes_back() {
    // The lid from half the radius outwards, then the side: part of the way round.
    let whole = grid(60, 16, |i, j| {
        let (sin, cos) = (i as f64 * 0.05).sin_cos();
        let r = 0.5 + 0.0625 * j.min(8) as f64;
        let z = -0.0625 * j.saturating_sub(8) as f64;
        [r * cos, -r * sin, z]
    });
    let holed = cut_ball(&whole, [0.0, -1.0, 0.0], 0.25);
    let filled = filled(&holed, &all_but_the_largest());
    assert_eq!(crease_count(&filled), 1, "{:?}", reasons(&filled));
    let distance: Distance = |p| {
        let side = (p[0].hypot(p[1]) - 1.0).abs();
        side.min(p[2].abs())
    };
    // Triangles of this size leave a round wall by 4e-4.
    let deviation = deviation(&filled, distance);
    assert!(deviation < 1e-3, "{deviation}");
}

#[test]
fn smooth_and_coarse_surfaces_have_no_creases() {
    for (whole, at, radius) in [
        (sphere(4), [0.6, 0.6, 0.5], 0.5),
        (sphere(12), [0.6, 0.6, 0.5], 0.5),
        (sphere(12).jittered(0.02, 3), [0.6, 0.6, 0.5], 0.5),
    ] {
        let filled = filled(&cut_ball(&whole, at, radius), &Selection::default());
        assert_eq!(crease_count(&filled), 0);
    }
    let ring = torus(30, 12);
    let holed = ring.cut(|c| c[0] > 0.0 && c[1].abs() < 0.3);
    assert_eq!(crease_count(&filled(&holed, &Selection::default())), 0);
}

#[test]
fn creases_can_be_switched_off() {
    let holed = cut_ball(&cube(16), [1.0, 1.0, 0.1], 0.4);
    let mut options = with_method(Method::Auto);
    options.methods.auto.creases = false;
    let filled = fill(&holed, &Selection::default(), &options);
    assert_eq!(crease_count(&filled), 0);
    assert!(deviation(&filled, from_cube) > 1e-3);
}
