//! Statuses, reasons, progress, cancelling and errors.

use super::{Filled, METHODS, all_but_the_largest, bits, fill, mesh_of, with_method};
use crate::RefinementOptions;
use crate::boundary::loops::BoundaryLoops;
use crate::boundary::opening::Opening;
use crate::boundary::select::Selection;
use crate::error::ErrorKind;
use crate::fill::index::MeshIndex;
use crate::fill::plan::{Planner, chain};
use crate::fill::progress::Progress;
use crate::fill::report::HoleStatus;
use crate::fill::session::at_once::fill_holes;
use crate::fixtures::{self, Arrays};
use crate::job::Job;
use crate::mesh::trimesh::TriMesh;
use crate::methods::method::Method;
use crate::options::FillOptions;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A sheet with nine holes of twelve edges.
fn nine_holes() -> Arrays {
    fixtures::sheet(18, fixtures::waves)
        .cut(|c| c[0] % 6.0 > 1.0 && c[0] % 6.0 < 4.0 && c[1] % 6.0 > 1.0 && c[1] % 6.0 < 4.0)
        .jittered(0.05, 11)
}

#[test]
fn every_fixture_is_filled_or_says_why_not_by_every_method() {
    for f in fixtures::fixtures() {
        // The chosen loops of a fan of thousands would be filled by the search for a minute.
        for method in METHODS {
            let filled = fill(&f.mesh, &Selection::default(), &with_method(method));
            for hole in &filled.report.holes {
                let is_hopeless = f.name == "all vertices equal"
                    || f.name == "collinear vertices"
                    || ["not-oriented", "open-chain"].contains(&hole.class.name());
                assert!(
                    is_hopeless || hole.edges <= 4 || hole.status == HoleStatus::Filled,
                    "{} by {method}: {hole:?}",
                    f.name
                );
                if ["not-oriented", "open-chain"].contains(&hole.class.name()) {
                    assert_eq!(hole.status, HoleStatus::Failed);
                }
            }
        }
    }
}

#[test]
fn progress_is_told_once_a_hole_and_grows() {
    for threads in [1, 2, 4] {
        let told = Mutex::new(Vec::new());
        let callback = |p: Progress| {
            let mut told = told.lock().unwrap();
            // Within a hole, the same again.
            if told.last() != Some(&(p.holes_done, p.holes_total)) && p.holes_done > 0 {
                told.push((p.holes_done, p.holes_total));
            }
            ControlFlow::Continue(())
        };
        let mut mesh = mesh_of(&nine_holes());
        let boundary = BoundaryLoops::find(&mesh);
        let options = FillOptions {
            threads,
            ..with_method(Method::FairC1)
        };
        let selection = all_but_the_largest();
        fill_holes(&mut mesh, &boundary, &selection, &options, Some(&callback)).unwrap();
        let expected: Vec<_> = (1..=9).map(|k| (k, 9)).collect();
        assert_eq!(told.into_inner().unwrap(), expected);
    }
}

#[test]
fn holes_that_are_cancelled_are_as_they_were_wherever_the_caller_stops() {
    for stop_after in 1..=9 {
        for threads in [1, 3] {
            let before = mesh_of(&nine_holes());
            let boundary = BoundaryLoops::find(&before);
            let callback = |p: Progress| match p.holes_done {
                done if done >= stop_after => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            };
            let options = FillOptions {
                threads,
                ..with_method(Method::FairC1)
            };
            let (mut after, selection) = (before.clone(), all_but_the_largest());
            let report =
                fill_holes(&mut after, &boundary, &selection, &options, Some(&callback)).unwrap();
            let filled = Filled {
                before,
                boundary,
                after,
                report,
            };
            filled.check();
            let count = |status| filled.report.count(status);
            assert_eq!(count(HoleStatus::Kept), 1);
            assert_eq!(count(HoleStatus::Filled) + count(HoleStatus::Cancelled), 9);
            if threads == 1 {
                assert_eq!(count(HoleStatus::Filled), stop_after);
            }
        }
    }
}

#[test]
fn planning_stops_wherever_it_is_cancelled() {
    let mesh = mesh_of(&fixtures::sphere(14).cut(|c| c[2] > 0.5));
    let boundary = BoundaryLoops::find(&mesh);
    let index = MeshIndex::build(&mesh, &Job::unlimited()).unwrap();
    let options = with_method(Method::FairC2);
    // Threads that share a job lose ticks to each other: how often they ask differs from run to run.
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one_thread = one_thread.unwrap();
    let plan_for = |questions: usize| {
        let asked = AtomicUsize::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= questions;
        let job = Job::new(&stop);
        let planner = Planner {
            loops: &boundary.loops,
            index: &index,
            polyline: None,
            options: &options,
        };
        let opening = Opening::of_loop(0);
        let outcome = one_thread.install(|| planner.plan(&mesh, &opening, &chain(&options), &job));
        (
            outcome.map_err(|f| f.error.kind()),
            asked.load(Ordering::Relaxed),
        )
    };
    let (complete, questions) = plan_for(usize::MAX);
    assert_eq!(complete.ok().map(|p| p.method), Some(Method::FairC2));
    assert!(questions > 2);
    for k in 0..questions {
        assert_eq!(
            plan_for(k).0.err(),
            Some(ErrorKind::Cancelled),
            "question {k}"
        );
    }
}

#[test]
fn a_limit_on_new_vertices_falls_back_to_the_flat_patch_and_says_so() {
    let sphere = fixtures::sphere(12).cut(|c| c[2] > 0.5);
    let mut options = with_method(Method::FairC2);
    options.refinement.max_vertices = 3;
    let filled = fill(&sphere, &Selection::default(), &options);
    let hole = &filled.report.holes[0];
    assert_eq!(
        (hole.status, hole.method),
        (HoleStatus::Filled, Some(Method::Flat))
    );
    assert!(hole.new_vertices.is_empty());
    let tried: Vec<Method> = hole.tried.iter().map(|a| a.method).collect();
    assert_eq!(tried, [Method::FairC2, Method::FairC1, Method::Membrane]);
    assert!(hole.tried.iter().all(|a| a.reason == hole.tried[0].reason));

    options.fallback = false;
    let filled = fill(&sphere, &Selection::default(), &options);
    let hole = &filled.report.holes[0];
    assert_eq!((hole.status, hole.method), (HoleStatus::Failed, None));
    assert_eq!(hole.tried.len(), 1);
    assert_eq!(hole.reason, hole.tried[0].reason);
    assert_eq!(
        bits(filled.after.positions()),
        bits(filled.before.positions())
    );
    assert_eq!(filled.after.triangles(), filled.before.triangles());

    options.method = Method::Flat;
    let filled = fill(&sphere, &Selection::default(), &options);
    assert_eq!(filled.statuses(), [HoleStatus::Filled]);
}

#[test]
fn the_chain_goes_from_the_chosen_method_to_simpler_ones() {
    let of = |method, fallback| {
        let mut options = with_method(method);
        options.fallback = fallback;
        chain(&options)
    };
    use Method::{Auto, Curvature, FairC1, FairC2, Flat, Membrane};
    assert_eq!(of(Auto, true), [Auto, FairC2, FairC1, Membrane, Flat]);
    assert_eq!(
        of(Curvature, true),
        [Curvature, FairC2, FairC1, Membrane, Flat]
    );
    assert_eq!(of(FairC2, true), [FairC2, FairC1, Membrane, Flat]);
    assert_eq!(of(Membrane, true), [Membrane, Flat]);
    assert_eq!(of(Flat, true), [Flat]);
    for method in METHODS {
        assert_eq!(of(method, false), [method]);
    }
}

/// Panics unless the call is refused and leaves the mesh alone.
fn assert_refused(
    mesh: &TriMesh,
    boundary: &BoundaryLoops,
    selection: &Selection,
    options: &FillOptions,
    what: &str,
) {
    let mut after = mesh.clone();
    let error = fill_holes(&mut after, boundary, selection, options, None).expect_err(what);
    assert_eq!(error.kind(), ErrorKind::InvalidInput, "{what}: {error}");
    assert_eq!(bits(after.positions()), bits(mesh.positions()));
    assert_eq!(after.triangles(), mesh.triangles());
}

#[test]
fn loops_that_are_not_those_of_the_mesh_are_refused() {
    let mesh = mesh_of(&nine_holes());
    let boundary = BoundaryLoops::find(&mesh);
    let refused = |boundary: &BoundaryLoops, what: &str| {
        assert_refused(
            &mesh,
            boundary,
            &Selection::default(),
            &FillOptions::default(),
            what,
        );
    };
    // Loops of another mesh with the same halfedges, larger vertex indices, or more triangles.
    let shifted = Arrays::default()
        .with_vertex([9.0; 3])
        .beside(&nine_holes());
    refused(&BoundaryLoops::find(&mesh_of(&shifted)), "another mesh");
    let larger = fixtures::sheet(40, fixtures::waves).cut(|c| c[0] > 30.0 && c[1] > 30.0);
    refused(&BoundaryLoops::find(&mesh_of(&larger)), "a larger mesh");
    // Those of the mesh before it was filled.
    let mut filled = mesh.clone();
    let selection = all_but_the_largest();
    fill_holes(
        &mut filled,
        &boundary,
        &selection,
        &FillOptions::default(),
        None,
    )
    .unwrap();
    assert_refused(
        &filled,
        &boundary,
        &selection,
        &FillOptions::default(),
        "stale",
    );
    // Those that the caller changed.
    type Change = fn(&mut BoundaryLoops);
    let changes: [(&str, Change); 6] = [
        ("removed", |b| drop(b.loops.remove(0))),
        ("swapped", |b| b.loops.swap(1, 2)),
        ("vertex added", |b| b.loops[1].vertices.push(0)),
        ("vertex removed", |b| b.loops[1].vertices.truncate(3)),
        ("vertex out of range", |b| b.loops[1].vertices[2] = u32::MAX),
        ("turned", |b| b.loops[1].vertices.reverse()),
    ];
    for (what, change) in changes {
        let mut changed = boundary.clone();
        change(&mut changed);
        refused(&changed, what);
    }
    let strip = mesh_of(&fixtures::moebius(12));
    let mut boundary = BoundaryLoops::find(&strip);
    boundary.loops[0].class = crate::LoopClass::Simple;
    let options = FillOptions::default();
    assert_refused(
        &strip,
        &boundary,
        &Selection::default(),
        &options,
        "class changed",
    );
}

#[test]
fn selections_and_options_that_make_no_sense_are_refused() {
    let mesh = mesh_of(&nine_holes());
    let boundary = BoundaryLoops::find(&mesh);
    let selection = Selection {
        keep: vec![[0, 0]],
        ..Selection::default()
    };
    assert_refused(
        &mesh,
        &boundary,
        &selection,
        &FillOptions::default(),
        "keep 0-0",
    );
    let refined = |change: fn(&mut RefinementOptions)| {
        let mut options = FillOptions::default();
        change(&mut options.refinement);
        options
    };
    let mut exact = FillOptions::default();
    exact.methods.flat.exact_limit = usize::MAX;
    let bad = [
        refined(|o| o.density = f64::NAN),
        refined(|o| o.density = 0.0),
        refined(|o| o.density = -1.0),
        refined(|o| o.grading = Some(f64::INFINITY)),
        exact,
    ];
    for options in bad {
        let what = format!("{options:?}");
        assert_refused(&mesh, &boundary, &Selection::default(), &options, &what);
    }
}

#[test]
fn nothing_to_fill_is_no_error() {
    for arrays in [
        Arrays::default(),
        fixtures::tetrahedron(),
        fixtures::torus(8, 12),
    ] {
        let filled = fill(&arrays, &Selection::default(), &FillOptions::default());
        assert!(filled.report.holes.is_empty());
    }
    let keep_all = Selection {
        max_edges: Some(0),
        ..Selection::default()
    };
    let filled = fill(&nine_holes(), &keep_all, &FillOptions::default());
    assert_eq!(filled.report.count(HoleStatus::Kept), 10);
    assert!(filled.new_triangles().is_empty());
}

#[test]
fn extreme_coordinates_are_filled_or_refused_without_harm() {
    let sphere = fixtures::sphere(8).jittered(0.01, 2).cut(|c| c[2] > 0.5);
    for scale in [
        1e-300, 1e-160, 1e-100, 1e-20, 1e20, 1e100, 1e150, 1e200, 1e307,
    ] {
        for method in METHODS {
            let filled = fill(
                &sphere.moved(scale, 0.3, [0.0; 3]),
                &Selection::default(),
                &with_method(method),
            );
            let is_moderate = (1e-100..=1e100).contains(&scale);
            let status = filled.report.holes[0].status;
            assert!(
                !is_moderate || status == HoleStatus::Filled,
                "{scale} {method}"
            );
        }
    }
}
