//! Tests: unfolds curves whose knot type is known.

use super::super::distance::Clearances;
use super::super::energy::planarity;
use super::*;
use crate::job::Job;
use rand::RngExt;
use std::f64::consts::TAU;

/// Lower bound on the distance of a tangled curve from itself. A curve with much less room could not move.
const KEPT: f64 = 0.2;

fn circle(m: usize) -> Vec<Vec3> {
    (0..m)
        .map(|i| {
            let angle = TAU * i as f64 / m as f64;
            Vec3::new(angle.cos(), angle.sin(), 0.0) * (m as f64 / TAU)
        })
        .collect()
}

fn trefoil(m: usize) -> Vec<Vec3> {
    (0..m)
        .map(|i| {
            let t = TAU * i as f64 / m as f64;
            Vec3::new(
                t.sin() + 2.0 * (2.0 * t).sin(),
                t.cos() - 2.0 * (2.0 * t).cos(),
                -(3.0 * t).sin(),
            )
        })
        .collect()
}

/// A circle, deformed by random smooth motions toward a small ball. It never crosses itself, so it is not knotted.
fn tangle(m: usize, motions: usize, seed: u64) -> Vec<Vec3> {
    let mut points = circle(m);
    let mut generator = seeded(seed, 99);
    let mut clearances = Clearances::default();
    let radius = (m as f64).cbrt();
    let mut waves: Vec<(Vec3, Vec3, f64)> = Vec::new();
    for motion in 0..motions {
        if motion % 40 == 0 {
            waves = (0..3)
                .map(|_| {
                    let mut any = || Vec3::from_fn(|_, _| generator.random_range(-1.0..1.0));
                    let (a, b) = (any(), any());
                    (a, b * (2.0 / radius), generator.random_range(0.0..TAU))
                })
                .collect();
        }
        SegmentDistances::default().at_vertices(&points, 2.0, 0.0, &mut clearances);
        for (p, clearance) in points.iter_mut().zip(&clearances.distances) {
            let mut way = -*p * (0.3 * (1.0 - radius / p.norm().max(radius)));
            for (a, k, phase) in &waves {
                way += a * (k.dot(p) + phase).sin();
            }
            let limit = 0.45 * (clearance - KEPT).max(0.0);
            *p += way * (limit / way.norm().max(limit));
        }
    }
    points
}

fn annealing() -> UnfoldOptions {
    UnfoldOptions {
        solver: UnfoldSolver::Annealing,
        ..UnfoldOptions::default()
    }
}

/// A helical strip of `turns` about a cylinder, as wide as a fifth of its radius.
fn strip(m: usize, turns: f64) -> Vec<Vec3> {
    let half = m / 2;
    let side = |i: usize, height: f64| {
        let t = TAU * turns * i as f64 / (half - 1) as f64;
        Vec3::new(t.cos(), t.sin(), 0.1 * t + height)
    };
    (0..half)
        .map(|i| side(i, 0.0))
        .chain((0..half).rev().map(|i| side(i, 0.2)))
        .collect()
}

/// The distance of two segments by an independent method: golden-section search over the points of the first segment.
/// The distance to the second segment is a convex function of the point.
fn distance_slow(points: &[Vec3], i: usize, j: usize) -> f64 {
    let m = points.len();
    let (p, q, r, s) = (
        points[i],
        points[(i + 1) % m],
        points[j],
        points[(j + 1) % m],
    );
    let from = |x: f64| {
        let point = p + (q - p) * x;
        let along = (point - r).dot(&(s - r)) / (s - r).norm_squared();
        (point - r - (s - r) * along.clamp(0.0, 1.0)).norm()
    };
    let share = (5.0_f64.sqrt() - 1.0) / 2.0;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let (a, b) = (high - share * (high - low), low + share * (high - low));
        if from(a) < from(b) {
            high = b;
        } else {
            low = a;
        }
    }
    from(low).min(from(0.0)).min(from(1.0))
}

/// The smallest distance of segment `i` from the segments that share no vertex with it.
fn clearance_slow(points: &[Vec3], i: usize) -> f64 {
    let m = points.len();
    (0..m)
        .filter(|&j| i != j && (i + 1) % m != j && (j + 1) % m != i)
        .map(|j| distance_slow(points, i, j))
        .fold(f64::INFINITY, f64::min)
}

fn smallest_distance_slow(points: &[Vec3]) -> f64 {
    (0..points.len())
        .map(|i| clearance_slow(points, i))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn a_planar_convex_curve_has_no_energy_and_is_projected_as_it_is() {
    let circle = circle(40);
    assert!(planarity(&circle) < 1e-6);
    let unfolding = unfold(&circle, &UnfoldOptions::default(), 0, &Job::unlimited()).unwrap();
    assert_eq!((unfolding.runs, unfolding.steps), (0, 0));
    assert!((unfolding.length_ratio - 1.0).abs() < 1e-12);
    assert!((unfolding.winding.abs() - 1.0).abs() < 1e-12);
}

#[test]
fn every_planar_curve_is_without_energy_and_a_corner_out_of_it_is_not() {
    let mut dented: Vec<Vec3> = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]]
        .map(|[x, y]| Vec3::new(x, y, 7.0))
        .to_vec();
    assert!(planarity(&dented) < 1e-6);
    dented[1].z = 8.0;
    assert!(planarity(&dented) > 0.1);
    // Three edges of a cube, twice: each two successive corners lie in planes at right angles.
    let cube = [
        [0, 0, 0],
        [1, 0, 0],
        [1, 1, 0],
        [1, 1, 1],
        [0, 1, 1],
        [0, 0, 1],
    ];
    let cube: Vec<Vec3> = cube.map(|p| Vec3::from(p.map(f64::from))).to_vec();
    assert!((planarity(&cube) - 6.0 * TAU / 4.0).abs() < 1e-9);
}

#[test]
fn a_trefoil_is_never_unfolded() {
    for m in [24, 60, 150] {
        let error =
            unfold(&trefoil(m), &UnfoldOptions::default(), 0, &Job::unlimited()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Knotted);
        assert!(error.message().contains("not unfolded"), "{error}");
    }
    let options = UnfoldOptions {
        restarts: Some(5),
        ..annealing()
    };
    let error = unfold(&trefoil(60), &options, 0, &Job::unlimited()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Knotted);
}

#[test]
fn a_strip_that_winds_round_a_cylinder_is_unfolded() {
    for turns in [0.5, 1.0, 1.5] {
        let unfolding = unfold(
            &strip(80, turns),
            &UnfoldOptions::default(),
            0,
            &Job::unlimited(),
        )
        .unwrap();
        assert_eq!(
            crate::triangulate::simple_polygon::find_contact(&unfolding.polygon, &Job::unlimited())
                .unwrap(),
            None
        );
        assert!((unfolding.winding.abs() - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_curve_that_meets_itself_or_is_not_finite_is_refused() {
    let mut curve = strip(40, 1.0);
    curve[30] = curve[2];
    let error = unfold(&curve, &UnfoldOptions::default(), 0, &Job::unlimited()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Geometry);
    curve[30].x = f64::NAN;
    for curve in [&curve[..], &curve[..2]] {
        let error = unfold(curve, &UnfoldOptions::default(), 0, &Job::unlimited()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
    }
    let error = unfold(
        &[Vec3::x(); 7],
        &UnfoldOptions::default(),
        0,
        &Job::unlimited(),
    )
    .unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Geometry);
}

#[test]
fn the_work_can_be_stopped() {
    for options in [UnfoldOptions::default(), annealing()] {
        let error = unfold(&trefoil(50), &options, 0, &Job::new(&|| true)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Cancelled);
    }
}

#[test]
fn seed_and_curve_decide_every_bit() {
    let curve = strip(60, 1.2);
    for solver in [UnfoldSolver::Descent, UnfoldSolver::Annealing] {
        let options = UnfoldOptions {
            solver,
            restarts: Some(2),
            ..UnfoldOptions::default()
        };
        let run = |seed| unfold(&curve, &options, seed, &Job::unlimited());
        assert_eq!(run(7), run(7));
        // Powers of two scale without rounding.
        let scaled: Vec<Vec3> = curve.iter().map(|p| p * 1024.0).collect();
        assert_eq!(run(7), unfold(&scaled, &options, 7, &Job::unlimited()));
    }
}

#[test]
fn distances_are_those_of_a_slow_search() {
    let mut generator = seeded(5, 0);
    for m in [4, 5, 9, 20] {
        for _ in 0..20 {
            let points: Vec<Vec3> = (0..m)
                .map(|_| Vec3::from_fn(|_, _| generator.random_range(-1.0..1.0)))
                .collect();
            let mut distances = SegmentDistances::default();
            let smallest = distances.smallest(&points);
            assert!((smallest - smallest_distance_slow(&points)).abs() < 1e-7);
            let mut clearances = Clearances::default();
            distances.at_vertices(&points, 0.4, 0.2, &mut clearances);
            for (v, found) in clearances.distances.iter().enumerate() {
                let slow = clearance_slow(&points, v).min(clearance_slow(&points, (v + m - 1) % m));
                assert!((found - slow.min(0.4)).abs() < 1e-7, "{found} {slow}");
            }
        }
    }
}

#[test]
fn no_accepted_step_brings_segments_together() {
    for seed in 0..3 {
        let curve = in_mean_edges(&strip(30, 1.1)).unwrap();
        let epsilon = UnfoldOptions::default().epsilon;
        let mut descent = Descent::new(&curve, epsilon, Some(seeded(seed, 0)));
        for _ in 0..30 {
            descent.step();
            assert!(smallest_distance_slow(descent.points()) > epsilon);
        }
        let options = annealing();
        let mut annealing = Annealing::new(&curve, &options, seeded(seed, 1));
        let mut accepted = 0;
        while accepted < 30 {
            if annealing.step() {
                accepted += 1;
                assert!(smallest_distance_slow(annealing.points()) > epsilon);
            }
        }
    }
}

#[test]
fn badly_tangled_unknots_are_unfolded() {
    for seed in 0..4 {
        let unfolding = unfold(
            &tangle(200, 100, seed),
            &UnfoldOptions::default(),
            0,
            &Job::unlimited(),
        );
        assert!((unfolding.unwrap().winding.abs() - 1.0).abs() < 1e-9);
    }
}
