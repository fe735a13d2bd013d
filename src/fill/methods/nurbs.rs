//! NURBS as a method of the pipeline.

use crate::error::Result;
use crate::fill::options::FillOptions;
use crate::job::Job;
use crate::patch::{HoleShape, PatchSurface};
use crate::predict::nurbs;

/// Rings of known triangles that the method reads.
pub(super) const RING_COUNT: u32 = nurbs::RING_COUNT;

/// The patch in the hole's coordinates.
///
/// # Errors
/// Those of [`nurbs::predict`].
pub(super) fn patch(
    hole: &HoleShape,
    options: &FillOptions,
    job: &Job<'_>,
) -> Result<PatchSurface> {
    nurbs::predict(
        hole,
        &options.nurbs,
        &options.hpde,
        options.max_new_vertices,
        job,
    )
}
