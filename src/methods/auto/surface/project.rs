//! Moves points onto an implicit surface `f = 0`, and measures distances to it.
//!
//! A point moves in Newton steps along the gradient, `p - f ∇f / |∇f|²`. The length of a step is limited, so that a
//! patch that starts far from the surface reaches the sheet that its rim lies on, and not another one.
//!
//! Not guaranteed: convergence, and that the point reached is the nearest one of the surface.

use super::Implicit;
use crate::math::Vec3;

/// A step shorter than this share of the limit ends the projection. Newton's method squares the remaining error.
const CONVERGED_SHARE: f64 = 1e-5;
/// Lower bound on the length of a gradient that gives a direction. At the surface the length is about one.
const SMALLEST_GRADIENT: f64 = 1e-6;

/// Number of intervals that a ray is divided into to find where it leaves a surface. For the usual ray of six
/// diameters of a rim, one interval is 0.03 diameters long. Thinner layers can be missed.
const WAY_STEPS: u32 = 200;
/// Bisections of the interval in which the ray leaves the surface. They reduce it to a millionth of its length.
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

/// The distance from `origin`, along the unit vector `direction`, to the first point where the function becomes
/// positive. `None` when there is none within `farthest`, or when the function is not negative at `origin`.
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
