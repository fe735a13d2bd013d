//! The method `nurbs`: spline curves across the hole, and a spline surface through them.
//!
//! In each section plane, a natural cubic spline passes through samples of the known surface on both sides of the hole.
//! Across the sections, every second curve is replaced by a cubic interpolation of its neighbors, as a spline surface
//! would have it. All other steps are those of [`sections`](super::sections).
//!
//! Source: A. Kumar, Y. Ito, T.-Y. Yu, D. H. Ross, A. M. Shih, "A novel hole patching algorithm for discrete
//! geometry using non-uniform rational B-spline", International Journal for Numerical Methods in Engineering 87(13),
//! 2011, as W.-C. Xie and X.-F. Zou describe it (Computer-Aided Design 45, 2013, section 2). Splines: C. de Boor, "A
//! practical guide to splines", Springer, 1978. `docs/methods/nurbs.md` says how open points of the description are
//! decided.
//!
//! Cost: `O(1)` for each predicted point. Not guaranteed: a common tangent plane at the rim. On a strongly curved
//! surface the spline is too flat.

pub(crate) mod options;

use super::sections::{BasePoint, Outside, Predicted, Prepared, patch_along};
use super::spec::{HoleReach, MethodSpec, STAIRCASE};
use super::task::Task;
use crate::error::Result;
use crate::math::Vec3;
use crate::patch::PatchSurface;

/// The method.
pub(super) const NURBS: MethodSpec = MethodSpec {
    name: "nurbs",
    reach: |_| HoleReach::rings(RING_COUNT),
    falls_back_to: STAIRCASE,
    make,
    ..MethodSpec::USUAL
};

/// Rings of known triangles that are read. The default of three layers outward passes them.
const RING_COUNT: u32 = 5;

/// Weights of four equidistant curves in the cubic through them, half way between the second and the third.
const ACROSS: [f64; 4] = [-1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0];

/// # Errors
/// Those of [`patch_along`].
fn make(task: &Task<'_>) -> Result<PatchSurface> {
    let options = &task.options.methods.nurbs;
    let outside = Outside::new(task.hole, task.job)?;
    let surface = |base: &[BasePoint], sections: &[Prepared]| -> Result<Predicted> {
        let mut curves = Vec::with_capacity(sections.len());
        for section in sections {
            task.job.ask()?;
            let ends = [&base[section.pair.first], &base[section.pair.second]];
            let [near, far] =
                ends.map(|end| outside.walk(end, section, section.step(), options.layers));
            let second = section.origin + section.x * section.length;
            let inner = near.len();
            let mut known: Vec<Vec3> = near.iter().rev().map(|k| k.point).collect();
            known.extend([section.origin, second]);
            known.extend(far.iter().map(|k| k.point));
            curves.push(SplineCurve::through(&known, inner));
        }
        Ok(sections
            .iter()
            .enumerate()
            .map(|(r, section)| {
                (1..=section.count)
                    .map(|k| across(&curves, r, k as f64 / (section.count + 1) as f64))
                    .collect()
            })
            .collect())
    };
    patch_along(task, task.options.methods.sections(), &surface)
}

/// The point at the share `share` of section `r` on the spline surface. Curves of even number stay; those of odd number
/// are interpolated from the four nearest even ones, if there are that many.
fn across(curves: &[SplineCurve], r: usize, share: f64) -> Vec3 {
    let is_between = r % 2 == 1 && r >= 3 && r + 3 < curves.len();
    if !is_between {
        return curves[r].at(share);
    }
    ACROSS
        .iter()
        .zip([r - 3, r - 1, r + 1, r + 3])
        .map(|(weight, r)| curves[r].at(share) * *weight)
        .sum()
}

/// The span of a natural cubic spline that crosses the hole. The spline is parametrized by chord lengths.
struct SplineCurve {
    ends: [Vec3; 2],
    /// Second derivatives at the ends.
    bends: [Vec3; 2],
    /// Length of the span in the parameter.
    length: f64,
}

impl SplineCurve {
    /// The span between the points `inner` and `inner + 1` of the spline through all points.
    fn through(points: &[Vec3], inner: usize) -> Self {
        let steps: Vec<f64> = points.windows(2).map(|w| (w[1] - w[0]).norm()).collect();
        let bends = second_derivatives(points, &steps);
        Self {
            ends: [points[inner], points[inner + 1]],
            bends: [bends[inner], bends[inner + 1]],
            length: steps[inner],
        }
    }

    fn at(&self, share: f64) -> Vec3 {
        let (a, b) = (1.0 - share, share);
        let bend = self.bends[0] * (a * a * a - a) + self.bends[1] * (b * b * b - b);
        self.ends[0] * a + self.ends[1] * b + bend * (self.length * self.length / 6.0)
    }
}

/// Second derivatives of the natural cubic spline at its knots: the solution of a tridiagonal system.
fn second_derivatives(points: &[Vec3], steps: &[f64]) -> Vec<Vec3> {
    let n = points.len();
    let mut bends = vec![Vec3::zeros(); n];
    let mut upper = vec![0.0; n];
    for i in 1..n - 1 {
        let (before, after) = (steps[i - 1], steps[i]);
        let slope = |k: usize| (points[k + 1] - points[k]) / steps[k];
        let right = (slope(i) - slope(i - 1)) * 6.0;
        let pivot = 2.0 * (before + after) - before * upper[i - 1];
        upper[i] = after / pivot;
        bends[i] = (right - bends[i - 1] * before) / pivot;
    }
    for i in (1..n - 1).rev() {
        let next = bends[i + 1];
        bends[i] -= next * upper[i];
    }
    bends
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_span_meets_its_ends_and_a_line_stays_straight() {
        let points: Vec<Vec3> = [0.0, 1.0, 2.5, 7.0, 8.0, 9.0]
            .iter()
            .map(|&x| Vec3::new(x, 2.0 * x, 1.0))
            .collect();
        let curve = SplineCurve::through(&points, 2);
        assert!((curve.at(0.0) - points[2]).norm() < 1e-12);
        assert!((curve.at(1.0) - points[3]).norm() < 1e-12);
        let expected = points[2].lerp(&points[3], 0.3);
        assert!((curve.at(0.3) - expected).norm() < 1e-12);
    }

    #[test]
    fn the_spline_is_smooth_at_its_knots() {
        let points: Vec<Vec3> = (0..7)
            .map(|k| {
                let x = f64::from(k) * 0.7;
                Vec3::new(x, x.sin(), 0.2 * x * x)
            })
            .collect();
        let h = 1e-5;
        for i in 1..5 {
            let (before, after) = (
                SplineCurve::through(&points, i - 1),
                SplineCurve::through(&points, i),
            );
            let knot = points[i];
            let left = (knot - before.at(1.0 - h / before.length)) / h;
            let right = (after.at(h / after.length) - knot) / h;
            assert!((left - right).norm() < 1e-4, "{left} {right}");
            assert_eq!(before.bends[1], after.bends[0]);
        }
    }

    #[test]
    fn curves_of_a_cubic_surface_are_continued_exactly_across() {
        let curve = |r: usize| {
            let y = r as f64;
            let at = |x: f64| Vec3::new(x, y, 0.1 * y * y * y - y * x);
            SplineCurve::through(&[at(0.0), at(1.0)], 0)
        };
        let curves: Vec<SplineCurve> = (0..9).map(curve).collect();
        for r in 0..9 {
            let y = r as f64;
            let expected = Vec3::new(0.4, y, 0.1 * y * y * y - 0.4 * y);
            assert!((across(&curves, r, 0.4) - expected).norm() < 1e-9);
        }
    }
}
