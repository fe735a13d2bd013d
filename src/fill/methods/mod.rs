//! The methods: each makes a patch from the shape of a hole, whatever happens to the patch afterwards.

mod grey;
mod hpde;
mod nurbs;
mod staircase;
mod unfold;

use super::hole::HoleReach;
use super::method::Method;
use super::options::FillOptions;
use crate::error::Result;
use crate::patch::{HoleShape, PatchSurface};
use staircase::Staircase;
use unfold::Unfold;

/// Makes patches for one hole by one method after the other; what several methods share is done once.
pub(crate) struct PatchMaker<'a> {
    hole: &'a HoleShape,
    options: &'a FillOptions,
    interrupted: &'a dyn Fn() -> bool,
    staircase: Staircase<'a>,
    unfold: Unfold<'a>,
}

impl<'a> PatchMaker<'a> {
    /// Nothing is computed yet. `interrupted` is asked from time to time; true stops the work.
    pub(crate) fn new(
        hole: &'a HoleShape,
        options: &'a FillOptions,
        interrupted: &'a dyn Fn() -> bool,
    ) -> Self {
        Self {
            hole,
            options,
            interrupted,
            staircase: Staircase::new(hole, options, interrupted),
            unfold: Unfold::new(hole, options, interrupted),
        }
    }

    /// What `method` reads of the mesh round the hole.
    pub(crate) fn reach(method: Method) -> HoleReach {
        HoleReach::rings(match method {
            Method::Hpde => hpde::RING_COUNT,
            Method::Grey => grey::RING_COUNT,
            Method::Nurbs => nurbs::RING_COUNT,
            Method::FairC2 => 2,
            _ => 1,
        })
    }

    /// The patch of `method` in the hole's coordinates. It is not verified yet.
    ///
    /// # Errors
    /// Those of the method, and [`crate::ErrorKind::Cancelled`].
    pub(crate) fn patch(&mut self, method: Method) -> Result<PatchSurface> {
        match method {
            Method::Hpde => hpde::patch(self.hole, self.options, self.interrupted),
            Method::Grey => grey::patch(self.hole, self.options, self.interrupted),
            Method::Nurbs => nurbs::patch(self.hole, self.options, self.interrupted),
            Method::UnfoldArea | Method::UnfoldFairing => self.unfold.patch(method),
            _ => self.staircase.patch(method),
        }
    }
}
