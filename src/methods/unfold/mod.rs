//! The methods `unfold-area` and `unfold-fairing`: unfold the rim to the plane, triangulate it there, refine and fair.
//!
//! The rim is deformed to a simple polygon in the plane, without crossing itself. The constrained Delaunay
//! triangulation of this polygon gives triangles between the rim vertices in space. This patch is refined and faired
//! in turn.
//!
//! Source: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, sections 3.2 and 3.3. Two differences: the patch is refined in space, and again on its
//! final shape; and both energies are minimized exactly, by one sparse system each.
//!
//! Not guaranteed: that every unknotted rim is unfolded.

mod annealing;
pub(crate) mod curve;
mod descent;
mod distance;
mod energy;
pub(crate) mod options;
mod projection;

use super::method::Method;
use super::spec::MethodSpec;
use super::start::{refine, sizes_at_rim};
use super::task::Task;
use crate::error::{Error, Result};
use crate::fair::kharmonic::{Order, fair};
use crate::fair::laplacian::Weights;
use crate::math::Vec3;
use crate::math::sparse::SpdSolver;
use crate::patch::PatchSurface;
use crate::patch::chords::split_joined_chords;
use crate::patch::mesh::PatchMesh;
use crate::triangulate::planar::triangulate_planar_region;
use curve::unfold;

/// Least area: minimizes E_AREA, by making all umbrella vectors zero.
pub(super) const UNFOLD_AREA: MethodSpec = MethodSpec {
    name: "unfold-area",
    falls_back_to: &[Method::Membrane, Method::Flat],
    needs_unlinked_rim: true,
    make: |task| shaped(task, Order::One, Weights::Uniform),
    ..MethodSpec::USUAL
};

/// Fairing: minimizes E_DF, by making all second-order umbrella vectors zero.
pub(super) const UNFOLD_FAIRING: MethodSpec = MethodSpec {
    name: "unfold-fairing",
    falls_back_to: &[
        Method::UnfoldArea,
        Method::FairC1,
        Method::Membrane,
        Method::Flat,
    ],
    needs_unlinked_rim: true,
    make: |task| shaped(task, Order::Two, Weights::Umbrella),
    ..MethodSpec::USUAL
};

/// Upper bound on the rounds of refining and fairing. Fairing can make edges too long again, but fewer in each round.
const ROUNDS: usize = 4;

/// Relaxations after each refinement. There are more than in other methods, because triangles that are regular in the
/// plane can be irregular in space.
const RELAXATIONS: usize = 5;

/// The embedded patch, refined and faired.
///
/// # Errors
/// [`crate::ErrorKind::InvalidInput`] for a rim with islands, [`crate::ErrorKind::Knotted`] for one that was not unfolded;
/// those of triangulation, refinement and fairing; [`crate::ErrorKind::Cancelled`].
fn shaped(task: &Task<'_>, order: Order, weights: Weights) -> Result<PatchSurface> {
    let mut surface = task.once(|| Embedded(embed(task))).0?;
    let mut sizes = sizes_at_rim(task, &surface)?;
    for _ in 0..ROUNDS {
        let report = refine(task, &mut surface, &mut sizes, RELAXATIONS)?;
        let mut solver = SpdSolver::new(task.job);
        let around = &task.hole.surroundings;
        fair(&mut surface, around, order, weights, &mut solver)?;
        if report.splits == 0 {
            break;
        }
    }
    Ok(surface)
}

/// The rim in space with the triangles of its unfolding. Chords that are edges of the mesh already are split in the
/// middle.
#[derive(Clone)]
struct Embedded(Result<PatchSurface>);

fn embed(task: &Task<'_>) -> Result<PatchSurface> {
    let hole = task.hole;
    if hole.polygon.len() != hole.rim().len() {
        return Err(Error::invalid(
            "a rim with islands is not one curve that could be unfolded",
        ));
    }
    let curve: Vec<Vec3> = hole
        .polygon
        .iter()
        .map(|&v| hole.rim()[v as usize])
        .collect();
    let options = task.options;
    let unfolding = unfold(&curve, &options.methods.unfold, options.seed, task.job)?;
    let triangles = triangulate_planar_region(&[&unfolding.polygon], &[], task.job)?;
    let mut surface = PatchSurface {
        rim_count: hole.rim().len(),
        points: hole.rim().to_vec(),
        triangles: triangles
            .iter()
            .map(|t| t.map(|position| hole.polygon[position as usize]))
            .collect(),
    };
    task.job.ask()?;
    let rim_count = surface.rim_count;
    let mut mesh = PatchMesh::new(surface.triangles, rim_count, rim_count)?;
    split_joined_chords(&mut mesh, &mut surface.points, hole);
    surface.triangles = mesh.triangles().to_vec();
    Ok(surface)
}
