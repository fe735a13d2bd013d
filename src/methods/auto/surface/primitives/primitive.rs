//! What the non-linear fit needs to know of a kind of surface.

use super::super::Sample;
use super::axis::{Axis, Revolved};
use crate::math::Vec3;
use nalgebra::SVector;

/// A surface with a closed formula for the distance from it.
pub(crate) trait Shape: Copy + Send + Sync {
    /// The distance of `p`, negative behind the surface, and its gradient, a unit vector.
    fn distance_and_normal(&self, p: &Vec3) -> (f64, Vec3);
}

/// A surface with `D` degrees of freedom that knows where to begin.
pub(crate) trait Primitive<const D: usize>: Shape {
    /// Where to begin, for samples of the size one round the origin.
    fn starts(samples: &[Sample]) -> Vec<Self>;

    /// The surface after a small step in its degrees of freedom.
    fn moved(&self, step: &SVector<f64, D>) -> Self;

    /// The axis of revolution.
    fn axis(&self) -> &Axis;

    /// Distance and normal at `p`, and how fast they change with the degrees of freedom; `across` are the two
    /// directions across the axis.
    fn linearize(&self, across: &[Vec3; 2], p: &Vec3) -> Linear<D>;
}

/// Distance and normal of a primitive at a point, to first order in its degrees of freedom.
pub(crate) struct Linear<const D: usize> {
    pub(super) distance: f64,
    pub(super) normal: Vec3,
    pub(super) distance_slopes: SVector<f64, D>,
    pub(super) normal_slopes: [Vec3; D],
}

impl<const D: usize> Linear<D> {
    pub(super) fn new(here: &Revolved, slopes: [(f64, Vec3); D]) -> Self {
        Self {
            distance: here.distance,
            normal: here.normal,
            distance_slopes: SVector::from_fn(|k, _| slopes[k].0),
            normal_slopes: slopes.map(|s| s.1),
        }
    }
}
