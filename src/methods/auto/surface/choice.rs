//! Which surface continues the known one best: each candidate predicts rings that it has not seen.
//!
//! For `r` = 1, 2, 3 a candidate is fitted to the rings `r` to `r + 3` and compared with the vertices of the rings
//! below `r`, as if the hole began `r` rings further out. The score is the geometric mean of the three root mean
//! square distances in units of the rim's edge length: the mean of several keeps noise, which misleads each single
//! one, from choosing. Candidates that follow every detail pay a factor; among those that are as good as exact the
//! simplest wins.
//!
//! Leave-one-out choice of models goes back to M. Stone, "Cross-validatory choice and assessment of statistical
//! predictions", Journal of the Royal Statistical Society B 36(2), 1974; leaving out bands towards the hole measures
//! extrapolation, which is what a hole asks for.
//!
//! Not guaranteed: that what predicts three rings well predicts the middle of a hole that is much wider.

use super::candidates::Candidate;
use super::samples::SampledBand;
use super::{Implicit, project};
use crate::error::Result;

/// Widest band that is left out, in rings, and that which is fitted.
const MOST_LEFT_OUT: u32 = 3;
pub(crate) const FITTED_RINGS: u32 = 3;
/// Rings of the surroundings that the choice reads.
pub(crate) const RINGS: u32 = 9;
/// Fewer samples than this are not fitted.
const FEWEST_SAMPLES: usize = 20;
/// Vertices that a prediction is compared with, at most.
const MOST_TESTS: usize = 150;
/// A point further off than this, in edge lengths, counts as being so far off: runaways shall not dominate means.
const FARTHEST: f64 = 10.0;
/// Added to each distance before the logarithm: below it, in edge lengths, files in single precision have no truth.
const EXACT: f64 = 1e-5;
/// A score below this, in edge lengths, is the error of the triangulation, not of the candidate.
const AS_GOOD_AS_EXACT: f64 = 2e-3;
/// Scores of interpolating functions are multiplied by this: they have more freedom than data.
const INTERPOLATION_FACTOR: f64 = 1.25;
/// On noisy surroundings the simplest candidate within this factor of the best is taken.
const NOISY_TOLERANCE: f64 = 1.12;
/// The quintic kernel must beat the cubic one by this factor: it overshoots where the surface has detail. Of factors from
/// 0.4 to 0.95, 0.5 and 0.6 serve best on 348 holes cut out of 14 models: patches are 13 % better than with 0.95, and 1 %
/// better than without the quintic kernel, which wins by far more where there is no detail.
const QUINTIC_FACTOR: f64 = 0.6;
/// On rims with more edges than this it must beat it by more, in proportion: functions that grow faster are trusted
/// less far. The middle of such a hole is eight times as many rings away as the widest band that is left out.
const WIDE_RIM: f64 = 150.0;
/// A candidate whose mean over the first bands is more than this factor times the best mean over the same bands is not
/// compared with the rest. Of 2,226 holes in 59 models none would have chosen another candidate for that; with 2 one,
/// with 1.5 nine.
const OUT_OF_REACH: f64 = 3.0;
/// A costly candidate is fitted only when the one that contains or approximates it scores within this factor of the
/// best so far, or of what is as good as exact.
const GATE_FACTOR: f64 = 2.0;

/// A candidate with its score in rim edge lengths; smaller is better.
pub(crate) type Score = (Candidate, f64);

/// Rim edges per ring of a hole: a rim of six edges round each vertex is one ring away from its middle, one of twelve
/// two.
const EDGES_PER_RING: usize = 6;

/// Scores of the candidates that were fitted, in the order of fitting. Left out are bands up to the width of the
/// hole, at most three rings.
///
/// Once a candidate is as good as exact, those with more freedom are not tried any more. One that is far behind after
/// some of the bands is not tried on the others; its score is then as far behind the best one as it was there.
///
/// # Errors
/// `Cancelled` when the job of the samples is stopped.
pub(crate) fn scores(samples: &mut SampledBand, candidates: &[Candidate]) -> Result<Vec<Score>> {
    let rim_edges = samples.rim_edges;
    let widest = (rim_edges.div_ceil(EDGES_PER_RING) as u32).clamp(1, MOST_LEFT_OUT);
    let mut scores: Vec<Score> = Vec::new();
    let mut race = Race::default();
    for &candidate in candidates {
        let best = scores.iter().map(|s| s.1).fold(f64::INFINITY, f64::min);
        let is_settled = scores
            .iter()
            .any(|s| is_as_good_as_exact(s.1) && s.0.freedom() < candidate.freedom());
        if is_settled {
            continue;
        }
        let gate = candidate.gate().and_then(|gate| score_of(&scores, gate));
        if gate.is_some_and(|score| score > GATE_FACTOR * best.max(AS_GOOD_AS_EXACT)) {
            continue;
        }
        let mut score = race.run(samples, candidate, widest)?;
        if candidate == Candidate::Quintic
            && let Some(cubic) = cubic_score(&scores)
        {
            score = of_quintic(score, cubic, rim_edges);
        }
        if score.is_finite() {
            scores.push((candidate, score));
        }
    }
    Ok(scores)
}

/// The score of the cubic kernel through the points that it suits best, as they are or smoothed.
fn cubic_score(scores: &[Score]) -> Option<f64> {
    let is_cubic = |s: &&Score| matches!(s.0, Candidate::Cubic | Candidate::CubicSmoothed);
    scores.iter().find(is_cubic).map(|s| s.1)
}

/// The score of the quintic kernel, made worse than that of the cubic one unless it beats it clearly.
fn of_quintic(score: f64, cubic: f64, rim_edges: usize) -> f64 {
    let factor = QUINTIC_FACTOR * (WIDE_RIM / rim_edges as f64).min(1.0);
    if score > factor * cubic {
        score.max(1.01 * cubic)
    } else {
        score
    }
}

/// The score of a candidate, if it has one.
pub(crate) fn score_of(scores: &[Score], candidate: Candidate) -> Option<f64> {
    scores.iter().find(|s| s.0 == candidate).map(|s| s.1)
}

/// The candidate to use: the simplest of those that are as good as exact, else the best.
pub(crate) fn choose(scores: &[Score], is_noisy: bool) -> Option<Candidate> {
    let best = scores.iter().map(|s| s.1).min_by(f64::total_cmp)?;
    let limit = if is_as_good_as_exact(best) {
        AS_GOOD_AS_EXACT
    } else if is_noisy {
        NOISY_TOLERANCE * best
    } else {
        best
    };
    scores
        .iter()
        .filter(|s| s.1 <= limit)
        .min_by_key(|s| s.0.freedom())
        .map(|s| s.0)
}

/// Whether some candidate is as good as exact.
pub(crate) fn is_exact(scores: &[Score]) -> bool {
    scores.iter().any(|s| is_as_good_as_exact(s.1))
}

/// Whether a score says that nothing is left to improve.
pub(crate) fn is_as_good_as_exact(score: f64) -> bool {
    score < AS_GOOD_AS_EXACT
}

/// The best scores so far, after each of the bands that are left out.
#[derive(Default)]
struct Race {
    best: Vec<f64>,
}

impl Race {
    /// The geometric mean over the left out bands of the distances to the surface, times the factor of interpolating
    /// functions; for a candidate that falls too far behind, the best one's times the factor by which it is behind.
    /// Infinite when nothing could be fitted.
    fn run(&mut self, samples: &mut SampledBand, candidate: Candidate, widest: u32) -> Result<f64> {
        let factor = if candidate.interpolates() {
            INTERPOLATION_FACTOR
        } else {
            1.0
        };
        let mut logarithms = 0.0;
        let mut means = Vec::new();
        for r in 1..=widest {
            samples.job.ask()?;
            let vertices = samples.spread(r..r + FITTED_RINGS + 1, candidate.most_scored())?;
            if vertices.len() < FEWEST_SAMPLES {
                continue;
            }
            let Some(surface) = candidate.fit(samples, &vertices)? else {
                return Ok(f64::INFINITY);
            };
            logarithms += (left_out_distance(samples, r, surface.as_ref())? + EXACT).ln();
            let mean = factor * f64::exp(logarithms / (means.len() + 1) as f64);
            if let (Some(&best), Some(last)) = (self.best.get(means.len()), self.best.last())
                && mean > AS_GOOD_AS_EXACT.max(OUT_OF_REACH * best)
            {
                // What was not compared with all bands is not as good as exact.
                return Ok(mean / best * last.max(AS_GOOD_AS_EXACT));
            }
            means.push(mean);
        }
        self.best.resize(means.len(), f64::INFINITY);
        for (best, mean) in self.best.iter_mut().zip(&means) {
            *best = best.min(*mean);
        }
        Ok(means.last().copied().unwrap_or(f64::INFINITY))
    }
}

/// Root mean square distance of the vertices below level `r` to the surface, in rim edge lengths.
fn left_out_distance(samples: &mut SampledBand, r: u32, surface: &dyn Implicit) -> Result<f64> {
    let vertices = samples.spread(0..r, MOST_TESTS)?;
    let mut squares = 0.0;
    let mut count = 0.0;
    for &v in &vertices {
        samples.job.tick(500)?;
        let distance = project::distance(surface, &samples.fits.around.point(v)) / samples.step;
        // Not a number counts as far off.
        squares += if distance < FARTHEST {
            distance * distance
        } else {
            FARTHEST * FARTHEST
        };
        count += 1.0;
    }
    Ok((squares / f64::max(count, 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::rings_around;
    use super::*;
    use crate::job::UNLIMITED;
    use crate::surroundings::fits::QuadricFits;

    /// Rings round the hole of a paraboloid of this steepness.
    fn sampled(steepness: f64) -> SampledBand<'static> {
        let hole = rings_around(24, |x, y| steepness * (x * x + y * y));
        let hole = Box::leak(Box::new(hole));
        let fits = QuadricFits::new(&hole.surroundings, &UNLIMITED).unwrap();
        SampledBand::new(fits, hole, 1.0, true, &UNLIMITED)
    }

    #[test]
    fn what_falls_behind_is_not_as_good_as_exact() {
        let mut samples = sampled(0.05);
        let whole = Race::default()
            .run(&mut samples, Candidate::Plane, MOST_LEFT_OUT)
            .unwrap();
        assert!(whole > 0.1, "{whole}");
        let best = vec![whole / 10.0, 1e-3, 1e-5];
        let mut race = Race { best: best.clone() };
        let behind = race
            .run(&mut samples, Candidate::Plane, MOST_LEFT_OUT)
            .unwrap();
        assert!(
            behind > OUT_OF_REACH * AS_GOOD_AS_EXACT && behind < whole,
            "{behind}"
        );
        assert_eq!(race.best, best);
    }

    #[test]
    fn the_quintic_kernel_must_win_clearly_and_more_so_on_wide_rims() {
        for (score, rim_edges, wins) in [
            (0.5, 20, true),
            (0.5, 150, true),
            (0.5, 300, false),
            (0.25, 300, true),
            (0.7, 20, false),
            (2.0, 20, false),
        ] {
            let scores = [
                (Candidate::Cubic, 1.0),
                (Candidate::Quintic, of_quintic(score, 1.0, rim_edges)),
            ];
            let expected = if wins {
                Candidate::Quintic
            } else {
                Candidate::Cubic
            };
            assert_eq!(
                choose(&scores, false),
                Some(expected),
                "{score} {rim_edges}"
            );
            assert!(scores[1].1 >= score);
        }
    }

    #[test]
    fn the_quintic_kernel_is_held_against_either_cubic_one() {
        let position = |c| Candidate::ALL.iter().position(|&other| other == c);
        for cubic in [Candidate::Cubic, Candidate::CubicSmoothed] {
            assert!(position(cubic) < position(Candidate::Quintic));
            let scores = [(Candidate::Quadric, 3.0), (cubic, 2.0)];
            assert_eq!(cubic_score(&scores), Some(2.0));
        }
    }

    #[test]
    fn nothing_with_more_freedom_than_an_exact_surface_is_tried() {
        let mut samples = sampled(0.0);
        let scores = scores(&mut samples, &Candidate::ALL).unwrap();
        assert!(is_exact(&scores), "{scores:?}");
        assert_eq!(score_of(&scores, Candidate::Cubic), None);
        assert_eq!(choose(&scores, false), Some(Candidate::Plane));
    }
}
