//! Fills a hole by unfolding its rim: triangulated in the plane, embedded, refined, and shaped by an energy.
//!
//! Based on: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, sections 3.2 and 3.3. Unlike there, refinement works on the embedded patch and
//! again on its final shape, and both energies are minimised exactly, by one sparse system each.

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

/// Least area. Where every umbrella vector is zero, E_AREA is least.
pub(super) const UNFOLD_AREA: MethodSpec = MethodSpec {
    name: "unfold-area",
    falls_back_to: &[Method::Membrane, Method::Flat],
    needs_unlinked_rim: true,
    make: |task| shaped(task, Order::One, Weights::Uniform),
    ..MethodSpec::USUAL
};

/// The second-order umbrella. Where every such vector is zero, E_DF is least.
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

/// Times that a patch is refined and shaped again because its shape made edges too long. Each time fewer are;
/// what is left after the last is not far over the length at which edges are split.
const ROUNDS: usize = 4;

/// Relaxations of the patch before it gets its shape: more than the staircase needs, for the triangles of the
/// plane may be far from what suits the rim in space.
const RELAXATIONS: usize = 5;

/// The embedded patch, refined and shaped.
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

/// The rim with the triangles that its unfolding has in the plane, and their chords that the mesh has as edges
/// split in the middle.
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
