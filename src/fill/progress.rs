//! Progress of a fill, and how a caller stops it.

use std::ops::ControlFlow;

/// How far a fill has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Holes that are finished, whatever their status.
    pub holes_done: usize,
    /// Holes to be filled.
    pub holes_total: usize,
}

/// Called after each hole, from any of the filling threads, one at a time; [`ControlFlow::Break`] cancels the
/// holes that are not finished.
pub type ProgressCallback<'a> = &'a (dyn Fn(Progress) -> ControlFlow<()> + Sync);
