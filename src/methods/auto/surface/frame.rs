//! Scaled coordinates for fits: the centroid of the samples is the origin, and their root mean square distance from it
//! is one. This keeps the linear systems well-conditioned.

use super::{Implicit, Sample};
use crate::math::Vec3;

/// A surface that was fitted to samples.
#[derive(Clone, Debug)]
pub(crate) struct Fit<S> {
    /// The surface, in the coordinates of the samples.
    pub(crate) surface: S,
    /// Root mean square distance of the samples from the surface, to first order.
    pub(crate) rms: f64,
}

/// The origin and the unit of the scaled coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    center: Vec3,
    scale: f64,
}

impl Frame {
    /// `None` when there is no sample, when all lie in one place, or when a number is not finite.
    pub(crate) fn around(samples: &[Sample]) -> Option<Self> {
        let is_finite = |s: &Sample| s.point.iter().chain(&s.normal).all(|x| x.is_finite());
        if samples.is_empty() || !samples.iter().all(is_finite) {
            return None;
        }
        let count = samples.len() as f64;
        let center = samples.iter().map(|s| s.point).sum::<Vec3>() / count;
        let square = samples
            .iter()
            .map(|s| (s.point - center).norm_squared())
            .sum::<f64>();
        let scale = (square / count).sqrt();
        (scale.is_normal()).then_some(Self { center, scale })
    }

    /// A point in the frame.
    pub(crate) fn enter(&self, p: &Vec3) -> Vec3 {
        (p - self.center) / self.scale
    }

    /// The samples in the frame.
    pub(crate) fn enter_all(&self, samples: &[Sample]) -> Vec<Sample> {
        let enter = |s: &Sample| Sample {
            point: self.enter(&s.point),
            normal: s.normal,
        };
        samples.iter().map(enter).collect()
    }

    /// The value of a function in the original coordinates, from its value in the frame. The function is scaled so that
    /// its gradient is the same in both.
    pub(crate) fn leave_value(&self, value: f64) -> f64 {
        value * self.scale
    }
}

/// Root mean square distance of the samples from the surface, to first order; `None` when it is not finite.
pub(crate) fn rms_distance(surface: &impl Implicit, samples: &[Sample]) -> Option<f64> {
    let squares = samples.iter().map(|s| {
        let (value, gradient) = surface.value_and_gradient(&s.point);
        value * value / gradient.norm_squared()
    });
    let rms = (squares.sum::<f64>() / samples.len() as f64).sqrt();
    rms.is_finite().then_some(rms)
}
