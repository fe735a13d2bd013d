//! Finds the curve in which two implicit surfaces meet, and the point in which three meet, by Newton's method.
//!
//! Two surfaces give two equations for a point in space; the shortest of all Newton steps is taken. A curve is traced
//! from its start in steps along `∇f × ∇g`. If its direction at the start is not known, the straight line between its
//! ends is projected onto both surfaces instead. The points are then spaced evenly. The ends are given and do not move.
//! They may lie off the surfaces; their offsets are interpolated linearly along the curve.
//!
//! Not guaranteed: that the curve found is the only one, or the shortest.

use crate::math::{Vec3, unit};
use crate::methods::auto::surface::Implicit;
use nalgebra::Matrix3;

/// Upper bound on the Newton steps for a point. Five are enough from a few edge lengths away.
const STEPS: usize = 30;

/// A step shorter than this ends the iteration. Unit: the longest step allowed.
const SETTLED: f64 = 1e-11;

/// A point counts as found if its last step is shorter than this. Unit: the longest step allowed.
const FOUND: f64 = 1e-6;

/// Lower bound on the sine of the angle between two surfaces. Below it, their intersection is ill-conditioned.
const SMALLEST_SINE: f64 = 0.05;

/// Lower bound on the volume that the unit normals of three surfaces span, for the same reason.
const SMALLEST_VOLUME: f64 = 0.02;

/// Upper bound on the length of a curve, divided by the distance of its ends. A longer one is on a wrong branch. Half a
/// circle has 1.57.
const LONGEST_DETOUR: f64 = 3.0;

/// Rounds of spacing the points of a curve evenly and projecting them.
const DIVISIONS: usize = 4;

/// The point near `start` where three surfaces meet. No Newton step is longer than `limit`. `None` when the steps do
/// not converge or the point is ill-conditioned.
pub(crate) fn corner(surfaces: [&dyn Implicit; 3], start: Vec3, limit: f64) -> Option<Vec3> {
    let mut p = start;
    let mut length = f64::INFINITY;
    for _ in 0..STEPS {
        let [(f, df), (g, dg), (h, dh)] = surfaces.map(|s| s.value_and_gradient(&p));
        let rows = Matrix3::from_columns(&[df, dg, dh]).transpose();
        let lengths = df.norm() * dg.norm() * dh.norm();
        let is_determined = rows.determinant().abs() > SMALLEST_VOLUME * lengths;
        let step = rows.try_inverse().filter(|_| is_determined)? * Vec3::new(f, g, h);
        length = step.norm();
        p -= step * (limit / length.max(limit));
        if length < SETTLED * limit {
            break;
        }
    }
    (length < FOUND * limit && p.iter().all(|x| x.is_finite())).then_some(p)
}

/// The point near `start` where two surfaces meet.
fn common_point(surfaces: [&dyn Implicit; 2], start: Vec3, limit: f64) -> Option<Vec3> {
    let mut p = start;
    let mut length = f64::INFINITY;
    for _ in 0..STEPS {
        let [(f, df), (g, dg)] = surfaces.map(|s| s.value_and_gradient(&p));
        let (a, b, c) = (df.norm_squared(), df.dot(&dg), dg.norm_squared());
        let determinant = a * c - b * b;
        let smallest = SMALLEST_SINE * SMALLEST_SINE * a * c;
        // NaN comes from values that are not finite.
        if determinant.is_nan() || determinant <= smallest {
            return None;
        }
        let step = df * ((c * f - b * g) / determinant) + dg * ((a * g - b * f) / determinant);
        length = step.norm();
        p -= step * (limit / length.max(limit));
        if length < SETTLED * limit {
            break;
        }
    }
    (length < FOUND * limit && p.iter().all(|x| x.is_finite())).then_some(p)
}

/// The curve in which two surfaces meet, from one given end to the other.
pub(crate) struct IntersectionCurve<'a> {
    pub(crate) surfaces: [&'a dyn Implicit; 2],
    pub(crate) ends: [Vec3; 2],
    /// The direction of the curve at its first end, if known.
    pub(crate) departure: Option<Vec3>,
    /// Length of its segments.
    pub(crate) step: f64,
}

impl IntersectionCurve<'_> {
    /// The points between the ends, evenly spaced; an empty list for a curve shorter than one and a half segments.
    /// `None` when no curve from one end to the other is found.
    pub(crate) fn points(&self) -> Option<Vec<Vec3>> {
        let traced = self.departure.and_then(|direction| self.trace(direction));
        let mut line = traced.unwrap_or_else(|| self.ends.to_vec());
        for _ in 0..DIVISIONS {
            let total = length(&line);
            let longest = LONGEST_DETOUR * (self.ends[1] - self.ends[0]).norm();
            if total.is_nan() || total > longest {
                return None;
            }
            let count = (total / self.step).round().max(1.0) as usize;
            line = divide(&line, count);
            self.settle(&mut line)?;
        }
        self.meet_ends(&mut line)?;
        line.pop();
        line.remove(0);
        Some(line)
    }

    /// Follows the curve from the first end until the second is less than a step away.
    fn trace(&self, departure: Vec3) -> Option<Vec<Vec3>> {
        let [start, target] = self.ends;
        let most = LONGEST_DETOUR * (target - start).norm() / self.step;
        let mut line = vec![start];
        let (mut p, mut direction) = (start, departure);
        for _ in 0..most.ceil() as usize {
            let [df, dg] = self.surfaces.map(|s| unit(s.value_and_gradient(&p).1));
            let tangent = df.cross(&dg);
            if tangent.norm() < SMALLEST_SINE {
                return None;
            }
            direction = unit(tangent) * tangent.dot(&direction).signum();
            let rest = (target - p).norm();
            if rest <= self.step {
                line.push(target);
                return Some(line);
            }
            p = common_point(self.surfaces, p + self.step * direction, self.step)?;
            line.push(p);
        }
        None
    }

    /// Moves the points between the ends onto both surfaces.
    fn settle(&self, line: &mut [Vec3]) -> Option<()> {
        let limit = (self.ends[1] - self.ends[0]).norm();
        let last = line.len() - 1;
        for p in &mut line[1..last] {
            *p = common_point(self.surfaces, *p, limit)?;
        }
        Some(())
    }

    /// Adds the offsets of the ends from the surfaces to the points, interpolated along the curve.
    fn meet_ends(&self, line: &mut [Vec3]) -> Option<()> {
        let limit = (self.ends[1] - self.ends[0]).norm();
        let mut offsets = [Vec3::zeros(); 2];
        for (offset, end) in offsets.iter_mut().zip(&self.ends) {
            *offset = end - common_point(self.surfaces, *end, limit)?;
        }
        let last = line.len() - 1;
        for (k, p) in line.iter_mut().enumerate().take(last).skip(1) {
            let t = k as f64 / last as f64;
            *p += (1.0 - t) * offsets[0] + t * offsets[1];
        }
        Some(())
    }
}

fn length(line: &[Vec3]) -> f64 {
    line.windows(2).map(|p| (p[1] - p[0]).norm()).sum()
}

/// Points that divide the line into `count` parts of equal length, with its ends.
fn divide(line: &[Vec3], count: usize) -> Vec<Vec3> {
    let part = length(line) / count as f64;
    let mut points = vec![line[0]];
    let (mut segment, mut before) = (0, 0.0);
    for k in 1..count {
        let at = k as f64 * part;
        while segment + 2 < line.len() && before + (line[segment + 1] - line[segment]).norm() < at {
            before += (line[segment + 1] - line[segment]).norm();
            segment += 1;
        }
        let step = line[segment + 1] - line[segment];
        let share = (at - before) / step.norm().max(f64::MIN_POSITIVE);
        points.push(line[segment] + share.clamp(0.0, 1.0) * step);
    }
    points.push(line[line.len() - 1]);
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `n·x = d`.
    struct Plane(Vec3, f64);
    impl Implicit for Plane {
        fn value_and_gradient(&self, p: &Vec3) -> (f64, Vec3) {
            (self.0.dot(p) - self.1, self.0)
        }
    }

    /// A sphere round the origin.
    struct Sphere(f64);
    impl Implicit for Sphere {
        fn value_and_gradient(&self, p: &Vec3) -> (f64, Vec3) {
            (
                (p.norm_squared() - self.0 * self.0) / (2.0 * self.0),
                p / self.0,
            )
        }
    }

    fn on_circle(angle: f64) -> Vec3 {
        Vec3::new(2.0 * angle.cos(), 2.0 * angle.sin(), 0.0)
    }

    #[test]
    fn three_planes_meet_in_their_corner_and_parallel_ones_nowhere() {
        let [x, y, z] = [Vec3::x(), Vec3::y(), Vec3::z()].map(|n| Plane(n, 1.0));
        let start = Vec3::new(3.0, -2.0, 5.0);
        let found = corner([&x, &y, &z], start, 1.0).unwrap();
        assert!((found - Vec3::repeat(1.0)).norm() < 1e-12);
        assert!(corner([&x, &y, &Plane(Vec3::x(), 2.0)], start, 1.0).is_none());
        assert!(corner([&x, &y, &Sphere(0.5)], start, 1.0).is_none());
    }

    #[test]
    fn arcs_of_any_length_are_followed_and_evenly_divided() {
        let (plane, sphere) = (Plane(Vec3::z(), 0.0), Sphere(2.0));
        for angle in [0.5, 2.0, 3.0, 4.2] {
            let curve = IntersectionCurve {
                surfaces: [&plane, &sphere],
                ends: [on_circle(0.0), on_circle(angle)],
                departure: Some(Vec3::y()),
                step: 0.2,
            };
            let points = curve.points().unwrap();
            let count = (2.0 * angle / 0.2).round() as usize;
            assert!(points.len().abs_diff(count - 1) <= 1, "{}", points.len());
            for (k, p) in (1..).zip(&points) {
                let part = angle * f64::from(k) / (points.len() + 1) as f64;
                assert!((p - on_circle(part)).norm() < 0.02, "{angle} {k}");
                assert!((p.norm() - 2.0).abs() < 1e-9 && p.z.abs() < 1e-9);
            }
        }
    }

    #[test]
    fn ends_beside_the_surfaces_are_met() {
        let planes = [Plane(Vec3::z(), 0.0), Plane(Vec3::y(), 0.0)];
        let curve = IntersectionCurve {
            surfaces: [&planes[0], &planes[1]],
            ends: [Vec3::new(0.0, 0.1, 0.0), Vec3::new(4.0, 0.0, -0.2)],
            departure: None,
            step: 1.0,
        };
        let points = curve.points().unwrap();
        assert_eq!(points.len(), 3);
        assert!((points[1] - Vec3::new(2.0, 0.05, -0.1)).norm() < 0.01);
    }

    #[test]
    fn surfaces_that_do_not_meet_have_no_curve() {
        let planes = [Plane(Vec3::z(), 0.0), Plane(Vec3::z(), 1.0)];
        let curve = IntersectionCurve {
            surfaces: [&planes[0], &planes[1]],
            ends: [Vec3::zeros(), 5.0 * Vec3::x()],
            departure: Some(Vec3::x()),
            step: 1.0,
        };
        assert!(curve.points().is_none());
    }
}
