//! How large a triangle may be: the limit that tells a hole from the space between samples.
//!
//! The measure is the radius of the circle through a triangle's corners. On a sampled surface the circles of
//! the Delaunay triangles are empty, so that their radii tell how far apart samples are in the widest
//! direction, also where the spacing depends on the direction; across a hole they are as large as the hole.
//! A point's limit is a multiple of the median radius in its neighborhood; medians leave out the large
//! triangles beside a hole.
//!
//! The limit closes a gap only if all of it is closed: triangles beside what stays open must be smaller, see
//! [`RIM_SHARE`]. Between the two lie the triangles that a sparse spot needs, and those with which a hole would
//! be nibbled at.
//!
//! Complexity: O(k) per point for k neighbors.

use super::cloud::{Cloud, NearestPoints, for_all};
use crate::error::Result;
use crate::job::Job;
use crate::math::Vec3;

/// Automatic limit over the median radius of circumscribed circles. Of 100,000 triangles between points spread
/// at random without any order, the largest circle is about 3 times the median; a hole of this radius has
/// about 12 edges round it in a regular mesh.
pub(super) const LIMIT_OVER_MEDIAN: f64 = 3.0;

/// Share of the limit that a triangle at the edge of a hole may reach. Between 1 and 1.65 times the median lie
/// the triangles of a surface, above it those that span the bays of a rim.
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

/// The limit at each point, from the finite `radii` of the triangles at each.
///
/// Where a neighborhood has no triangle, that of all points is taken.
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

/// The middle value, the upper one of two; `None` when there is none.
pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    let (_, value, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*value)
}
