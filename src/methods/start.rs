//! The patch that most methods start from: the rim triangulated, refined, and taut enough to be refined well.
//!
//! Based on: G. Barequet, M. Sharir, "Filling gaps in the boundary of a polyhedron", CAGD 12(2), 1995;
//! P. Liepa, "Filling holes in meshes", SGP 2003.

use super::task::Task;
use crate::error::Result;
use crate::fair::kharmonic::{Order, fair};
use crate::fair::laplacian::Weights;
use crate::math::sparse::SpdSolver;
use crate::patch::PatchSurface;
use crate::refine::{self, RefineOptions, RefineReport, grading, rim_sizes};
use crate::triangulate::{HolePolygon, TriangulationOptions, triangulate};

/// Edge lengths of the first, coarse patch over those of the final one.
const COARSENING: f64 = 2.0;

/// Polygon vertices that ear clipping leaves to the exhaustive search, and the largest rim searched whole. Few are
/// enough, since flips and fairing make up for what the search would find.
const START_EAR_REMAINDER: usize = 16;
const START_EXACT_LIMIT: usize = 24;

/// Relaxations of the coarse patch, which is only a start, and of the final one: a third hardly improves the
/// angles.
const COARSE_RELAXATIONS: usize = 0;
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

/// The start patch, made once for each hole.
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

/// Refines a patch of this hole whose vertices have moved. `sizes` holds the target edge length of each of its
/// vertices, and does so afterwards.
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

/// Refines a patch of this hole; its vertices are relaxed `relaxations` times at the end.
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
