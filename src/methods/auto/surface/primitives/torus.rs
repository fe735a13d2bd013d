//! Tori: distance, derivatives, and starts for the fit.

use super::axis::{
    Axis, Revolved, axis_of_revolution, covariance_of_normals, eigenvectors, inverse,
    solve_symmetric,
};
use super::primitive::{Linear, Primitive, Shape};
use super::{Fitted, fit};
use crate::math::Vec3;
use crate::methods::auto::surface::Sample;
use crate::methods::auto::surface::frame::Fit;
use nalgebra::{Matrix3, SVector};

/// Radii of the tube for the starts whose axis is only guessed, in scaled coordinates.
const TRIAL_TUBES: [f64; 4] = [0.6, 1.6, -0.6, -1.6];

/// A torus. Normals point out of the tube if its radius is positive, into it if it is negative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Torus {
    axis: Axis,
    /// Radius of the circle that is the center line of the tube.
    radius: f64,
    /// Radius of the tube.
    tube: f64,
}

impl Torus {
    /// Fits a torus to the samples. `None` when they lie in one place, are fewer than its 7 degrees of freedom, have a
    /// number that is not finite, or determine no torus.
    pub(crate) fn fit(samples: &[Sample]) -> Option<Fit<Fitted<Self>>> {
        fit(samples)
    }
}

impl Shape for Torus {
    fn distance_and_normal(&self, p: &Vec3) -> (f64, Vec3) {
        let (height, distance, away) = self.axis.locate(p);
        let from_circle = (distance - self.radius) * away + height * self.axis.direction;
        let length = from_circle.norm();
        let normal = if length > 0.0 {
            from_circle / length
        } else {
            away
        };
        let sign = self.tube.signum();
        (sign * length - self.tube, sign * normal)
    }
}

/// Degrees of freedom: two angles of the axis, the position of the center (3), the two radii.
impl Primitive<7> for Torus {
    /// The first start has the axis of revolution of the samples' normals. All `p - r n` lie on one circle round it;
    /// that is a linear system for `r`, the radius of the circle and its height. The other starts help where this axis
    /// is poor: they have the principal directions of the normals as axes, with several radii of the tube.
    fn starts(samples: &[Sample]) -> Vec<Self> {
        let mut starts = Vec::new();
        if let Some(axis) = axis_of_revolution(samples) {
            starts.extend(start_on_axis(axis, samples));
        }
        for direction in eigenvectors(covariance_of_normals(samples)) {
            for tube in TRIAL_TUBES {
                starts.extend(start_with_tube(direction, tube, samples));
            }
        }
        starts
    }

    fn moved(&self, step: &SVector<f64, 7>) -> Self {
        let [u, v] = self.axis.across();
        let mut axis = self.axis.turned(step[0], step[1]);
        axis.origin += step[2] * u + step[3] * v + step[4] * self.axis.direction;
        Self {
            axis,
            radius: self.radius + step[5],
            tube: self.tube + step[6],
        }
    }

    fn axis(&self) -> &Axis {
        &self.axis
    }

    fn linearize(&self, across: &[Vec3; 2], p: &Vec3) -> Linear<7> {
        let (height, distance, away) = self.axis.locate(p);
        let from_circle = (distance - self.radius) * away + height * self.axis.direction;
        let length = from_circle.norm();
        let sign = self.tube.signum();
        let (value, normal) = self.distance_and_normal(p);
        let along = self.axis.direction.cross(&away);
        let meridian = along.cross(&normal);
        let here = Revolved {
            arm: p - self.axis.origin,
            distance: value,
            normal,
            along,
            turn_along: normal.dot(&away) * inverse(distance),
            meridian,
            turn_meridian: sign * inverse(length),
        };
        let [a, b, c, d, e] = here.slopes(across, &self.axis.direction);
        let widened = -here.turn_meridian * meridian.dot(&away) * meridian;
        let radius = (-normal.dot(&away), widened);
        Linear::new(&here, [a, b, c, d, e, radius, (-1.0, Vec3::zeros())])
    }
}

fn start_on_axis(axis: Axis, samples: &[Sample]) -> Option<Torus> {
    let (mut matrix, mut target) = (Matrix3::zeros(), Vec3::zeros());
    for s in samples {
        let (height, distance, away) = axis.locate(&s.point);
        let rows = [
            (Vec3::new(s.normal.dot(&away), 1.0, 0.0), distance),
            (Vec3::new(s.normal.dot(&axis.direction), 0.0, 1.0), height),
        ];
        for (row, value) in rows {
            matrix += row * row.transpose();
            target += row * value;
        }
    }
    let [tube, radius, height] = solve_symmetric(matrix, &target).into();
    torus(axis, radius, tube, height)
}

fn start_with_tube(direction: Vec3, tube: f64, samples: &[Sample]) -> Option<Torus> {
    let mut axis = Axis {
        origin: Vec3::zeros(),
        direction,
    };
    let [u, v] = axis.across();
    let inner = |s: &Sample| s.point - tube * s.normal;
    let (mut matrix, mut target, mut height) = (Matrix3::zeros(), Vec3::zeros(), 0.0);
    for s in samples {
        let (x, y) = (inner(s).dot(&u), inner(s).dot(&v));
        let row = Vec3::new(2.0 * x, 2.0 * y, 1.0);
        matrix += row * row.transpose();
        target += row * (x * x + y * y);
        height += inner(s).dot(&direction);
    }
    let circle = solve_symmetric(matrix, &target);
    axis.origin = circle.x * u + circle.y * v;
    let count = samples.len() as f64;
    let radius = samples
        .iter()
        .map(|s| axis.locate(&inner(s)).1)
        .sum::<f64>()
        / count;
    torus(axis, radius, tube, height / count)
}

fn torus(mut axis: Axis, radius: f64, tube: f64, height: f64) -> Option<Torus> {
    axis.origin += height * axis.direction;
    (radius > 0.0 && tube != 0.0).then_some(Torus { axis, radius, tube })
}
