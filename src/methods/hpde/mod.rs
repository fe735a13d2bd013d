//! The method `hpde`: hole patching with curves across the hole, whose points are found by differential evolution.
//!
//! In each section plane, two circular arcs join the ends; each is tangent to the surface at one end. The points lie
//! between the arcs, at heights that make the largest angle between consecutive edges small. All other steps are those
//! of [`sections`](super::sections).
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013. `docs/methods/hpde.md` lists the differences from the paper, with reasons.

mod evolution;
pub(crate) mod options;
pub(crate) mod section_curve;

use super::method::MethodOptions;
use super::sections::arcs::profile;
use super::sections::options::SectionOptions;
use super::sections::{self, Predicted, Prepared};
use super::spec::{HoleReach, MethodSpec, STAIRCASE};
use super::task::Task;
use crate::error::Result;
use crate::job::Job;
use crate::math::random::seeded;
use crate::patch::PatchSurface;
use evolution::evolve;
use options::{HpdeOptions, HpdeSolver};

/// The method.
pub(super) const HPDE: MethodSpec = MethodSpec {
    name: "hpde",
    reach: |_| HoleReach::rings(sections::RING_COUNT),
    falls_back_to: STAIRCASE,
    make,
    ..MethodSpec::USUAL
};

/// # Errors
/// Those of [`sections::patch_along`].
fn make(task: &Task<'_>) -> Result<PatchSurface> {
    let options = &task.options.methods.hpde;
    let seed = task.options.seed;
    sections::patch_along(task, &options.sections, &|_, sections| {
        evolved(sections, options, seed, task.job)
    })
}

/// The points of all sections, at heights from differential evolution or from its start value alone.
///
/// # Errors
/// [`crate::ErrorKind::Cancelled`].
fn evolved(
    sections: &[Prepared],
    options: &HpdeOptions,
    seed: u64,
    job: &Job<'_>,
) -> Result<Predicted> {
    let mut predicted = Vec::with_capacity(sections.len());
    for (k, section) in (0_u64..).zip(sections) {
        job.ask()?;
        let profile = profile(&section.arcs[0], &section.arcs[1], section.count);
        let heights = match options.solver {
            HpdeSolver::Direct => profile.start.clone(),
            HpdeSolver::De => evolve(&profile, options, &mut seeded(seed, k), job)?.values,
        };
        let points = profile.x.iter().zip(&heights);
        predicted.push(
            points
                .map(|(x, y)| section.origin + section.x * *x + section.y * *y)
                .collect(),
        );
    }
    Ok(predicted)
}

impl MethodOptions {
    /// The options that `hpde`, `grey` and `nurbs` share. They stand in the group `hpde`.
    pub(super) fn sections(&self) -> &SectionOptions {
        &self.hpde.sections
    }
}
