//! Measures the quality of surfaces: shape of triangles, topology, deviation, self-intersection.
//!
//! All functions take plain slices, so that any layer and any test can call them. They change nothing.

pub(crate) mod closest;
pub mod deviation;
pub(crate) mod intersect;
#[cfg(test)]
mod near_coplanar;
mod projection;
pub(crate) mod self_intersection;
mod separation;
pub(crate) mod shape;
pub(crate) mod spatial;
#[cfg(test)]
pub(crate) mod topology;

use crate::math::Vec3;

/// A triangulated surface as two slices; every index must be below `points.len()`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface<'a> {
    /// Vertex positions.
    pub(crate) points: &'a [Vec3],
    /// Indices into `points`.
    pub(crate) triangles: &'a [[u32; 3]],
}

impl Surface<'_> {
    /// The three corner positions of a face.
    pub(crate) fn corners(&self, face: usize) -> [Vec3; 3] {
        self.triangles[face].map(|v| self.points[v as usize])
    }
}

/// The value below which the share `q` of the ascending `sorted` values lies, interpolated linearly
/// between neighbors; `None` when there are no values.
fn quantile(sorted: &[f64], q: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let position = q.clamp(0.0, 1.0) * last as f64;
    let below = position.floor() as usize;
    let above = (below + 1).min(last);
    let share = position - below as f64;
    Some(sorted[below] + share * (sorted[above] - sorted[below]))
}

#[cfg(test)]
mod tests {
    use super::quantile;

    #[test]
    fn quantiles_interpolate_between_neighbors() {
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(quantile(&[3.0], 0.95), Some(3.0));
        assert_eq!(quantile(&[0.0, 1.0, 4.0], 0.75), Some(2.5));
        assert_eq!(quantile(&[0.0, 1.0, 4.0], 1.0), Some(4.0));
    }
}
