//! Circular cones: distance, derivatives, and starts for the fit.

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

/// One half of a circular cone. The origin of its axis is the apex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    axis: Axis,
    /// Angle between the axis and the surface.
    half_angle: f64,
    /// 1 when the normals point away from the axis, otherwise -1.
    side: f64,
}

impl Cone {
    /// Fits a cone to the samples. `None` when they lie in one place, are fewer than its 6 degrees of freedom, have a
    /// number that is not finite, or determine no cone.
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

/// Degrees of freedom: two angles of the axis, the position of the apex (3), the half angle.
impl Primitive<6> for Cone {
    /// Two starts with the same apex. All tangent planes pass through it: `n·x = n·p` is a linear system for it. Both
    /// differ in the direction of the axis. All tangent planes make the same angle with it, `n·a` = const, which gives
    /// the first; the axis of revolution gives the second, which is better where normals are sparse.
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
