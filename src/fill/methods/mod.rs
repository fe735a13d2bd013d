//! The methods: each makes a patch from the shape of a hole, whatever happens to the patch afterwards.

mod auto;
mod creases;
mod grey;
mod hpde;
mod mls;
mod nurbs;
mod staircase;
mod unfold;

use super::hole::HoleReach;
use super::method::Method;
use super::options::FillOptions;
use crate::error::{Error, ErrorKind, Result};
use crate::fill::report::Prediction;
use crate::job::Job;
use crate::patch::{HoleShape, PatchSurface};
use auto::Auto;
use staircase::Staircase;
pub(super) use unfold::Unfold;

/// Makes patches for one hole by one method after the other; what several methods share is done once.
pub(crate) struct PatchMaker<'a> {
    hole: &'a HoleShape,
    options: &'a FillOptions,
    job: &'a Job<'a>,
    staircase: Staircase<'a>,
    auto: Auto<'a>,
    unfold: Unfold<'a>,
}

impl<'a> PatchMaker<'a> {
    /// Nothing is computed yet.
    pub(crate) fn new(hole: &'a HoleShape, options: &'a FillOptions, job: &'a Job<'a>) -> Self {
        Self {
            hole,
            options,
            job,
            staircase: Staircase::new(hole, options, job),
            auto: Auto::new(hole, options, job),
            unfold: Unfold::new(hole, options, job),
        }
    }

    /// What `method` reads of the mesh round the hole, for those that it falls back to as well.
    pub(crate) fn reach(method: Method, options: &FillOptions) -> HoleReach {
        match method {
            Method::Auto | Method::Curvature => HoleReach::rings(auto::RINGS),
            Method::Hpde => HoleReach::rings(hpde::RING_COUNT),
            Method::Grey => HoleReach::rings(grey::RING_COUNT),
            Method::Nurbs => HoleReach::rings(nurbs::RING_COUNT),
            Method::FairC2 => HoleReach::rings(2),
            Method::Mls => HoleReach {
                rings: 1,
                steps: options.mls.beta,
            },
            _ => HoleReach::rings(1),
        }
    }

    /// The patch of `method` in the hole's coordinates. It is not verified yet.
    ///
    /// # Errors
    /// Those of the method, and [`crate::ErrorKind::Cancelled`].
    pub(crate) fn patch(&mut self, method: Method) -> Result<PatchSurface> {
        match method {
            Method::Auto | Method::Curvature => self.auto.patch(method, &mut self.staircase),
            Method::Hpde => hpde::patch(self.hole, self.options, self.job),
            Method::Grey => grey::patch(self.hole, self.options, self.job),
            Method::Nurbs => nurbs::patch(self.hole, self.options, self.job),
            Method::UnfoldArea | Method::UnfoldFairing => self.unfold.patch(method),
            Method::FairC2 if self.auto.is_noisy() => Err(Error::new(
                ErrorKind::Geometry,
                "the surroundings are too noisy to read curvature from",
            )),
            Method::Mls => mls::patch(self.hole, self.options, self.job),
            _ => self.staircase.patch(method),
        }
    }

    /// How the surface was predicted, if a method did so.
    pub(crate) fn prediction(&self) -> Option<&Prediction> {
        self.auto.prediction()
    }
}
