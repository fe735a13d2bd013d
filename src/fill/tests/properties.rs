//! Random holes by every method, and random triangles.

use super::{METHODS, all_but_the_largest, bits, fill, mesh_of, with_method};
use crate::boundary::boundary_loop::LoopClass;
use crate::boundary::loops::BoundaryLoops;
use crate::boundary::select::Selection;
use crate::fill::report::HoleStatus;
use crate::fill::session::at_once::fill_holes;
use crate::fixtures::{self, Arrays, Noise};
use crate::methods::method::Method;
use crate::options::FillOptions;
use crate::{FlatOptions, MethodOptions, RefinementOptions};
use proptest::prelude::*;

/// The boundary of a star-shaped region: its radius in every direction.
#[derive(Clone, Debug)]
struct Star {
    radius: f64,
    waves: [f64; 4],
}

impl Star {
    fn contains(&self, x: f64, y: f64) -> bool {
        let angle = y.atan2(x);
        let wave = |(k, w): (usize, &f64)| w * ((k + 2) as f64 * angle).sin();
        let share: f64 = self.waves.iter().enumerate().map(wave).sum();
        x.hypot(y) < self.radius * (1.0 + share)
    }
}

fn star() -> impl Strategy<Value = Star> {
    (0.15..0.5_f64, proptest::array::uniform4(-0.2..0.2_f64))
        .prop_map(|(radius, waves)| Star { radius, waves })
}

/// A sphere or a wavy sheet with one or two star-shaped holes.
fn damaged() -> impl Strategy<Value = (Arrays, Selection)> {
    let sphere = (star(), star(), 8_usize..16, 0_u64..1000).prop_map(|(a, b, n, seed)| {
        let whole = fixtures::sphere(n).jittered(0.2 / n as f64, seed);
        let cut = whole.cut(|c| match c[2] > 0.0 {
            true => a.contains(c[0], c[1]),
            false => b.contains(c[1], c[0]),
        });
        (cut.shuffled(seed), Selection::default())
    });
    let sheet =
        (star(), 8_usize..20, 0.0..2.0_f64, 0_u64..1000).prop_map(|(a, n, height, seed)| {
            let half = n as f64 / 2.0;
            let whole =
                fixtures::sheet(n, |x, y| height * fixtures::waves(x, y)).jittered(0.15, seed);
            let cut = whole.cut(|c| a.contains((c[0] - half) / half, (c[1] - half) / half));
            (cut.shuffled(seed), all_but_the_largest())
        });
    prop_oneof![sphere, sheet]
}

fn options() -> impl Strategy<Value = FillOptions> {
    let sets = (
        0..METHODS.len(),
        any::<bool>(),
        any::<bool>(),
        3_usize..120,
        prop_oneof![Just(1.0), 0.5..3.0_f64],
        prop_oneof![Just(None), (0.0..1.0_f64).prop_map(Some)],
    );
    sets.prop_map(
        |(method, fallback, join_islands, exact_limit, density, grading)| FillOptions {
            fallback,
            join_islands,
            refinement: RefinementOptions::default()
                .density(density)
                .grading(grading),
            methods: MethodOptions::default().flat(FlatOptions::default().exact_limit(exact_limit)),
            ..with_method(METHODS[method])
        },
    )
}

/// Triangles with few vertices at random places, so that every irregularity occurs; sometimes with
/// vertices at equal positions.
fn soup() -> impl Strategy<Value = Arrays> {
    (3_u32..20, 0_usize..40, 1_u32..5, any::<u64>()).prop_map(
        |(vertices, triangles, grain, seed)| {
            let mut noise = Noise(seed);
            let coordinate = |noise: &mut Noise| match grain {
                1 => noise.signed(),
                _ => f64::from(noise.below(grain)),
            };
            let positions = (0..vertices)
                .map(|_| [0; 3].map(|_: i32| coordinate(&mut noise)))
                .collect();
            let triangles = (0..triangles)
                .map(|_| [0; 3].map(|_: i32| noise.below(vertices)))
                .collect();
            Arrays::new(positions, triangles)
        },
    )
}

/// A sphere some of whose triangles are missing, turned or replaced: many loops of all classes.
fn battered() -> impl Strategy<Value = Arrays> {
    (2_usize..6, 2_u32..12, any::<u64>()).prop_map(|(n, share, seed)| {
        let mut noise = Noise(seed);
        let mut out = fixtures::sphere(n).jittered(0.1, seed);
        let count = out.positions.len() as u32;
        for t in &mut out.triangles {
            match noise.below(4 * share) {
                0 => t.swap(0, 1),
                1 => t[0] = noise.below(count),
                _ => {}
            }
        }
        out.triangles.retain(|_| noise.below(share) != 0);
        out
    })
}

fn check_every_method(arrays: &Arrays) {
    for method in METHODS {
        let mut options = with_method(method);
        options.refinement.max_vertices = 2000;
        fill(arrays, &Selection::default(), &options);
    }
}

/// So many meshes of each kind, or as many as `PROPTEST_CASES` says: `PROPTEST_CASES=20000 cargo test --lib do_no_harm`.
fn cases(usual: u32) -> ProptestConfig {
    let asked_for = std::env::var("PROPTEST_CASES").ok();
    ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(asked_for.and_then(|n| n.parse().ok()).unwrap_or(usual))
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn star_shaped_holes_are_filled_whatever_the_options((arrays, selection) in damaged(), options in options()) {
        let filled = fill(&arrays, &selection, &options);
        for hole in &filled.report.holes {
            prop_assert!(hole.status != HoleStatus::Cancelled);
            // A loose triangle cannot be closed by itself without repeating it.
            let is_loose_triangle = hole.edges == 3 && hole.class == LoopClass::Island;
            let may_fail = is_loose_triangle || !options.fallback;
            prop_assert!(hole.status != HoleStatus::Failed || may_fail, "{:?}", hole);
            prop_assert!(hole.status != HoleStatus::Kept || selection.keep_largest > 0);
        }
        if filled.report.count(HoleStatus::Failed) == 0 {
            let topology = filled.topology();
            prop_assert!(topology.is_oriented_manifold());
            let expected = if selection.keep_largest > 0 { 1 } else { 2 };
            prop_assert!(topology.euler_characteristic() >= expected);
            if options.join_islands {
                prop_assert_eq!(topology.components, 1);
                prop_assert_eq!(topology.euler_characteristic(), expected);
            }
        }
    }

    #[test]
    fn the_number_of_threads_does_not_change_a_bit((arrays, selection) in damaged(), options in options()) {
        let result = |threads| {
            let mut mesh = mesh_of(&arrays);
            let boundary = BoundaryLoops::find(&mesh);
            let options = FillOptions { threads, ..options.clone() };
            let mut report = fill_holes(&mut mesh, &boundary, &selection, &options, None).unwrap();
            report.index_seconds = 0.0;
            report.fill_seconds = 0.0;
            report.holes.iter_mut().for_each(|h| h.seconds = 0.0);
            (bits(mesh.positions()), mesh.triangles().to_vec(), report)
        };
        let single = result(1);
        prop_assert_eq!(&result(2), &single);
        prop_assert_eq!(&result(4), &single);
        prop_assert_eq!(&result(1), &single);
    }
}

proptest! {
    #![proptest_config(cases(500))]

    #[test]
    fn a_soup_of_triangles_does_no_harm(arrays in soup()) {
        check_every_method(&arrays);
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn a_battered_sphere_does_no_harm(arrays in battered()) {
        check_every_method(&arrays);
    }
}

#[test]
fn runs_one_after_the_other_give_the_same_bits() {
    let arrays = fixtures::sheet_with_islands(3).beside(&fixtures::touching_holes(4));
    let run = || {
        let filled = fill(&arrays, &Selection::default(), &with_method(Method::FairC2));
        (
            bits(filled.after.positions()),
            filled.after.triangles().to_vec(),
        )
    };
    assert_eq!(run(), run());
}
