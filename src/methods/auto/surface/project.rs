//! Moves points onto an implicit surface.
//!
//! Newton steps along the gradient, `p - f ∇f / |∇f|²`. Their length is limited: a patch that starts far from the
//! surface shall reach the sheet that its rim lies on, not the next best.

use super::Implicit;
use crate::math::Vec3;

/// A step shorter than this share of the limit ends the projection: Newton's method squares what remains.
const CONVERGED_SHARE: f64 = 1e-5;
/// Gradients of the functions are about one at the surface; below this they have no direction.
const SMALLEST_GRADIENT: f64 = 1e-6;

/// Places that are looked at for the way out of a surface: over six diameters of a rim, one in 0.03 diameters. Thinner
/// layers are missed.
const WAY_STEPS: u32 = 200;
/// Halvings of the way between two of them, to a millionth of it.
const BISECTIONS: usize = 20;

/// The point after at most `steps` Newton steps of at most the length `limit`.
pub(crate) fn project(surface: &dyn Implicit, point: &Vec3, steps: usize, limit: f64) -> Vec3 {
    let mut p = *point;
    for _ in 0..steps {
        let (value, gradient) = surface.value_and_gradient(&p);
        let squared = gradient.norm_squared();
        if squared < SMALLEST_GRADIENT * SMALLEST_GRADIENT {
            break;
        }
        let step = value / squared * gradient;
        let length = step.norm();
        p -= step * (limit / length.max(limit));
        if length < CONVERGED_SHARE * limit {
            break;
        }
    }
    p
}

/// The distance of a point to the surface, to first order.
pub(crate) fn distance(surface: &dyn Implicit, point: &Vec3) -> f64 {
    let (value, gradient) = surface.value_and_gradient(point);
    value.abs() / gradient.norm().max(SMALLEST_GRADIENT)
}

/// How far from `origin`, along the unit vector `direction`, the surface is left first, at most `farthest`; `None`
/// where it is not, and where the origin is not behind it.
pub(crate) fn way_out(
    surface: &dyn Implicit,
    origin: &Vec3,
    direction: &Vec3,
    farthest: f64,
) -> Option<f64> {
    let value = |t: f64| surface.value_and_gradient(&(origin + t * direction)).0;
    let steps = (0..=WAY_STEPS).map(|i| f64::from(i) / f64::from(WAY_STEPS) * farthest);
    let (mut inside, mut outside) = (None, None);
    for t in steps {
        if value(t) < 0.0 {
            inside = Some(t);
        } else {
            outside = Some(t);
            break;
        }
    }
    let (mut inside, mut outside) = (inside?, outside?);
    for _ in 0..BISECTIONS {
        let middle = (inside + outside) / 2.0;
        if value(middle) < 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    Some(inside)
}
