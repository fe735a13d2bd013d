//! GREY as a method of the pipeline.

use crate::error::Result;
use crate::fill::options::FillOptions;
use crate::job::Job;
use crate::patch::{HoleShape, PatchSurface};
use crate::predict::grey;

/// Rings of known triangles that the method reads.
pub(super) const RING_COUNT: u32 = grey::RING_COUNT;

/// The patch in the hole's coordinates.
///
/// # Errors
/// Those of [`grey::predict`].
pub(super) fn patch(
    hole: &HoleShape,
    options: &FillOptions,
    job: &Job<'_>,
) -> Result<PatchSurface> {
    grey::predict(
        hole,
        &options.grey,
        &options.hpde,
        options.max_new_vertices,
        job,
    )
}
