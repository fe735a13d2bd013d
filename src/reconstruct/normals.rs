//! Estimates normals of points, without a sign: the direction in which the nearest points spread least.
//!
//! It is the eigenvector of the smallest eigenvalue of the covariance of the neighbors. If the nearest points lie on a
//! line, as on a scan line, they determine no plane, and more points are taken.
//!
//! Source: H. Hoppe, T. DeRose, T. Duchamp, J. McDonald, W. Stuetzle, Surface reconstruction from unorganized points,
//! SIGGRAPH 1992, section 3.1.
//!
//! Complexity: O(k) for each point with k neighbors. Not guaranteed: exact normals at a crease, where the estimate is a
//! mean of both sides.

use super::cloud::{Cloud, NearestPoints, for_all};
use crate::error::Result;
use crate::job::Job;
use crate::math::Vec3;
use nalgebra::{Matrix3, SymmetricEigen};

/// Number of neighbors that determine a normal.
pub(super) const NORMAL_NEIGHBORS: usize = 12;

/// Neighbors lie on a line if their second largest spread is below this share of the largest.
const LINE_SPREAD: f64 = 0.15;

/// Factors on the number of neighbors, tried in turn if the neighbors lie on a line.
const WIDER: [usize; 2] = [2, 4];

/// Unit normals: the `known` ones, otherwise estimated ones of either sign. Zero where the neighbors lie on a line.
///
/// # Errors
/// `Cancelled` when the job is cancelled.
pub(super) fn estimate(
    cloud: &Cloud,
    neighbors: &NearestPoints,
    known: &[Option<Vec3>],
    job: &Job<'_>,
) -> Result<Vec<Vec3>> {
    for_all(cloud.len(), job, |v| {
        if let Some(normal) = known[v as usize] {
            return normal;
        }
        let near = neighbors.of(v);
        let first = spread(cloud, v, &near[..near.len().min(NORMAL_NEIGHBORS)]);
        if !first.is_line() {
            return first.normal();
        }
        let mut best = first;
        for factor in WIDER {
            let wider = spread(cloud, v, &cloud.nearest(v, factor * NORMAL_NEIGHBORS));
            best = wider;
            if !best.is_line() {
                break;
            }
        }
        best.normal()
    })
}

/// The principal directions of a neighborhood, by ascending variance.
struct Spread {
    variances: [f64; 3],
    across: Vec3,
}

impl Spread {
    fn is_line(&self) -> bool {
        self.variances[1] < LINE_SPREAD * LINE_SPREAD * self.variances[2]
    }

    /// The direction of least spread, if there is one.
    fn normal(&self) -> Vec3 {
        let has_plane = self.variances[1] > self.variances[2] * f64::EPSILON;
        if has_plane && self.across.iter().all(|c| c.is_finite()) {
            self.across
        } else {
            Vec3::zeros()
        }
    }
}

fn spread(cloud: &Cloud, v: u32, near: &[u32]) -> Spread {
    let at = cloud.points[v as usize];
    let offsets = || near.iter().map(|&w| cloud.points[w as usize] - at);
    let count = near.len() as f64 + 1.0;
    let centroid = offsets().sum::<Vec3>() / count;
    // The last neighbor is the farthest. Dividing by its distance avoids underflow.
    let unit = offsets().next_back().map_or(1.0, |d| d.norm());
    let mut covariance = Matrix3::zeros();
    for d in offsets().chain(std::iter::once(Vec3::zeros())) {
        let d = (d - centroid) / unit;
        covariance += d * d.transpose();
    }
    let eigen = SymmetricEigen::new(covariance / count);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    Spread {
        variances: order.map(|k| eigen.eigenvalues[k].max(0.0)),
        across: eigen.eigenvectors.column(order[0]).into(),
    }
}
