//! Limits the size of triangles, which separates holes from the space between samples.
//!
//! The size of a triangle is the radius of its circumscribed circle. On a sampled surface, the circles of Delaunay
//! triangles are empty, so their radii measure the distance of samples, also where it depends on the direction. Across
//! a hole, the radii are as large as the hole. The limit of a point is a multiple of the median radius in its
//! neighborhood; the median ignores the few large triangles beside a hole.
//!
//! Triangles at the rim of a hole have a smaller limit, see [`RIM_SHARE`]. Between the two limits are the triangles
//! that close a sparse place completely. Without the smaller limit, such triangles would also cover the border of a
//! hole.
//!
//! Complexity: O(k) for each point with k neighbors.

use super::cloud::{Cloud, NearestPoints, for_all};
use crate::error::Result;
use crate::job::Job;
use crate::math::Vec3;

/// Automatic limit, divided by the median radius of circumscribed circles. Measured: of 100,000 triangles between
/// random points, the largest circle is about 3 times the median. In a regular mesh, a hole of this radius has about
/// 12 edges.
pub(super) const LIMIT_OVER_MEDIAN: f64 = 3.0;

/// Limit for a triangle at the rim of a hole, as a share of the limit elsewhere. It is 1.65 times the median. Larger
/// triangles at a rim usually span its concave parts.
pub(super) const RIM_SHARE: f64 = 0.55;

/// The radius of the circle through three points; infinite when they are on a line.
pub(super) fn circumradius([a, b, c]: [Vec3; 3]) -> f64 {
    let (p, q) = (b - a, c - a);
    let double_area = p.cross(&q).norm();
    if double_area > 0.0 {
        p.norm() * q.norm() * (c - b).norm() / (2.0 * double_area)
    } else {
        f64::INFINITY
    }
}

/// The limit at each point, from the finite `radii` of the triangles at each point. A point whose neighborhood has no
/// triangle gets the limit from the triangles of all points.
///
/// # Errors
/// `Cancelled` when the job is cancelled.
pub(super) fn limits(
    cloud: &Cloud,
    neighbors: &NearestPoints,
    radii: &[Vec<f64>],
    job: &Job<'_>,
) -> Result<Vec<f64>> {
    let medians: Vec<Option<f64>> = radii.iter().map(|r| median(r.clone())).collect();
    let overall = median(medians.iter().flatten().copied().collect()).unwrap_or(0.0);
    for_all(cloud.len(), job, |v| {
        let near = neighbors.of(v).iter().chain(std::iter::once(&v));
        let near = near.filter_map(|&w| medians[w as usize]);
        LIMIT_OVER_MEDIAN * median(near.collect()).unwrap_or(overall)
    })
}

/// The median, the upper one of two middle values; `None` when there are no values.
pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    let (_, value, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*value)
}
