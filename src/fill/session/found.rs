//! The loops of a session's mesh, found once.

use crate::boundary::loops::BoundaryLoops;
use std::sync::OnceLock;

/// The loops of a mesh, and where they are.
#[derive(Debug)]
pub(super) struct FoundLoops {
    pub(super) all: BoundaryLoops,
    /// Boundary halfedges with the loop that they are on, ascending.
    places: OnceLock<Vec<(u32, usize)>>,
}

impl FoundLoops {
    pub(super) fn new(all: BoundaryLoops) -> Self {
        Self {
            all,
            places: OnceLock::new(),
        }
    }

    /// Sorts the boundary halfedges, unless that was done before.
    pub(super) fn places(&self) -> &[(u32, usize)] {
        self.places.get_or_init(|| {
            let loops = self.all.loops.iter();
            let mut places: Vec<(u32, usize)> = loops
                .flat_map(|l| l.halfedges.iter().map(|&h| (h, l.id)))
                .collect();
            places.sort_unstable();
            places
        })
    }
}
