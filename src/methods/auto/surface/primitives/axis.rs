//! The axis of a primitive: how a surface of revolution changes when its axis moves, and how the axis is estimated from
//! samples with normals.

use crate::math::frame::axes_across;
use crate::math::{Vec3, unit};
use crate::methods::auto::surface::Sample;
use nalgebra::{Matrix3, SymmetricEigen};

/// Eigenvalues of a normal matrix below this part of the largest one are rounding errors.
const SINGULAR: f64 = 1e-12;

/// A directed line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub(super) origin: Vec3,
    /// Of length one.
    pub(super) direction: Vec3,
}

impl Axis {
    /// The height of `p` above the origin along the axis, its distance from the axis, and the unit vector from the axis
    /// to `p`.
    pub(super) fn locate(&self, p: &Vec3) -> (f64, f64, Vec3) {
        let arm = p - self.origin;
        let height = arm.dot(&self.direction);
        let across = arm - height * self.direction;
        (height, across.norm(), unit(across))
    }

    /// Two unit vectors that make a right-handed frame with the direction.
    pub(super) fn across(&self) -> [Vec3; 2] {
        axes_across(&self.direction)
    }

    /// The axis turned by two small angles.
    pub(super) fn turned(&self, a: f64, b: f64) -> Self {
        let [u, v] = self.across();
        Self {
            origin: self.origin,
            direction: unit(self.direction + a * u + b * v),
        }
    }
}

/// The distance function of a surface of revolution at one point, to second order.
pub(super) struct Revolved {
    /// Vector from the origin of the axis to the point.
    pub(super) arm: Vec3,
    pub(super) distance: f64,
    pub(super) normal: Vec3,
    /// The direction of the circle through the point, and how fast the normal turns along it.
    pub(super) along: Vec3,
    pub(super) turn_along: f64,
    /// The direction of the meridian there, and how fast the normal turns along it.
    pub(super) meridian: Vec3,
    pub(super) turn_meridian: f64,
}

impl Revolved {
    /// The derivatives of distance and normal by the motion of the axis: by the two angles of [`Axis::turned`], by
    /// shifts in the two directions across the axis, and by a shift along it.
    pub(super) fn slopes(&self, across: &[Vec3; 2], direction: &Vec3) -> [(f64, Vec3); 5] {
        let [u, v] = across;
        [
            self.when_turned(v),
            self.when_turned(&-u),
            self.when_moved(u),
            self.when_moved(v),
            self.when_moved(direction),
        ]
    }

    /// The derivatives when the surface moves by `shift` and the point rests.
    fn when_moved(&self, shift: &Vec3) -> (f64, Vec3) {
        let bend = self.turn_along * self.along.dot(shift) * self.along
            + self.turn_meridian * self.meridian.dot(shift) * self.meridian;
        (-self.normal.dot(shift), -bend)
    }

    fn when_turned(&self, rotation: &Vec3) -> (f64, Vec3) {
        let (distance, normal) = self.when_moved(&rotation.cross(&self.arm));
        (distance, normal + rotation.cross(&self.normal))
    }
}

/// Two unit vectors that make a right-handed frame with `direction`.
pub(super) fn inverse(length: f64) -> f64 {
    if length > 0.0 { length.recip() } else { 0.0 }
}

/// Eigenvectors of a symmetric matrix, in ascending order of their eigenvalues.
pub(super) fn eigenvectors(matrix: Matrix3<f64>) -> [Vec3; 3] {
    let eigen = SymmetricEigen::new(matrix);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    order.map(|k| eigen.eigenvectors.column(k).into_owned())
}

/// `Σ n nᵀ` over the samples' normals.
pub(super) fn scatter_of_normals(samples: &[Sample]) -> Matrix3<f64> {
    samples
        .iter()
        .map(|s| s.normal * s.normal.transpose())
        .sum()
}

/// The covariance of the samples' normals, times their number.
pub(super) fn covariance_of_normals(samples: &[Sample]) -> Matrix3<f64> {
    let mean = samples.iter().map(|s| s.normal).sum::<Vec3>() / samples.len() as f64;
    let deviation = |s: &Sample| s.normal - mean;
    samples
        .iter()
        .map(|s| deviation(s) * deviation(s).transpose())
        .sum()
}

/// The solution of a symmetric positive semidefinite system; that of smallest norm if it is singular.
pub(super) fn solve_symmetric(matrix: Matrix3<f64>, target: &Vec3) -> Vec3 {
    let eigen = SymmetricEigen::new(matrix);
    let cut = SINGULAR * eigen.eigenvalues.amax();
    let mut solution = Vec3::zeros();
    for k in 0..3 {
        let column = eigen.eigenvectors.column(k);
        if eigen.eigenvalues[k] > cut {
            solution += column * (column.dot(target) / eigen.eigenvalues[k]);
        }
    }
    solution
}

/// The axis of the surface of revolution whose normals are nearest to the samples' normals.
///
/// Based on: H. Pottmann, T. Randrup, "Rotational and helical surface approximation for reverse engineering",
/// Computing 60, 1998. All normals of such a surface meet its axis. So there is a velocity field `v(x) = c̄ + c × x`
/// with `v·n = c̄·n + c·(x × n) = 0`. `Σ (v·n)²` is minimized with `|c| = 1`. `None` when a number is not finite.
pub(super) fn axis_of_revolution(samples: &[Sample]) -> Option<Axis> {
    let (mut moments, mut mixed) = (Matrix3::zeros(), Matrix3::zeros());
    for s in samples {
        let moment = s.point.cross(&s.normal);
        moments += moment * moment.transpose();
        mixed += s.normal * moment.transpose();
    }
    let normals = scatter_of_normals(samples);
    let shift = |c: &Vec3| -solve_symmetric(normals, &(mixed * c));
    let mut reduced = moments;
    for k in 0..3 {
        let column = mixed.tr_mul(&shift(&Vec3::ith(k, 1.0)));
        reduced.set_column(k, &(reduced.column(k) + column));
    }
    let reduced = (reduced + reduced.transpose()) / 2.0;
    if !reduced.iter().all(|x| x.is_finite()) {
        return None;
    }
    let direction = eigenvectors(reduced)[0];
    let origin = direction.cross(&shift(&direction));
    Some(Axis { origin, direction })
}
