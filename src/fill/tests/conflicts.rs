//! Holes whose patches want the same edge or the same space.

use super::{Filled, METHODS, fill, with_method};
use crate::boundary::select::Selection;
use crate::fill::report::HoleStatus;
use crate::fixtures::{self, Arrays};
use crate::methods::method::Method;

/// Two spheres that touch nothing, with openings towards each other: smooth caps would intersect.
fn facing_openings() -> Arrays {
    let lower = fixtures::sphere(12).jittered(0.002, 1).cut(|c| c[2] > 0.5);
    let upper = fixtures::sphere(12)
        .jittered(0.002, 2)
        .cut(|c| c[2] < -0.5)
        .moved(1.0, 0.0, [0.0, 0.0, 1.6]);
    lower.beside(&upper)
}

fn joins(filled: &Filled, a: u32, b: u32) -> usize {
    let triangles = filled.new_triangles().iter();
    triangles
        .filter(|t| t.contains(&a) && t.contains(&b))
        .count()
}

#[test]
fn two_holes_that_want_the_same_chord_share_it_out() {
    let arrays = fixtures::holes_that_share_two_vertices();
    let whole = fill(&arrays, &Selection::default(), &with_method(Method::Flat));
    assert_eq!(whole.boundary.loops.len(), 2);
    // Alone, each of them takes the chord between the shared vertices.
    for l in &whole.boundary.loops {
        let only = Selection {
            only: vec![l.edge()],
            ..Selection::default()
        };
        let alone = fill(&arrays, &only, &with_method(Method::Flat));
        assert_eq!(joins(&alone, 0, 1), 2);
    }
    assert_eq!(whole.statuses(), [HoleStatus::Filled; 2]);
    assert_eq!(joins(&whole, 0, 1), 2);
    let tried = &whole.report.holes[1].tried;
    assert_eq!(tried.len(), 1);
    assert_eq!(tried[0].method, Method::Flat);
    assert!(
        tried[0].reason.contains("joined by an edge already"),
        "{tried:?}"
    );
    let topology = whole.topology();
    assert!(topology.is_oriented_manifold());
    assert_eq!(
        (topology.components, topology.euler_characteristic()),
        (1, 2)
    );
}

#[test]
fn patches_that_would_intersect_each_other_give_way_in_turn() {
    let filled = fill(
        &facing_openings(),
        &Selection::default(),
        &with_method(Method::FairC1),
    );
    assert_eq!(filled.statuses(), [HoleStatus::Filled; 2]);
    let [first, second] = &filled.report.holes[..] else {
        panic!("two loops");
    };
    assert_eq!(first.method, Some(Method::FairC1));
    assert_eq!(second.method, Some(Method::Membrane));
    assert_eq!(second.tried.len(), 1);
    assert_eq!(second.tried[0].method, Method::FairC1);
    assert!(
        second.tried[0].reason.contains("that of another hole"),
        "{second:?}"
    );
    assert_eq!(filled.recounted(), 0);
}

#[test]
fn without_fallback_intersections_between_patches_remain_and_are_said() {
    let mut options = with_method(Method::FairC1);
    options.fallback = false;
    let filled = fill(&facing_openings(), &Selection::default(), &options);
    assert_eq!(filled.statuses(), [HoleStatus::Filled; 2]);
    let second = &filled.report.holes[1];
    assert_eq!(second.method, Some(Method::FairC1));
    assert!(second.self_intersections > 0 && second.reason.contains("intersect"));
    assert_eq!(filled.report.holes[0].self_intersections, 0);
}

#[test]
fn many_holes_that_touch_each_other_are_all_filled() {
    // Every second quad of a board is missing: all holes touch in their corners.
    let board = fixtures::sheet(14, fixtures::waves)
        .cut(|c| {
            let (i, j) = (c[0] as usize, c[1] as usize);
            (2..12).contains(&i) && (2..12).contains(&j) && (i + j) % 2 == 0
        })
        .jittered(0.05, 7);
    for method in METHODS {
        let filled = fill(&board, &super::all_but_the_largest(), &with_method(method));
        let open = filled
            .statuses()
            .iter()
            .filter(|&&s| s != HoleStatus::Filled)
            .count();
        assert_eq!(open, 1, "{method}");
        assert!(filled.topology().is_oriented_manifold());
        assert_eq!(filled.topology().euler_characteristic(), 1);
    }
}

#[test]
fn a_loop_listed_twice_is_filled_once() {
    let mesh = super::mesh_of(&fixtures::sphere(6).cut(|c| c[2] > 0.6));
    let mut boundary = crate::BoundaryLoops::find(&mesh);
    let mut twice = boundary.loops[0].clone();
    twice.id = 1;
    boundary.loops.push(twice);
    let mut after = mesh.clone();
    let options = with_method(Method::FairC1);
    let report = crate::fill_holes(&mut after, &boundary, &Selection::default(), &options, None);
    let statuses: Vec<_> = report.unwrap().holes.iter().map(|h| h.status).collect();
    assert_eq!(statuses, [HoleStatus::Filled, HoleStatus::Failed]);
    assert!(after.connectivity().boundary_halfedges().is_empty());
}
