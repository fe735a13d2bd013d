//! A fan round the centroid: the simplest patch with a new vertex.

use super::method::Method;
use super::spec::MethodSpec;
use super::task::Task;
use crate::error::{Error, Result};
use crate::math::Vec3;
use crate::patch::PatchSurface;

/// The method.
pub(super) const CENTROID: MethodSpec = MethodSpec {
    name: "centroid",
    falls_back_to: &[Method::Flat],
    make,
    ..MethodSpec::USUAL
};

/// Joins every edge of the rim to one new vertex at the mean of the rim's vertices.
///
/// O(m) for m edges. Not guaranteed: that the patch is free of intersections; it is where the centroid sees the
/// whole rim.
///
/// # Errors
/// [`crate::ErrorKind::Topology`] for a rim with islands, [`crate::ErrorKind::Limit`] when no new vertex is allowed.
fn make(task: &Task<'_>) -> Result<PatchSurface> {
    let hole = task.hole;
    let (polygon, count) = (&hole.polygon, hole.rim().len());
    if polygon.len() != count {
        return Err(Error::topology("a fan closes no hole with islands"));
    }
    if task.options.refinement.max_vertices == 0 {
        return Err(Error::limit("no new vertex is allowed"));
    }
    let centroid = hole.rim().iter().sum::<Vec3>() / count as f64;
    let mut points = hole.rim().to_vec();
    points.push(centroid);
    let triangles = (0..count)
        .map(|i| [polygon[i], polygon[(i + 1) % count], count as u32])
        .collect();
    Ok(PatchSurface {
        rim_count: count,
        points,
        triangles,
    })
}
