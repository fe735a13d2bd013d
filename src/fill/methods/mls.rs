//! Fills a hole by moving least squares over a reference plane or a sphere.
//!
//! Based on: J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed from point
//! clouds", preprint 2006, Image and Vision Computing 25(1), 2007. Where they mesh the whole model anew, the
//! samples are triangulated with the rim in the domain, and edges are flipped where the surface asks for it.

use crate::error::Result;
use crate::fill::options::FillOptions;
use crate::job::Job;
use crate::patch::{HoleShape, PatchSurface};
use crate::predict::mls::HeightField;
use crate::refine::{RefineOptions, refine};

/// Target edge length, in mean rim edges, at which no edge of a patch is split.
const UNSPLIT: f64 = 1e9;

/// The patch in the hole's coordinates.
///
/// # Errors
/// Those of [`HeightField::new`] and [`HeightField::patch`].
pub(crate) fn patch(
    hole: &HoleShape,
    options: &FillOptions,
    job: &Job<'_>,
) -> Result<PatchSurface> {
    let field = HeightField::new(hole, &hole.surroundings, &options.mls, job)?;
    let mut surface = field.patch(options.max_new_vertices, job)?;
    // Delaunay in the domain is not Delaunay on a steep surface.
    let flips_only = RefineOptions {
        pass_relaxations: 0,
        final_relaxations: 0,
        max_vertices: surface.points.len(),
        ..RefineOptions::new(job)
    };
    let mut sizes = vec![UNSPLIT; surface.points.len()];
    refine(&mut surface, &mut sizes, &flips_only, &|a, b| {
        hole.is_joined(a, b)
    })?;
    Ok(surface)
}
