//! Selection rules.

use super::loops::BoundaryLoops;
use super::select::Selection;
use crate::error::ErrorKind;
use crate::fixtures;
use crate::mesh::trimesh::TriMesh;

/// Holes of 4, 8, 16 and 24 edges in a sheet whose rim has 80.
fn boundary() -> BoundaryLoops {
    let holes = [(1, 1), (4, 2), (8, 4), (13, 6)];
    let sheet = fixtures::sheet_without(20, |i, j| {
        holes
            .iter()
            .any(|&(at, size)| (at..at + size).contains(&i) && (at..at + size).contains(&j))
    });
    let boundary = BoundaryLoops::find(&TriMesh::new(sheet.positions, sheet.triangles).unwrap());
    let edges: Vec<usize> = boundary.loops.iter().map(|l| l.edge_count()).collect();
    assert_eq!(edges, [80, 4, 8, 16, 24]);
    boundary
}

/// The ids of the loops that a selection fills.
fn chosen(selection: &Selection) -> Vec<usize> {
    let reasons = selection.reasons_to_keep(&boundary()).unwrap();
    (0..reasons.len())
        .filter(|&i| reasons[i].is_none())
        .collect()
}

#[test]
fn without_rules_every_loop_is_chosen() {
    assert_eq!(chosen(&Selection::default()), [0, 1, 2, 3, 4]);
}

#[test]
fn rules_choose_by_edge_size_and_rank() {
    let edge = |id: usize| boundary().loops[id].edge();
    let later_edge = |id: usize| {
        let l = &boundary().loops[id];
        [l.vertices[2], l.vertices[3]]
    };
    let none = Selection::default;
    let cases = [
        (
            Selection {
                only: vec![edge(2)],
                ..none()
            },
            vec![2],
        ),
        (
            Selection {
                only: vec![later_edge(2), edge(2), edge(4)],
                ..none()
            },
            vec![2, 4],
        ),
        (
            Selection {
                keep: vec![later_edge(0), edge(3)],
                ..none()
            },
            vec![1, 2, 4],
        ),
        (
            Selection {
                only: vec![edge(2), edge(3)],
                keep: vec![edge(3)],
                ..none()
            },
            vec![2],
        ),
        (
            Selection {
                max_edges: Some(8),
                ..none()
            },
            vec![1, 2],
        ),
        (
            Selection {
                max_edges: Some(0),
                ..none()
            },
            vec![],
        ),
        (
            Selection {
                max_perimeter: Some(16.0),
                ..none()
            },
            vec![1, 2, 3],
        ),
        (
            Selection {
                max_perimeter: Some(15.999),
                ..none()
            },
            vec![1, 2],
        ),
        (
            Selection {
                max_perimeter: Some(f64::INFINITY),
                ..none()
            },
            vec![0, 1, 2, 3, 4],
        ),
        (
            Selection {
                keep_largest: 1,
                ..none()
            },
            vec![1, 2, 3, 4],
        ),
        (
            Selection {
                keep_largest: 3,
                ..none()
            },
            vec![1, 2],
        ),
        (
            Selection {
                keep_largest: 99,
                ..none()
            },
            vec![],
        ),
        (
            Selection {
                only: vec![edge(0)],
                keep_largest: 1,
                ..none()
            },
            vec![],
        ),
    ];
    for (selection, expected) in cases {
        assert_eq!(chosen(&selection), expected, "{selection:?}");
    }
}

#[test]
fn every_loop_that_stays_open_has_its_reason() {
    let selection = Selection {
        keep: vec![boundary().loops[1].edge()],
        max_edges: Some(16),
        max_perimeter: Some(8.0),
        ..Selection::default()
    };
    let reasons = selection.reasons_to_keep(&boundary()).unwrap();
    let said: Vec<_> = reasons.iter().map(|r| r.as_deref()).collect();
    assert_eq!(
        said,
        [
            Some("more than 16 edges"),
            Some("asked to keep"),
            None,
            Some("perimeter above 8"),
            Some("more than 16 edges"),
        ]
    );
}

#[test]
fn an_edge_on_no_loop_is_an_error_with_a_hint() {
    let [a, b] = boundary().loops[2].edge();
    for (edge, hint) in [
        ([b, a], "the boundary edge runs from"),
        ([a, a], ""),
        ([9999, 3], ""),
    ] {
        for selection in [
            Selection {
                only: vec![edge],
                ..Selection::default()
            },
            Selection {
                keep: vec![edge],
                ..Selection::default()
            },
        ] {
            let error = selection.reasons_to_keep(&boundary()).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidInput);
            assert!(
                error
                    .message()
                    .contains(&format!("from vertex {}", edge[0]))
            );
            assert!(error.message().contains(hint), "{error}");
        }
    }
}

#[test]
fn a_largest_perimeter_that_is_no_length_is_an_error() {
    for limit in [f64::NAN, -1.0, f64::NEG_INFINITY] {
        let selection = Selection {
            max_perimeter: Some(limit),
            ..Selection::default()
        };
        let error = selection.reasons_to_keep(&boundary()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
    }
}
