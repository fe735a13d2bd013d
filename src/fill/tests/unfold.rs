//! Filling by unfolding: rims that no disk can close, and what the patches promise.

use super::{all_but_the_largest, fill, with_method};
use crate::boundary::select::Selection;
use crate::fill::report::HoleStatus;
use crate::fixtures::{self, Arrays};
use crate::hole::Hole;
use crate::job::UNLIMITED;
use crate::math::{Vec3, unit};
use crate::methods::method::Method;
use crate::methods::task::Task;
use crate::surroundings::Surroundings;
use std::f64::consts::TAU;

const METHODS: [Method; 2] = [Method::UnfoldArea, Method::UnfoldFairing];

/// A closed band of `2 m` triangles along the curve `at`, whose width turns `turns` times round it, starting across
/// the plane z = 0.
fn band(m: usize, at: impl Fn(f64) -> Vec3, width: f64, turns: f64) -> Arrays {
    let mut positions = Vec::new();
    for i in 0..m {
        let t = TAU * i as f64 / m as f64;
        let tangent = unit(at(t + 1e-3) - at(t - 1e-3));
        let out = at(t) - Vec3::z() * at(t).z;
        let x = unit(out - tangent * out.dot(&tangent));
        let y = tangent.cross(&x);
        let side = (y * (turns * t).cos() + x * (turns * t).sin()) * (0.5 * width);
        positions.push((at(t) - side).into());
        positions.push((at(t) + side).into());
    }
    let triangles = (0..m as u32).flat_map(|i| {
        let (a, b) = (2 * i, 2 * i + 1);
        let (c, d) = (2 * i + 3, 2 * i + 2);
        let wrapped = |v: u32| v % (2 * m as u32);
        [[a, b, wrapped(c)], [a, wrapped(c), wrapped(d)]]
    });
    Arrays::new(positions, triangles.collect())
}

fn trefoil(t: f64) -> Vec3 {
    Vec3::new(
        t.sin() + 2.0 * (2.0 * t).sin(),
        t.cos() - 2.0 * (2.0 * t).cos(),
        -(3.0 * t).sin(),
    )
}

fn circle(t: f64) -> Vec3 {
    Vec3::new(t.cos(), t.sin(), 0.0)
}

#[test]
fn knotted_rims_fail_with_the_reason() {
    let mut not_unfolded = 0;
    for turns in -4..=4 {
        let mesh = band(60, trefoil, 0.2, f64::from(turns));
        for method in METHODS {
            let filled = fill(&mesh, &Selection::default(), &with_method(method));
            for hole in &filled.report.holes {
                assert_eq!(hole.status, HoleStatus::Failed, "{turns}: {hole:?}");
                let is_linked = hole.reason.contains("is linked with loop");
                assert!(
                    is_linked || hole.reason.contains("was not unfolded"),
                    "{hole:?}"
                );
                not_unfolded += usize::from(!is_linked);
            }
        }
    }
    // For one number of turns the two rims of the band are not linked with each other.
    assert_eq!(not_unfolded, 4);
}

#[test]
fn linked_rims_fail_with_the_reason_and_others_are_filled() {
    for (turns, is_linked) in [(0.0, false), (1.0, true), (-1.0, true), (2.0, true)] {
        let mesh = band(60, circle, 0.3, turns);
        for method in METHODS {
            let filled = fill(&mesh, &Selection::default(), &with_method(method));
            for hole in &filled.report.holes {
                if is_linked {
                    assert_eq!(hole.status, HoleStatus::Failed);
                    assert!(
                        hole.reason.contains("is linked with loop"),
                        "{}",
                        hole.reason
                    );
                } else {
                    assert_eq!(hole.status, HoleStatus::Filled, "{}", hole.reason);
                    assert_eq!(hole.method, Some(method));
                }
            }
        }
    }
}

#[test]
fn a_hole_that_winds_round_a_cylinder_is_filled_without_intersections() {
    let at = |i: usize, j: usize| {
        let t = TAU * i as f64 / 40.0;
        [t.cos(), t.sin(), 0.16 * j as f64]
    };
    let tube = fixtures::grid(41, 30, at).cut(|c| {
        let t = c[1].atan2(c[0]).rem_euclid(TAU);
        let along = c[2] - 1.2 - 0.25 * t;
        (0.4..TAU - 0.4).contains(&t) && along.abs() < 0.4
    });
    for method in METHODS {
        let filled = fill(&tube, &all_but_the_largest(), &with_method(method));
        let holes = filled.report.holes.iter();
        for hole in holes.filter(|h| h.status != HoleStatus::Kept) {
            assert_eq!(hole.status, HoleStatus::Filled, "{}", hole.reason);
            assert_eq!(hole.self_intersections, 0);
            // The fairing overshoots at so coarse a rim and leaves it to the other method.
            assert_eq!(hole.method, Some(Method::UnfoldArea), "{:?}", hole.tried);
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits() {
    let mesh = band(60, circle, 0.3, 0.0).jittered(0.01, 3);
    for solver in ["descent", "annealing"] {
        let mut options = with_method(Method::UnfoldFairing);
        options.set("unfold.solver", solver).unwrap();
        options.set("unfold.restarts", "3").unwrap();
        options.seed = 5;
        let run = || fill(&mesh, &Selection::default(), &options);
        let bits = |f: &super::Filled| super::bits(f.after.positions());
        assert_eq!(bits(&run()), bits(&run()));
    }
}

/// A regular polygon as a hole without surroundings, in which `joined` pairs have edges already.
fn regular_hole(m: u32, joined: Vec<(u32, u32)>) -> Hole {
    let radius = 0.5 / (TAU / f64::from(2 * m)).sin();
    let corner = |i: u32| circle(TAU * f64::from(i) / f64::from(m)) * radius;
    Hole {
        surroundings: Surroundings::bare((0..m).map(corner).collect()),
        polygon: (0..m).collect(),
        outside_normals: vec![None; m as usize],
        edge_lengths: vec![1.0; m as usize],
        is_bridge: vec![false; m as usize],
        joined,
    }
}

#[test]
fn chords_that_the_mesh_has_as_edges_are_not_made_again() {
    let options = crate::FillOptions::default();
    for m in [4, 5, 6, 9] {
        let all: Vec<(u32, u32)> = (0..m)
            .flat_map(|i| (i + 1..m).map(move |j| (i, j)))
            .collect();
        let hole = regular_hole(m, all);
        let task = Task::new(&hole, &options, &UNLIMITED);
        let surface = (Method::UnfoldArea.spec().make)(&task).unwrap();
        for t in &surface.triangles {
            for k in 0..3 {
                let (a, b) = (t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3]));
                let is_rim = b == a + 1 || (a == 0 && b == m - 1);
                assert!(b >= m || is_rim, "{m}: {a} {b}");
            }
        }
    }
}
