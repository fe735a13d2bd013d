//! The Levenberg-Marquardt method for fitting a primitive to samples with normals.
//!
//! The axis of a primitive is a direction with two degrees of freedom, not three. So each step is computed in
//! coordinates round the present primitive, which a general solver does not do. Sources: see the module `primitives`.
//! Cost: linear in the number of samples for each step.

use super::primitive::Primitive;
use crate::methods::auto::surface::Sample;
use nalgebra::{SMatrix, SVector};

/// Weight of a difference of normals, relative to a distance in scaled coordinates. Normals are noisier than
/// positions by about this factor.
const NORMAL_WEIGHT: f64 = 0.3;

/// The damping at the start.
const FIRST_DAMPING: f64 = 1e-3;
/// Factors on the damping after a step that lowers the cost, and after one that does not.
const DAMPING_FALL: f64 = 0.2;
const DAMPING_RISE: f64 = 5.0;
/// The iteration ends when the damping reaches this.
const MOST_DAMPING: f64 = 1e9;

/// The iteration ends after a step that is shorter than `SETTLED_STEP` or lowers the cost by less than the share
/// `SETTLED_FALL`. Further steps would move the surface by about 1e-4 of the residuals. If the samples lie exactly on a
/// primitive, each step removes nearly all of the cost, and the iteration goes on until it is reached.
const SETTLED_STEP: f64 = 1e-12;
const SETTLED_FALL: f64 = 1e-8;

/// Upper bound on a step in any degree of freedom, in scaled coordinates.
const LONGEST_STEP: f64 = 2.0;

/// A primitive and its cost.
pub(super) struct FitProgress<P> {
    pub(super) cost: f64,
    pub(super) primitive: P,
}

/// Improves `start` by at most `steps` steps. `None` when its cost is not finite.
pub(super) fn improve<const D: usize, P: Primitive<D>>(
    start: P,
    samples: &[Sample],
    steps: usize,
) -> Option<FitProgress<P>> {
    let mut primitive = start;
    let mut cost = cost_of(&primitive, samples);
    if !cost.is_finite() {
        return None;
    }
    let mut damping = FIRST_DAMPING;
    for _ in 0..steps {
        let (hessian, slope) = normal_equations(&primitive, samples);
        let mut settled = true;
        while damping < MOST_DAMPING {
            let mut damped = hessian;
            let largest = hessian.diagonal().max();
            for k in 0..D {
                damped[(k, k)] += damping * hessian[(k, k)] + f64::EPSILON * largest;
            }
            let step = damped.cholesky().map(|c| c.solve(&-slope));
            let step = step.filter(|s| s.iter().all(|x| x.abs() <= LONGEST_STEP));
            if let Some(step) = step {
                let moved = primitive.moved(&step);
                let moved_cost = cost_of(&moved, samples);
                if moved_cost < cost {
                    settled = cost - moved_cost < SETTLED_FALL * cost || step.amax() < SETTLED_STEP;
                    (primitive, cost) = (moved, moved_cost);
                    damping *= DAMPING_FALL;
                    break;
                }
                if step.amax() < SETTLED_STEP {
                    break;
                }
            }
            damping *= DAMPING_RISE;
        }
        if settled {
            break;
        }
    }
    Some(FitProgress { cost, primitive })
}

fn cost_of<const D: usize, P: Primitive<D>>(primitive: &P, samples: &[Sample]) -> f64 {
    let cost = |s: &Sample| {
        let (distance, normal) = primitive.distance_and_normal(&s.point);
        distance * distance + NORMAL_WEIGHT * NORMAL_WEIGHT * (normal - s.normal).norm_squared()
    };
    samples.iter().map(cost).sum()
}

/// `JᵀJ` and `Jᵀr` of the residuals `r` and their derivatives `J`.
fn normal_equations<const D: usize, P: Primitive<D>>(
    primitive: &P,
    samples: &[Sample],
) -> (SMatrix<f64, D, D>, SVector<f64, D>) {
    let mut hessian = SMatrix::<f64, D, D>::zeros();
    let mut slope = SVector::<f64, D>::zeros();
    let across = primitive.axis().across();
    for sample in samples {
        let here = primitive.linearize(&across, &sample.point);
        let mut rows = [
            here.distance_slopes,
            SVector::zeros(),
            SVector::zeros(),
            SVector::zeros(),
        ];
        for (k, turn) in here.normal_slopes.iter().enumerate() {
            for axis in 0..3 {
                rows[axis + 1][k] = NORMAL_WEIGHT * turn[axis];
            }
        }
        let turned = NORMAL_WEIGHT * (here.normal - sample.normal);
        let residuals = [here.distance, turned.x, turned.y, turned.z];
        for (row, residual) in rows.iter().zip(residuals) {
            hessian.syger(1.0, row, row, 1.0);
            slope.axpy(residual, row, 1.0);
        }
    }
    hessian.fill_upper_triangle_with_lower_triangle();
    (hessian, slope)
}
