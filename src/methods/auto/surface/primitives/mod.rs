//! Fits cylinders, cones and tori by non-linear least squares.
//!
//! The cost is a sum of squares: the distances of the samples from the primitive, and, with a weight, the differences
//! between their normals and those of the primitive. It is minimized by the method of K. Levenberg, "A method for the
//! solution of certain non-linear problems in least squares", Quarterly of Applied Mathematics 2(2), 1944, and
//! D. Marquardt, "An algorithm for least-squares estimation of nonlinear parameters", SIAM J. Appl. Math. 11(2), 1963.
//! Each kind computes several starts from the samples and their normals. The best of them are improved, first for a few
//! steps, then the best one or two to the end.
//!
//! Cost: linear in the number of samples. Not guaranteed: that the global minimum is found.

mod axis;
pub(crate) mod cone;
pub(crate) mod cylinder;
mod levenberg_marquardt;
mod primitive;
#[cfg(test)]
mod tests;
pub(crate) mod torus;

use super::frame::{Fit, Frame, rms_distance};
use super::{Implicit, Sample};
use crate::math::Vec3;
use levenberg_marquardt::{FitProgress, improve};
use primitive::{Primitive, Shape};
use std::ops::Range;

/// Number of starts that are improved: those with the lowest cost.
const TRIALS: usize = 4;
/// Steps of each start before the finalists are chosen.
const TRIAL_STEPS: usize = 6;

/// Upper bound on the steps of a finalist. A good start needs five to ten.
const STEPS: usize = 40;

/// Upper bound on the number of finalists.
const FINALISTS: usize = 2;
/// The second finalist is followed only if its cost, divided by that of the first, is in this range. Below it, both
/// have usually reached the same minimum; above it, the second one rarely overtakes.
const OTHER_MINIMUM: Range<f64> = 1.01..4.0;

/// Lower bound on the samples for each degree of freedom.
const SAMPLES_PER_FREEDOM: usize = 1;

/// A primitive in the coordinates of the samples that it was fitted to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fitted<P> {
    primitive: P,
    frame: Frame,
}

/// Fits a primitive to the samples. `None` when they lie in one place, are fewer than its degrees of freedom, have a
/// number that is not finite, or do not determine a primitive (as coplanar samples determine no cylinder).
///
/// # Complexity
/// Linear in the number of samples, with some hundred evaluations of the distance for each sample and start.
fn fit<const D: usize, P: Primitive<D>>(samples: &[Sample]) -> Option<Fit<Fitted<P>>> {
    if samples.len() < SAMPLES_PER_FREEDOM * D {
        return None;
    }
    let frame = Frame::around(samples)?;
    let scaled = frame.enter_all(samples);
    let follow = |starts: Vec<P>, count: usize, steps: usize| {
        let follow = |start| improve(start, &scaled, steps);
        let mut reached: Vec<FitProgress<P>> = starts.into_iter().filter_map(follow).collect();
        reached.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        reached.truncate(count);
        reached
    };
    let primitives =
        |reached: Vec<FitProgress<P>>| reached.into_iter().map(|r| r.primitive).collect();
    let starts = primitives(follow(P::starts(&scaled), TRIALS, 0));
    let mut finalists = follow(starts, FINALISTS, TRIAL_STEPS);
    if let [first, second] = &finalists[..]
        && !OTHER_MINIMUM.contains(&(second.cost / first.cost))
    {
        finalists.pop();
    }
    let finalists = primitives(finalists);
    let best = follow(finalists, 1, STEPS).pop()?;
    let surface = Fitted {
        primitive: best.primitive,
        frame,
    };
    let rms = rms_distance(&surface, samples)?;
    Some(Fit { surface, rms })
}

impl<P: Shape> Implicit for Fitted<P> {
    fn value_and_gradient(&self, p: &Vec3) -> (f64, Vec3) {
        let (distance, normal) = self.primitive.distance_and_normal(&self.frame.enter(p));
        (self.frame.leave_value(distance), normal)
    }
}
