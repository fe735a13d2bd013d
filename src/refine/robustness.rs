//! Tests: refinement of wrong, degenerate and random inputs.

use super::density::rim_sizes;
use super::fixtures::{
    check_invariants, connect, disc_rim, fan, fan_patch, refined, refined_with, star_rim,
};
use super::flip::count_violations;
use super::isotropic::{RefineOptions, refine};
use crate::error::ErrorKind;
use crate::job::UNLIMITED;
use crate::math::Vec3;
use crate::patch::PatchSurface;
use proptest::prelude::*;
use std::f64::consts::TAU;

#[test]
fn a_limit_leaves_the_patch_as_it_was() {
    let surface = fan_patch(disc_rim(50));
    let (mut out, mut sizes) = (surface.clone(), vec![1.0; 50]);
    let options = RefineOptions {
        max_vertices: 100,
        ..RefineOptions::new(&UNLIMITED)
    };
    let error = refine(&mut out, &mut sizes, &options, &|_, _| false).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Limit);
    assert_eq!((out, sizes), (surface.clone(), vec![1.0; 50]));
    // Coincident rim vertices with a size far below any edge run into the limit too.
    let (mut out, mut sizes) = (surface, vec![1e-9; 50]);
    let options = RefineOptions {
        max_vertices: 5000,
        ..RefineOptions::new(&UNLIMITED)
    };
    let error = refine(&mut out, &mut sizes, &options, &|_, _| false).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Limit);
}

#[test]
fn unusable_input_is_an_error() {
    let surface = fan_patch(disc_rim(8));
    let run = |surface: &PatchSurface, sizes: &[f64]| {
        let options = RefineOptions::new(&UNLIMITED);
        refine(
            &mut surface.clone(),
            &mut sizes.to_vec(),
            &options,
            &|_, _| false,
        )
        .map_err(|e| e.kind())
    };
    assert_eq!(run(&surface, &[1.0; 7]), Err(ErrorKind::InvalidInput));
    assert_eq!(run(&surface, &[0.0; 8]), Err(ErrorKind::InvalidInput));
    let mut broken = surface.clone();
    broken.points[3].y = f64::NAN;
    assert_eq!(run(&broken, &[1.0; 8]), Err(ErrorKind::InvalidInput));
    let mut broken = surface.clone();
    broken.triangles.push([0, 1, 2]);
    assert_eq!(run(&broken, &[1.0; 8]), Err(ErrorKind::Topology));
}

#[test]
fn scale_and_place_change_the_triangles_little_and_determinism_holds() {
    let surface = fan_patch(disc_rim(80));
    let (out, _) = refined(&surface);
    assert_eq!(refined(&surface).0, out, "same input, same bits");
    for scale in [2f64.powi(-30), 2f64.powi(40)] {
        let mut scaled = surface.clone();
        scaled.points.iter_mut().for_each(|p| *p *= scale);
        assert_eq!(refined(&scaled).0.triangles, out.triangles, "{scale}");
    }
    let mut moved = surface.clone();
    moved.points.iter_mut().for_each(|p| p.x += 1e6);
    let ratio = refined(&moved).0.triangles.len() as f64 / out.triangles.len() as f64;
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn collinear_and_needle_holes_end_with_finite_points() {
    let line: Vec<_> = (0..40)
        .map(|i| Vec3::new(i.min(40 - i) as f64, 0.0, 0.0))
        .collect();
    refined(&fan_patch(line));
    let needle: Vec<_> = disc_rim(40)
        .iter()
        .map(|p| Vec3::new(p.x, 1e-9 * p.y, 0.0))
        .collect();
    refined(&fan_patch(needle));
    let mut pairs = disc_rim(40);
    for i in (0..40).step_by(2) {
        pairs[i + 1] = pairs[i];
    }
    refined(&fan_patch(pairs));
}

#[test]
fn a_ring_between_two_loops_keeps_its_hole() {
    let ring = |radius: f64| {
        (0..48)
            .map(move |i| TAU * i as f64 / 48.0)
            .map(move |angle| {
                Vec3::new(
                    radius * angle.cos(),
                    radius * angle.sin(),
                    0.3 * (3.0 * angle).sin(),
                )
            })
    };
    let triangles = (0..48).flat_map(|i| {
        let j = (i + 1) % 48;
        [[i, j, 48 + i], [j, 48 + j, 48 + i]]
    });
    let surface = PatchSurface {
        rim_count: 96,
        points: ring(8.0).chain(ring(3.0)).collect(),
        triangles: triangles.collect(),
    };
    let (out, _) = refined(&surface);
    assert_eq!(connect(&out).euler(), 0);
    assert!(out.points.len() > 96);
}

#[test]
fn blocked_chords_never_appear() {
    // Fine enough to keep chords, with every chord the fan does not start from blocked.
    let n = 24;
    let rim: Vec<_> = disc_rim(n)
        .iter()
        .map(|p| Vec3::new(p.x, 0.2 * p.y, 0.0))
        .collect();
    let surface = fan_patch(rim);
    let blocked = |a: u32, b: u32| a != 0 && b != 0;
    let (out, _, _) = refined_with(&surface, &RefineOptions::new(&UNLIMITED), &blocked);
    let (old, new) = (connect(&surface), connect(&out));
    for a in 0..n as u32 {
        for b in 0..a {
            assert!(
                !new.has_edge(a, b) || old.has_edge(a, b) || !blocked(a, b),
                "{a} {b}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn random_fans_end_with_every_invariant_intact(
        radii in prop::collection::vec(prop_oneof![0.05f64..1.0, Just(0.5), Just(0.0)], 3..50),
        heights in prop::collection::vec(-0.2f64..0.2, 50),
        twins in prop::collection::vec(any::<prop::sample::Index>(), 0..6),
        grading in prop_oneof![Just(0.0), 0.05f64..0.4],
        blocks in any::<u32>(),
    ) {
        let mut rim = star_rim(&radii);
        for (p, z) in rim.iter_mut().zip(&heights) {
            p.z = *z;
        }
        for twin in &twins {
            let i = twin.index(rim.len());
            rim[i] = rim[(i + 1) % rim.len()];
        }
        let surface = fan_patch(rim);
        prop_assume!(rim_sizes(&surface, &[]).is_ok());
        let options =
            RefineOptions { grading, max_vertices: 20_000, ..RefineOptions::new(&UNLIMITED) };
        let mut sizes = rim_sizes(&surface, &[]).unwrap();
        let mut out = surface.clone();
        let blocked = |a: u32, b: u32| blocks.rotate_left(a * b + a + b) & 3 == 0;
        match refine(&mut out, &mut sizes, &options, &blocked) {
            Ok(_) => check_invariants(&surface, &out, &sizes),
            Err(error) => {
                prop_assert_eq!(error.kind(), ErrorKind::Limit);
                prop_assert_eq!(out, surface);
            }
        }
    }

    #[test]
    fn wildly_different_edge_lengths_end(
        exponents in prop::collection::vec(-6i32..4, 4..30),
    ) {
        // A polygon whose sides vary over ten octaves.
        let mut angle = 0.0;
        let total: f64 = exponents.iter().map(|&e| 2f64.powi(e)).sum();
        let rim = exponents.iter().map(|&e| {
            angle += TAU * 2f64.powi(e) / total;
            Vec3::new(angle.cos(), angle.sin(), 0.0)
        });
        let surface = fan_patch(rim.collect());
        prop_assert_eq!(surface.triangles.clone(), fan(exponents.len()));
        let (out, _) = refined(&surface);
        prop_assert_eq!(count_violations(&connect(&out), &out.points, &|_, _| false), 0);
    }
}
