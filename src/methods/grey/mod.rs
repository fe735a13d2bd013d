//! The method `grey`: continues the known surface across the hole by grey prediction of angles.
//!
//! The angles by which the known surface turns from sample to sample along a section plane are a series. A grey model
//! is fitted to it and predicts the next angles. The section is continued in this way from both ends; the gap between
//! the two halves is distributed over the section. All other steps are those of [`sections`](super::sections).
//!
//! Source: L.-C. Wang, Y.-C. Hung, "Hole filling of triangular mesh segments using systematic grey prediction",
//! Computer-Aided Design 44(12), 2012, as W.-C. Xie and X.-F. Zou describe it (Computer-Aided Design 45, 2013,
//! sections 2 and 5.2.3). The model is GM(1,1) of J.-L. Deng, "Control problems of grey systems", Systems & Control
//! Letters 1(5), 1982. `docs/methods/grey.md` says how open points of these descriptions are decided.
//!
//! Cost: `O(1)` for each predicted point. Not guaranteed: that the two halves of a section nearly meet.

pub(crate) mod options;

use super::sections::{BasePoint, Known, Outside, Predicted, Prepared, patch_along};
use super::spec::{HoleReach, MethodSpec, STAIRCASE};
use super::task::Task;
use crate::error::Result;
use crate::math::Vec3;
use crate::patch::PatchSurface;
use std::f64::consts::PI;

/// The method.
pub(super) const GREY: MethodSpec = MethodSpec {
    name: "grey",
    reach: |_| HoleReach::rings(RING_COUNT),
    falls_back_to: STAIRCASE,
    make,
    ..MethodSpec::USUAL
};

/// Rings of known triangles that are read. Six steps outward pass them.
const RING_COUNT: u32 = 7;

/// Lower bound on the known angles of a series. Fewer do not determine the two coefficients of the model.
const SHORTEST_SERIES: usize = 4;

/// Upper bound on a predicted angle, divided by the largest known angle. The model is exponential and could grow
/// without bound.
const MOST_GROWTH: f64 = 2.0;

/// # Errors
/// Those of [`patch_along`].
fn make(task: &Task<'_>) -> Result<PatchSurface> {
    let options = &task.options.methods.grey;
    let outside = Outside::new(task.hole, task.job)?;
    let curves = |base: &[BasePoint], sections: &[Prepared]| -> Result<Predicted> {
        let mut all = Vec::with_capacity(sections.len());
        for section in sections {
            task.job.ask()?;
            let ends = [&base[section.pair.first], &base[section.pair.second]];
            let step = section.step();
            let from = ends.map(|end| outside.walk(end, section, step, options.series));
            all.push(continued(section, &from));
        }
        Ok(all)
    };
    patch_along(task, task.options.methods.sections(), &curves)
}

/// The points of a section. The first half continues the known surface at the first end, the second half that at the
/// second end.
fn continued(section: &Prepared, known: &[Vec<Known>; 2]) -> Vec<Vec3> {
    let m = section.count;
    let [near, far] = [0, 1].map(|side| {
        let end = [section.length * f64::from(side as u8), 0.0];
        let angle = section.arcs[side].angle;
        let tangent = if side == 0 { angle } else { PI - angle };
        let turns = turns(section, end, tangent, &known[side]);
        continue_line(&GreyModel::fit(&turns), end, tangent, section.step(), m + 1)
    });
    // Both lines have m points and one more, which should be the other end. The gap is its distance from there.
    let miss = |line: &[[f64; 2]], end: [f64; 2]| {
        line.last()
            .map_or([0.0; 2], |p| [end[0] - p[0], end[1] - p[1]])
    };
    let gaps = [miss(&near, [section.length, 0.0]), miss(&far, [0.0, 0.0])];
    (1..=m)
        .map(|k| {
            let is_near = 2 * k <= m + 1;
            let (line, gap, since) = if is_near {
                (&near, gaps[0], k)
            } else {
                (&far, gaps[1], m + 1 - k)
            };
            let share = since as f64 / (m + 1) as f64;
            let p = line[since - 1];
            let (x, y) = (p[0] + gap[0] * share, p[1] + gap[1] * share);
            section.origin + section.x * x + section.y * y
        })
        .collect()
}

/// The angles by which the known surface turns from sample to sample in the section plane, in order toward the hole.
/// The last one leads to the rim at `end`, where the tangent has the direction `tangent`.
fn turns(section: &Prepared, end: [f64; 2], tangent: f64, known: &[Known]) -> Vec<f64> {
    let mut last = section.origin + section.x * end[0] + section.y * end[1];
    let mut directions = vec![tangent];
    for place in known {
        let along = place.normal.cross(&section.ahead);
        let inward = along.dot(&(last - place.point)).signum() * along;
        directions.push(inward.dot(&section.y).atan2(inward.dot(&section.x)));
        last = place.point;
    }
    directions
        .windows(2)
        .map(|w| wrapped(w[0] - w[1]))
        .rev()
        .collect()
}

/// `count` points that continue a line from `end`, each at the distance `step` from the one before. The tangent at
/// `end` has the direction `tangent`. From each point to the next it turns by the angle that `model` predicts.
fn continue_line(
    model: &GreyModel,
    end: [f64; 2],
    mut tangent: f64,
    step: f64,
    count: usize,
) -> Vec<[f64; 2]> {
    let mut at = end;
    (0..count)
        .map(|k| {
            let turn = model.predict(k);
            // The chord of an arc has the mean direction of its ends.
            let (sin, cos) = (tangent + turn / 2.0).sin_cos();
            tangent += turn;
            at = [at[0] + step * cos, at[1] + step * sin];
            at
        })
        .collect()
}

/// The angle, reduced to the range from -π to π.
fn wrapped(angle: f64) -> f64 {
    angle - (2.0 * PI) * (angle / (2.0 * PI)).round()
}

/// The grey model GM(1,1): the running sums `x` of a positive series satisfy `x' + a x = b`.
struct GreyModel {
    first: f64,
    a: f64,
    b: f64,
    /// Added to each value to make the series positive.
    shift: f64,
    known: usize,
    largest: f64,
}

impl GreyModel {
    /// Fits `a` and `b` by least squares to `x0(k) + a z(k) = b`, where `z(k)` is the mean of two consecutive sums. A
    /// series that is too short is continued by its mean.
    fn fit(series: &[f64]) -> Self {
        let largest = series.iter().fold(0.0, |l: f64, x| l.max(x.abs()));
        let mean = series.iter().sum::<f64>() / series.len().max(1) as f64;
        let constant = Self {
            first: 0.0,
            a: 0.0,
            b: mean,
            shift: 0.0,
            known: series.len(),
            largest,
        };
        if series.len() < SHORTEST_SERIES || largest == 0.0 {
            return constant;
        }
        // A shift of twice the largest value keeps the sums far from zero.
        let shift = 2.0 * largest;
        let positive: Vec<f64> = series.iter().map(|x| x + shift).collect();
        let mut sum = positive[0];
        let (mut n, mut sz, mut szz, mut sx, mut szx) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for x in &positive[1..] {
            let z = sum + x / 2.0;
            sum += x;
            n += 1.0;
            sz += z;
            szz += z * z;
            sx += x;
            szx += z * x;
        }
        let determinant = n * szz - sz * sz;
        if determinant <= 0.0 {
            return constant;
        }
        Self {
            first: positive[0],
            a: (sz * sx - n * szx) / determinant,
            b: (szz * sx - sz * szx) / determinant,
            shift,
            ..constant
        }
    }

    /// Predicts the value that comes `ahead` places after the first unknown one.
    fn predict(&self, ahead: usize) -> f64 {
        // For a smaller `a` the exponential is a line in double precision.
        let value = if self.a.abs() < 1e-9 {
            self.b
        } else {
            let k = (self.known + ahead) as f64;
            (self.first - self.b / self.a) * (1.0 - self.a.exp()) * (-self.a * k).exp()
        };
        let limit = MOST_GROWTH * self.largest;
        (value - self.shift).clamp(-limit, limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_continues_constants_and_slow_exponentials() {
        let constant = GreyModel::fit(&[0.3; 5]);
        assert!((constant.predict(0) - 0.3).abs() < 1e-9);
        assert!((constant.predict(7) - 0.3).abs() < 1e-9);
        let series: Vec<f64> = (0..6).map(|k| 0.2 * (0.05 * f64::from(k)).exp()).collect();
        let growing = GreyModel::fit(&series);
        for k in 0..3 {
            let expected = 0.2 * (0.05 * f64::from(6 + k)).exp();
            let found = growing.predict(k as usize);
            assert!(
                (found - expected).abs() < 0.02 * expected,
                "{found} {expected}"
            );
        }
    }

    #[test]
    fn a_short_or_wild_series_stays_bounded() {
        assert_eq!(GreyModel::fit(&[]).predict(3), 0.0);
        assert!((GreyModel::fit(&[0.1, 0.3]).predict(9) - 0.2).abs() < 1e-12);
        let wild = GreyModel::fit(&[0.0, 0.1, -0.2, 1.0, 3.0]);
        assert!((0..50).all(|k| wild.predict(k).abs() <= 6.0));
    }

    #[test]
    fn a_circle_is_continued_as_a_circle() {
        // The section ends at the top of a unit circle round the origin, and goes on to the right.
        let at = |k: i32| {
            let angle = 0.1 * f64::from(k);
            Vec3::new(angle.sin(), angle.cos(), 0.0)
        };
        let section = Prepared {
            origin: at(0),
            x: Vec3::x(),
            y: Vec3::y(),
            ahead: Vec3::z(),
            ..Prepared::default()
        };
        let known: Vec<Known> = (1..=5)
            .map(|k| Known {
                point: at(-k),
                normal: at(-k),
            })
            .collect();
        let turns = turns(&section, [0.0; 2], 0.0, &known);
        assert_eq!(turns.len(), 5);
        assert!(turns.iter().all(|t| (t + 0.1).abs() < 1e-12), "{turns:?}");
        let step = 2.0 * 0.05_f64.sin();
        let line = continue_line(&GreyModel::fit(&turns), [0.0; 2], 0.0, step, 20);
        for (k, p) in (1..).zip(&line) {
            let expected = at(k) - at(0);
            assert!((p[0] - expected.x).hypot(p[1] - expected.y) < 1e-9);
        }
    }
}
