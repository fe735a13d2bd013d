//! Circular cylinders: distance, derivatives, and starts for the fit.

use super::axis::{Axis, Revolved, eigenvectors, inverse, scatter_of_normals, solve_symmetric};
use super::primitive::{Linear, Primitive, Shape};
use super::{Fitted, fit};
use crate::math::Vec3;
use crate::methods::auto::surface::Sample;
use crate::methods::auto::surface::frame::Fit;
use nalgebra::{Matrix3, SVector};

/// A circular cylinder. Normals point away from the axis if the radius is positive, toward it if it is negative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cylinder {
    axis: Axis,
    radius: f64,
}

impl Cylinder {
    /// Fits a cylinder to the samples. `None` when they lie in one place, are fewer than its 5 degrees of freedom,
    /// have a number that is not finite, or determine no cylinder.
    pub(crate) fn fit(samples: &[Sample]) -> Option<Fit<Fitted<Self>>> {
        fit(samples)
    }
}

impl Shape for Cylinder {
    fn distance_and_normal(&self, p: &Vec3) -> (f64, Vec3) {
        let (_, distance, away) = self.axis.locate(p);
        let sign = self.radius.signum();
        (sign * distance - self.radius, sign * away)
    }
}

/// Degrees of freedom: two angles of the axis, its shift in two directions across it, the radius.
impl Primitive<5> for Cylinder {
    /// One start for each eigenvector of `Σ n nᵀ` as the direction of the axis: the normals of a cylinder are
    /// perpendicular to its axis. For a given direction, all `p - r n` have the same projection along it. That is a
    /// linear system for this point and `r`.
    fn starts(samples: &[Sample]) -> Vec<Self> {
        let axes = eigenvectors(scatter_of_normals(samples));
        axes.into_iter()
            .filter_map(|direction| start(direction, samples))
            .collect()
    }

    fn moved(&self, step: &SVector<f64, 5>) -> Self {
        let [u, v] = self.axis.across();
        let mut axis = self.axis.turned(step[0], step[1]);
        axis.origin += step[2] * u + step[3] * v;
        Self {
            axis,
            radius: self.radius + step[4],
        }
    }

    fn axis(&self) -> &Axis {
        &self.axis
    }

    fn linearize(&self, across: &[Vec3; 2], p: &Vec3) -> Linear<5> {
        let (_, distance, away) = self.axis.locate(p);
        let sign = self.radius.signum();
        let here = Revolved {
            arm: p - self.axis.origin,
            distance: sign * distance - self.radius,
            normal: sign * away,
            along: self.axis.direction.cross(&away),
            turn_along: sign * inverse(distance),
            meridian: self.axis.direction,
            turn_meridian: 0.0,
        };
        let [a, b, c, d, _] = here.slopes(across, &self.axis.direction);
        Linear::new(&here, [a, b, c, d, (-1.0, Vec3::zeros())])
    }
}

fn start(direction: Vec3, samples: &[Sample]) -> Option<Cylinder> {
    let axis = Axis {
        origin: Vec3::zeros(),
        direction,
    };
    let [u, v] = axis.across();
    let (mut matrix, mut target) = (Matrix3::zeros(), Vec3::zeros());
    for s in samples {
        for (k, across) in [u, v].iter().enumerate() {
            let mut row = Vec3::zeros();
            row[k] = 1.0;
            row[2] = s.normal.dot(across);
            matrix += row * row.transpose();
            target += row * s.point.dot(across);
        }
    }
    let solution = solve_symmetric(matrix, &target);
    let origin = solution[0] * u + solution[1] * v;
    let start = Cylinder {
        axis: Axis { origin, direction },
        radius: solution[2],
    };
    (start.radius != 0.0).then_some(start)
}
