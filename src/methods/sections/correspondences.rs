//! Step 3: pairs the base points that face each other across the hole.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, section 4.3, equations 9 and 10. `O(n²)`.

use super::base_points::{BasePoint, rim_direction};
use crate::error::Result;
use crate::job::Job;
use crate::math::{Vec3, unit};

/// A pair of base points that face each other, as indices in the rotated sequence: `first < second`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Correspondence {
    pub(crate) first: usize,
    pub(crate) second: usize,
}

/// The rotation of the sequence for which the sum of the distances between the points `i` and `n - 1 - i` is smallest,
/// equation 10. The result is the index of the first point.
///
/// # Errors
/// `Cancelled` when the job is cancelled.
pub(super) fn best_start(base: &[BasePoint], job: &Job<'_>) -> Result<usize> {
    let n = base.len();
    let sum = |start: usize| -> f64 {
        (0..n / 2)
            .map(|i| {
                let a = base[(start + i) % n].position;
                let b = base[(start + n - 1 - i) % n].position;
                (a - b).norm()
            })
            .sum()
    };
    let mut best = (0, f64::INFINITY);
    for start in 0..n / 2 {
        job.tick(n / 16)?;
        let distance = sum(start);
        if distance < best.1 {
            best = (start, distance);
        }
    }
    Ok(best.0)
}

/// The rotation of the sequence in which the base points `i` and `j` are partners, equation 9. If `i + j` is even,
/// there is none; then `i` and `j + 1` become partners.
pub(super) fn start_of_cut(n: usize, i: usize, j: usize) -> usize {
    // The points at `start + k` and `start - 1 - k` are partners: their sum is 2 start - 1.
    let sum = i + j;
    (sum + 1 + (1 - sum % 2)) / 2 % n
}

/// The pairs of partners, from the ends of the sequence inward. A point is skipped, on its side only, if the sine of
/// the angle between the rim and the line to its partner is below `smallest_sine`.
pub(super) fn pairs(base: &[BasePoint], smallest_sine: f64) -> Vec<Correspondence> {
    let n = base.len();
    let mut pairs = Vec::new();
    let (mut first, mut second) = (0, n.saturating_sub(1));
    while first + 2 < second {
        let line = unit(base[second].position - base[first].position);
        let is_flat = |k: usize| {
            line == Vec3::zeros() || line.cross(&rim_direction(base, k)).norm() < smallest_sine
        };
        let (skip_first, skip_second) = (is_flat(first), is_flat(second));
        if !skip_first && !skip_second {
            pairs.push(Correspondence { first, second });
        }
        let step_both = skip_first == skip_second;
        first += usize::from(step_both || skip_first);
        second -= usize::from(step_both || skip_second);
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ellipse(n: usize, a: f64, b: f64, turn: usize) -> Vec<BasePoint> {
        (0..n)
            .map(|k| {
                let angle = std::f64::consts::TAU * ((k + turn) as f64 + 0.5) / n as f64;
                BasePoint {
                    position: Vec3::new(a * angle.cos(), b * angle.sin(), 0.0),
                    normal: Vec3::z(),
                    arc: k as f64,
                    edge: k,
                }
            })
            .collect()
    }

    #[test]
    fn sections_cross_an_ellipse_the_short_way() {
        for turn in 0..12 {
            let base = ellipse(24, 3.0, 1.0, turn);
            let start = best_start(&base, &Job::unlimited()).unwrap();
            let n = base.len();
            for i in 0..n / 2 {
                let a = base[(start + i) % n].position;
                let b = base[(start + n - 1 - i) % n].position;
                assert!((a.x - b.x).abs() < 1e-9, "{turn}: {a} {b}");
            }
        }
    }

    #[test]
    fn the_ends_of_a_cut_are_partners() {
        for (i, j) in [(0, 5), (3, 10), (7, 19), (2, 4), (0, 18)] {
            let n = 20;
            let start = start_of_cut(n, i, j);
            let partner = (2 * start + n - 1 - i) % n;
            assert_eq!(partner, if (i + j) % 2 == 1 { j } else { (j + 1) % n });
        }
    }

    #[test]
    fn pairs_along_the_rim_are_passed_over() {
        let base = ellipse(40, 1.0, 1.0, 0);
        let sine = 12_f64.to_radians().sin();
        let pairs = pairs(&base, sine);
        // The chord between two points of a circle meets it at half the angle between them.
        let angle = |p: &Correspondence| std::f64::consts::PI * (p.second - p.first) as f64 / 40.0;
        assert!(pairs.iter().all(|p| p.first + p.second == 39));
        assert!(pairs.iter().all(|p| angle(p).sin() >= sine));
        assert_eq!(pairs.len(), 18);
    }
}
