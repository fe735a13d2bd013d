//! Circular cones.

use super::axis::{
    Axis, Revolved, axis_of_revolution, covariance_of_normals, eigenvectors, inverse,
    scatter_of_normals, solve_symmetric,
};
use super::primitive::{Linear, Primitive, Shape};
use super::{Fitted, fit};
use crate::math::Vec3;
use crate::methods::auto::surface::Sample;
use crate::methods::auto::surface::frame::Fit;
use nalgebra::SVector;

/// One half of a circular cone: its axis begins at the apex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    axis: Axis,
    /// Between the axis and the surface.
    half_angle: f64,
    /// 1 when the normals point away from the axis, else -1.
    side: f64,
}

impl Cone {
    /// Fits a cone to the samples. `None` when they lie in one place, are fewer than its 6 degrees of freedom,
    /// hold a number that is not finite, or lead to no cone.
    pub(crate) fn fit(samples: &[Sample]) -> Option<Fit<Fitted<Self>>> {
        fit(samples)
    }
}

impl Shape for Cone {
    fn distance_and_normal(&self, p: &Vec3) -> (f64, Vec3) {
        let (height, distance, away) = self.axis.locate(p);
        let (sin, cos) = self.half_angle.sin_cos();
        (
            self.side * (distance * cos - height * sin),
            self.side * (cos * away - sin * self.axis.direction),
        )
    }
}

/// Turning the axis (2), shifting the apex (3), the half angle.
impl Primitive<6> for Cone {
    /// The tangent planes all pass through the apex, `n·x = n·p`, and make the same angle with the axis,
    /// `n·a` = const. The axis of revolution is a second suggestion for it, which sparse normals blur less.
    fn starts(samples: &[Sample]) -> Vec<Self> {
        let target = samples.iter().map(|s| s.normal * s.normal.dot(&s.point));
        let apex = solve_symmetric(scatter_of_normals(samples), &target.sum());
        let directions = [
            Some(eigenvectors(covariance_of_normals(samples))[0]),
            axis_of_revolution(samples).map(|a| a.direction),
        ];
        directions
            .into_iter()
            .flatten()
            .filter_map(|direction| start(apex, direction, samples))
            .collect()
    }

    fn moved(&self, step: &SVector<f64, 6>) -> Self {
        let [u, v] = self.axis.across();
        let mut axis = self.axis.turned(step[0], step[1]);
        axis.origin += step[2] * u + step[3] * v + step[4] * self.axis.direction;
        Self {
            axis,
            half_angle: self.half_angle + step[5],
            side: self.side,
        }
    }

    fn axis(&self) -> &Axis {
        &self.axis
    }

    fn linearize(&self, across: &[Vec3; 2], p: &Vec3) -> Linear<6> {
        let (height, distance, away) = self.axis.locate(p);
        let (sin, cos) = self.half_angle.sin_cos();
        let generator = cos * self.axis.direction + sin * away;
        let here = Revolved {
            arm: p - self.axis.origin,
            distance: self.side * (distance * cos - height * sin),
            normal: self.side * (cos * away - sin * self.axis.direction),
            along: self.axis.direction.cross(&away),
            turn_along: self.side * cos * inverse(distance),
            meridian: generator,
            turn_meridian: 0.0,
        };
        let [a, b, c, d, e] = here.slopes(across, &self.axis.direction);
        let opened = -self.side * (distance * sin + height * cos);
        Linear::new(&here, [a, b, c, d, e, (opened, -self.side * generator)])
    }
}

fn start(apex: Vec3, direction: Vec3, samples: &[Sample]) -> Option<Cone> {
    let mut axis = Axis {
        origin: apex,
        direction,
    };
    let count = samples.len() as f64;
    let mean_height = |axis: &Axis| samples.iter().map(|s| axis.locate(&s.point).0).sum::<f64>();
    if mean_height(&axis) < 0.0 {
        axis.direction = -direction;
    }
    let distance = samples.iter().map(|s| axis.locate(&s.point).1).sum::<f64>() / count;
    let outward = |s: &Sample| axis.locate(&s.point).2.dot(&s.normal);
    let cone = Cone {
        axis,
        half_angle: distance.atan2(mean_height(&axis) / count),
        side: samples.iter().map(outward).sum::<f64>().signum(),
    };
    cone.half_angle.is_finite().then_some(cone)
}
