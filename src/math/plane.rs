//! Principal component analysis of points in space: centroid, principal directions, and spread along them.

use super::Vec3;
use nalgebra::{Matrix3, SymmetricEigen};

/// Root mean square distance of `points` from their centroid along each principal direction, largest first; zeros when
/// there is no point. The last value is the distance from the least squares plane.
pub(crate) fn principal_spreads(points: &[Vec3]) -> [f64; 3] {
    let mut spreads = eigen(points).1.eigenvalues.map(|v| v.max(0.0).sqrt());
    spreads.as_mut_slice().sort_by(|a, b| b.total_cmp(a));
    spreads.into()
}

/// The centroid of `points` and their principal directions as unit vectors, by descending spread. The first two span
/// the least squares plane; the last is its normal.
pub(crate) fn principal_axes(points: &[Vec3]) -> (Vec3, [Vec3; 3]) {
    let (centroid, eigen) = eigen(points);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    (
        centroid,
        order.map(|k: usize| eigen.eigenvectors.column(k).into_owned()),
    )
}

/// The centroid, and the variances with their directions in no particular order.
fn eigen(points: &[Vec3]) -> (Vec3, SymmetricEigen<f64, nalgebra::Const<3>>) {
    let count = points.len().max(1) as f64;
    let centroid = points.iter().sum::<Vec3>() / count;
    let mut covariance = Matrix3::zeros();
    for p in points {
        let d = p - centroid;
        covariance += d * d.transpose();
    }
    (centroid, SymmetricEigen::new(covariance / count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_spreads_by_half_its_sides_wherever_it_lies() {
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, 1.1, -0.7);
        let corners: Vec<Vec3> = (0..8)
            .map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
            .map(|p| turn * p.component_mul(&Vec3::new(2.0, 6.0, 4.0)) + Vec3::repeat(9.0))
            .collect();
        let spreads = principal_spreads(&corners);
        for (spread, expected) in spreads.iter().zip([3.0, 2.0, 1.0]) {
            assert!((spread - expected).abs() < 1e-12, "{spreads:?}");
        }
    }

    #[test]
    fn the_axes_of_a_box_are_its_edges() {
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, 1.1, -0.7);
        let corners: Vec<Vec3> = (0..8)
            .map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
            .map(|p| turn * p.component_mul(&Vec3::new(2.0, 6.0, 4.0)) + Vec3::repeat(9.0))
            .collect();
        let (centroid, axes) = principal_axes(&corners);
        assert!((centroid - turn * Vec3::new(1.0, 3.0, 2.0) - Vec3::repeat(9.0)).norm() < 1e-12);
        for (axis, edge) in axes.iter().zip([Vec3::y(), Vec3::z(), Vec3::x()]) {
            assert!((axis.dot(&(turn * edge)).abs() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn points_of_a_plane_a_line_and_one_place_have_no_spread_across() {
        let plane = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        assert!(principal_spreads(&plane)[2] < 1e-12);
        assert!(principal_spreads(&[Vec3::zeros(), Vec3::x()])[1] < 1e-12);
        assert_eq!(principal_spreads(&[Vec3::repeat(3.0); 4]), [0.0; 3]);
        assert_eq!(principal_spreads(&[]), [0.0; 3]);
    }
}
