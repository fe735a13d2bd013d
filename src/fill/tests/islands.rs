//! Loose sheets inside a hole.

use super::{METHODS, all_but_the_largest, fill, with_method};
use crate::boundary::boundary_loop::LoopClass;
use crate::fill::report::HoleStatus;
use crate::fixtures;
use crate::methods::method::Method;

#[test]
fn islands_are_joined_to_the_patch_of_their_hole() {
    for islands in [1, 2, 3, 5] {
        let sheet = fixtures::sheet_with_islands(islands).jittered(0.02, 5);
        for method in METHODS {
            let filled = fill(&sheet, &all_but_the_largest(), &with_method(method));
            let topology = filled.topology();
            assert_eq!(topology.components, 1, "{islands} {method}");
            assert_eq!(topology.euler_characteristic(), 1);
            assert!(topology.is_oriented_manifold());
            for hole in &filled.report.holes {
                match hole.class {
                    LoopClass::Island => {
                        assert_eq!(hole.status, HoleStatus::Filled);
                        assert!(hole.reason.starts_with("joined to the patch of hole"));
                    }
                    LoopClass::OuterRim => assert_eq!(hole.status, HoleStatus::Kept),
                    _ => assert!(hole.method.is_some(), "{hole:?}"),
                }
            }
        }
    }
}

#[test]
fn islands_that_are_not_joined_are_closed_by_themselves() {
    let sheet = fixtures::sheet_with_islands(2).jittered(0.02, 5);
    let mut options = with_method(Method::Flat);
    options.join_islands = false;
    let filled = fill(&sheet, &all_but_the_largest(), &options);
    let topology = filled.topology();
    assert_eq!(topology.components, 3);
    // A disk and two closed surfaces.
    assert_eq!(topology.euler_characteristic(), 1 + 2 + 2);
    let filled = filled.report.holes.iter().filter(|h| h.method.is_some());
    assert_eq!(filled.count(), 3);
}

#[test]
fn an_island_that_is_kept_stays_open_while_its_hole_is_filled() {
    let sheet = fixtures::sheet_with_islands(1);
    let before = fill(&sheet, &all_but_the_largest(), &with_method(Method::Flat));
    let island = before
        .boundary
        .loops
        .iter()
        .find(|l| l.class == LoopClass::Island)
        .unwrap();
    let mut selection = all_but_the_largest();
    selection.keep.push(island.edge());
    let filled = fill(&sheet, &selection, &with_method(Method::Flat));
    assert_eq!(filled.report.holes[island.id].status, HoleStatus::Kept);
    assert_eq!(filled.report.count(HoleStatus::Filled), 1);
    assert_eq!(filled.topology().components, 2);
    // And the other way round: alone it is a hole like any other.
    let host = island.host.unwrap();
    let mut selection = all_but_the_largest();
    selection.keep.push(before.boundary.loops[host].edge());
    let filled = fill(&sheet, &selection, &with_method(Method::Flat));
    assert!(filled.report.holes[island.id].method.is_some());
    assert_eq!(filled.report.holes[host].status, HoleStatus::Kept);
}

#[test]
fn a_tongue_that_hangs_on_one_vertex_is_joined_there() {
    for method in METHODS {
        let filled = fill(
            &fixtures::tongue(),
            &all_but_the_largest(),
            &with_method(method),
        );
        let topology = filled.topology();
        assert!(topology.is_oriented_manifold(), "{method}");
        assert_eq!(
            (topology.components, topology.euler_characteristic()),
            (1, 1)
        );
    }
}

#[test]
fn an_island_that_touches_its_hole_in_two_vertices_is_joined() {
    // The island spans the hole from corner to corner.
    let sheet = fixtures::sheet_without(10, |i, j| {
        let inside = (2..8).contains(&i) && (2..8).contains(&j);
        let island = (3..7).contains(&i) && (3..7).contains(&j);
        let is_corner = (i, j) == (2, 2) || (i, j) == (7, 7);
        inside && !island && !is_corner
    });
    for method in METHODS {
        let filled = fill(&sheet, &all_but_the_largest(), &with_method(method));
        assert_eq!(filled.report.count(HoleStatus::Failed), 0, "{method}");
        assert!(filled.topology().is_oriented_manifold(), "{method}");
        assert_eq!(filled.topology().euler_characteristic(), 1);
    }
}
