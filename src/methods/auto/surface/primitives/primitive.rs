//! The interface between the non-linear fit and a kind of surface: [`Shape`], [`Primitive`] and [`Linear`].

use super::super::Sample;
use super::axis::{Axis, Revolved};
use crate::math::Vec3;
use nalgebra::SVector;

/// A surface with a closed formula for the distance from it.
pub(crate) trait Shape: Copy + Send + Sync {
    /// The signed distance of `p`, negative behind the surface, and its gradient, a unit vector.
    fn distance_and_normal(&self, p: &Vec3) -> (f64, Vec3);
}

/// A kind of surface with `D` degrees of freedom that can be fitted.
pub(crate) trait Primitive<const D: usize>: Shape {
    /// Starts for the fit, from samples with their centroid at the origin and unit spread.
    fn starts(samples: &[Sample]) -> Vec<Self>;

    /// The surface after a small step in its degrees of freedom.
    fn moved(&self, step: &SVector<f64, D>) -> Self;

    /// The axis of revolution.
    fn axis(&self) -> &Axis;

    /// Distance and normal at `p`, and their derivatives by the degrees of freedom. `across` are the two unit vectors
    /// of [`Axis::across`].
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
