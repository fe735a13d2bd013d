//! The plane of least squares through a set of points.

use super::{Vec3, unit};
use nalgebra::{Matrix3, SymmetricEigen};

/// A plane through `origin`, with the spread of the points along its three principal directions.
#[derive(Clone, Debug)]
pub(crate) struct FittedPlane {
    /// Centroid of the points.
    pub(crate) origin: Vec3,
    /// Unit directions by falling spread; the last one is the plane's normal.
    pub(crate) axes: [Vec3; 3],
    /// Root mean square distance from the centroid along each axis.
    pub(crate) spread: [f64; 3],
}

/// Fits a plane to `points` by principal component analysis; `None` when there are none.
pub(crate) fn fit_plane(points: &[Vec3]) -> Option<FittedPlane> {
    if points.is_empty() {
        return None;
    }
    let count = points.len() as f64;
    let origin = points.iter().sum::<Vec3>() / count;
    let mut covariance = Matrix3::zeros();
    for p in points {
        let d = p - origin;
        covariance += d * d.transpose();
    }
    let eigen = SymmetricEigen::new(covariance / count);
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    let axis = |k: usize| unit(eigen.eigenvectors.column(order[k]).into_owned());
    let spread = |k: usize| eigen.eigenvalues[order[k]].max(0.0).sqrt();
    Some(FittedPlane {
        origin,
        axes: [axis(0), axis(1), axis(2)],
        spread: [spread(0), spread(1), spread(2)],
    })
}
