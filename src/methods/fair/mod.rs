//! The practical methods: triangulate, refine, fair.
//!
//! Based on: P. Liepa, "Filling holes in meshes", SGP 2003. Unlike there, the patch is refined again while it takes
//! shape, so that its triangles are as regular on the final surface as they were on the first one.

pub(crate) mod options;

use super::method::Method;
use super::spec::{HoleReach, MethodSpec, STAIRCASE};
use super::start::refined;
use super::task::Task;
use crate::error::{Error, Result};
use crate::fair::kharmonic::{Order, fair};
use crate::fair::laplacian::Weights;
use crate::math::sparse::SpdSolver;
use crate::methods::auto::prediction::Prediction;
use crate::patch::PatchSurface;
use options::FairWeights;

/// The membrane: continuous with the surroundings.
pub(super) const MEMBRANE: MethodSpec = MethodSpec {
    name: "membrane",
    falls_back_to: &[Method::Flat],
    make: |task| faired(task, Order::One),
    ..MethodSpec::USUAL
};

/// Common tangent planes along the rim.
pub(super) const FAIR_C1: MethodSpec = MethodSpec {
    name: "fair-c1",
    falls_back_to: STAIRCASE.split_at(2).1,
    make: |task| faired(task, Order::Two),
    ..MethodSpec::USUAL
};

/// Common curvature along the rim.
pub(super) const FAIR_C2: MethodSpec = MethodSpec {
    name: "fair-c2",
    reach: |_| HoleReach::rings(2),
    falls_back_to: STAIRCASE.split_at(1).1,
    make: |task| {
        if task.known().is_some_and(|p: Prediction| p.is_noisy()) {
            return Err(Error::geometry(
                "the surroundings are too noisy to read curvature from",
            ));
        }
        faired(task, Order::Three)
    },
    ..MethodSpec::USUAL
};

/// The refined patch, faired to meet its surroundings as smoothly as `order` says.
///
/// # Errors
/// Those of triangulation, refinement and fairing; [`crate::ErrorKind::Cancelled`].
pub(super) fn faired(task: &Task<'_>, order: Order) -> Result<PatchSurface> {
    let options = &task.options.methods.fair;
    let (mut surface, _) = refined(task)?;
    let mut solver = SpdSolver::new(task.job);
    let weights = match options.weights {
        FairWeights::Lumped => Weights::Cotangent,
        FairWeights::Voronoi => Weights::Voronoi,
    };
    let passes = [Order::Two, order];
    let passes = &passes[usize::from(order != Order::Three)..];
    let skipped = passes.len().saturating_sub(options.passes);
    for &order in &passes[skipped..] {
        fair(
            &mut surface,
            &task.hole.surroundings,
            order,
            weights,
            &mut solver,
        )?;
    }
    Ok(surface)
}
