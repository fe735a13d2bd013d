//! The start patch of most methods: a triangulation of the rim, refined to the density of the rim.
//!
//! The rim is triangulated without new vertices. This patch is refined coarsely, faired, and refined again. Fairing in
//! between gives it a smooth shape, on which refinement makes regular triangles. The start patch is made once for each
//! hole and shared by all methods that are tried.
//!
//! Sources: G. Barequet, M. Sharir, "Filling gaps in the boundary of a polyhedron", CAGD 12(2), 1995;
//! P. Liepa, "Filling holes in meshes", SGP 2003.

use super::task::Task;
use crate::error::Result;
use crate::fair::kharmonic::{Order, fair};
use crate::fair::laplacian::Weights;
use crate::math::sparse::SpdSolver;
use crate::patch::PatchSurface;
use crate::refine::{self, RefineOptions, RefineReport, grading, rim_sizes};
use crate::triangulate::{HolePolygon, TriangulationOptions, triangulate};

/// Target edge length of the coarse patch, divided by that of the final one.
const COARSENING: f64 = 2.0;

/// Number of rim vertices that ear clipping leaves to the exhaustive search. A small number is enough, because flips
/// and fairing make up for the difference.
const START_EAR_REMAINDER: usize = 16;
/// Upper bound on the rim edges up to which the whole rim is triangulated by exhaustive search.
const START_EXACT_LIMIT: usize = 24;

/// Relaxations of the coarse patch. It is only a start and needs none.
const COARSE_RELAXATIONS: usize = 0;
/// Relaxations of the final patch. A third one hardly improves the angles.
const FINE_RELAXATIONS: usize = 2;

/// A patch before it is faired, and the target edge length of each of its vertices.
pub(super) type Refined = Result<(PatchSurface, Vec<f64>)>;

/// The rim, triangulated without new vertices: rims of up to `exact_limit` edges by exhaustive search, larger ones by
/// ear clipping down to `ear_remainder` edges.
///
/// # Errors
/// Those of the triangulation; [`crate::ErrorKind::Cancelled`].
pub(super) fn triangulated(
    task: &Task<'_>,
    exact_limit: usize,
    ear_remainder: usize,
) -> Result<PatchSurface> {
    let hole = task.hole;
    let points: Vec<_> = hole
        .polygon
        .iter()
        .map(|&v| hole.rim()[v as usize])
        .collect();
    let at = |position: usize| hole.polygon[position];
    let polygon = HolePolygon {
        points: &points,
        outside_normals: &hole.outside_normals,
        vertex_ids: &hole.polygon,
        blocked: &|i, j| hole.is_joined(at(i), at(j)),
    };
    let options = TriangulationOptions {
        exact_limit,
        ear_remainder,
        job: task.job,
    };
    let triangulation = triangulate(&polygon, &options)?;
    let triangles = triangulation
        .triangles
        .iter()
        .map(|t| t.map(|position| at(position as usize)));
    Ok(PatchSurface {
        rim_count: hole.rim().len(),
        points: hole.rim().to_vec(),
        triangles: triangles.collect(),
    })
}

/// The start patch of the hole, and the target edge lengths of its vertices. It is made once for each task.
///
/// # Errors
/// Those of triangulation and refinement; [`crate::ErrorKind::Cancelled`].
pub(super) fn refined(task: &Task<'_>) -> Refined {
    task.once(|| make_refined(task))
}

fn make_refined(task: &Task<'_>) -> Refined {
    let mut surface = triangulated(task, START_EXACT_LIMIT, START_EAR_REMAINDER)?;
    let mut sizes = sizes_at_rim(task, &surface)?;
    for size in &mut sizes {
        *size *= COARSENING;
    }
    refine(task, &mut surface, &mut sizes, COARSE_RELAXATIONS)?;
    let around = &task.hole.surroundings;
    let mut solver = SpdSolver::new(task.job);
    fair(
        &mut surface,
        around,
        Order::Two,
        Weights::Uniform,
        &mut solver,
    )?;
    for size in &mut sizes {
        *size /= COARSENING;
    }
    refine(task, &mut surface, &mut sizes, FINE_RELAXATIONS)?;
    Ok((surface, sizes))
}

/// The target edge lengths of the vertices of a patch that is not refined yet.
///
/// # Errors
/// Those of [`rim_sizes`].
pub(super) fn sizes_at_rim(task: &Task<'_>, surface: &PatchSurface) -> Result<Vec<f64>> {
    let mut sizes = rim_sizes(surface, &task.hole.edge_lengths)?;
    for size in &mut sizes {
        *size *= task.options.refinement.density;
    }
    Ok(sizes)
}

/// Refines a patch of this hole whose vertices have moved. `sizes` are the target edge lengths of its vertices; they
/// are extended to the new vertices.
///
/// # Errors
/// Those of refinement; [`crate::ErrorKind::Cancelled`].
pub(super) fn refine_again(
    task: &Task<'_>,
    surface: &mut PatchSurface,
    sizes: &mut Vec<f64>,
) -> Result<()> {
    refine(task, surface, sizes, FINE_RELAXATIONS)?;
    Ok(())
}

/// Refines a patch of this hole with the options of the user, and relaxes its vertices `relaxations` times at the end.
///
/// # Errors
/// Those of refinement; [`crate::ErrorKind::Cancelled`].
pub(super) fn refine(
    task: &Task<'_>,
    surface: &mut PatchSurface,
    sizes: &mut Vec<f64>,
    relaxations: usize,
) -> Result<RefineReport> {
    let wanted = &task.options.refinement;
    let rim_count = surface.rim_count;
    let options = RefineOptions {
        grading: wanted.grading.unwrap_or_else(|| grading(rim_count)),
        pass_relaxations: 1,
        final_relaxations: relaxations,
        max_vertices: rim_count.saturating_add(wanted.max_vertices),
        ..RefineOptions::new(task.job)
    };
    refine::refine(surface, sizes, &options, &|a, b| task.hole.is_joined(a, b))
}
