//! What was filled and taken back, and whether a plan still belongs to the mesh as it is.

use crate::error::{Error, Result};
use std::sync::Arc;

/// The fills of a session that can be undone, and what plans are dated with.
#[derive(Debug, Default)]
pub(super) struct History {
    /// Vertices and triangles before each fill that was not undone.
    fills: Vec<[usize; 2]>,
    /// Counts changes of the mesh.
    revision: u64,
    /// Number of triangles after each undo, with the revision; only those that no later undo went below.
    undone: Vec<(u64, usize)>,
    /// The revision of the attributes' layout.
    layout: u64,
    /// What plans know this session by.
    token: Arc<()>,
}

/// When a plan was made, and for which session.
#[derive(Clone, Debug)]
pub(super) struct Stamp {
    token: Arc<()>,
    revision: u64,
    layout: u64,
    /// Vertices and triangles of the mesh at that time.
    pub(super) size: [usize; 2],
}

impl History {
    /// The present, for a mesh of so many vertices and triangles.
    pub(super) fn stamp(&self, size: [usize; 2]) -> Stamp {
        Stamp {
            token: Arc::clone(&self.token),
            revision: self.revision,
            layout: self.layout,
            size,
        }
    }

    /// Whether what was planned at the stamp can be applied now.
    ///
    /// # Errors
    /// [`InvalidInput`](crate::ErrorKind::InvalidInput) when it was planned for another session, or before attributes
    /// were added or what it was planned for was undone.
    pub(super) fn check(&self, stamp: &Stamp) -> Result<()> {
        let undoes =
            |&(revision, count): &(u64, usize)| revision > stamp.revision && count < stamp.size[1];
        if !Arc::ptr_eq(&self.token, &stamp.token) {
            return Err(Error::invalid("the plan was made for another mesh"));
        }
        if self.layout != stamp.layout {
            return Err(Error::invalid(
                "the plan was made before attributes were added",
            ));
        }
        if self.undone.iter().any(undoes) {
            return Err(Error::invalid(
                "what the plan was made for was undone since",
            ));
        }
        Ok(())
    }

    /// Notes a fill of a mesh that had so many vertices and triangles before.
    pub(super) fn filled(&mut self, before: [usize; 2]) {
        self.fills.push(before);
        self.revision += 1;
    }

    /// Notes that an attribute was added.
    pub(super) fn layout_changed(&mut self) {
        self.layout += 1;
    }

    /// How many fills can be undone.
    pub(super) fn undo_count(&self) -> usize {
        self.fills.len()
    }

    /// Forgets the last fill. Returns how many vertices and triangles the mesh had before it.
    pub(super) fn undo(&mut self) -> Option<[usize; 2]> {
        let before = self.fills.pop()?;
        self.revision += 1;
        self.undone.retain(|&(_, count)| count < before[1]);
        self.undone.push((self.revision, before[1]));
        Some(before)
    }
}
