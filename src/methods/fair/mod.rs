//! The methods `membrane`, `fair-c1` and `fair-c2`: triangulate the rim, refine the triangulation, fair the result.
//!
//! Fairing moves the new vertices to the minimum of an energy. Its order decides how smoothly the patch meets the mesh:
//! in position, in tangent plane, or in curvature.
//!
//! Source: P. Liepa, "Filling holes in meshes", SGP 2003. There the patch is refined once. Here it is refined again
//! after a first fairing ([`refined`]), so that its triangles are regular on the final surface too.

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

/// Meets the rim, but may have a crease there.
pub(super) const MEMBRANE: MethodSpec = MethodSpec {
    name: "membrane",
    falls_back_to: &[Method::Flat],
    make: |task| faired(task, Order::One),
    ..MethodSpec::USUAL
};

/// Has common tangent planes with the mesh along the rim.
pub(super) const FAIR_C1: MethodSpec = MethodSpec {
    name: "fair-c1",
    falls_back_to: STAIRCASE.split_at(2).1,
    make: |task| faired(task, Order::Two),
    ..MethodSpec::USUAL
};

/// Has common curvature with the mesh along the rim.
pub(super) const FAIR_C2: MethodSpec = MethodSpec {
    name: "fair-c2",
    reach: |_| HoleReach::rings(2),
    falls_back_to: STAIRCASE.split_at(1).1,
    make: |task| {
        if task.known().is_some_and(|p: Prediction| p.is_noisy()) {
            return Err(Error::geometry(
                "the mesh round the hole is too noisy to estimate curvature",
            ));
        }
        faired(task, Order::Three)
    },
    ..MethodSpec::USUAL
};

/// The start patch, faired with the energy of the given order.
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
    // The second pass of order three has the weights of the shape that the first pass gives.
    let passes: &[Order] = match order {
        Order::Three => &[Order::Two, Order::Three],
        Order::One | Order::Two => &[order],
    };
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
