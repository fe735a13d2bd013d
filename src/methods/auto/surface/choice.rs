//! Chooses the surface that continues the mesh into a hole, by leave-out cross-validation.
//!
//! The test pretends that the hole is larger. For `r` = 1, 2, 3, a candidate is fitted to the rings of vertices `r`
//! to `r + 3`, and its distance from the vertices of the rings below `r` is measured; ring 0 is the rim. The score of
//! the candidate is the geometric mean of the three root mean square distances, in mean rim edge lengths. Smaller is
//! better. A mean of three makes it less likely that noise decides. Scores of interpolating functions are made worse
//! by a factor. If candidates are as good as exact, the simplest of them is chosen, otherwise the one with the best
//! score.
//!
//! Source: M. Stone, "Cross-validatory choice and assessment of statistical predictions", Journal of the Royal
//! Statistical Society B 36(2), 1974, leaves out single observations. Here whole bands are left out on the side of the
//! hole, because a hole needs extrapolation.
//!
//! Cost: up to three fits for each candidate. Not guaranteed: that a candidate that predicts three rings well also
//! predicts the middle of a hole that is much wider.

use super::candidates::Candidate;
use super::samples::SampledBand;
use super::{FITTED_RINGS, Implicit, project};
use crate::error::Result;

/// Upper bound on the width of the band that is left out, in rings.
const MOST_LEFT_OUT: u32 = 3;
/// Lower bound on the samples of a fit.
const FEWEST_SAMPLES: usize = 20;
/// Upper bound on the left-out vertices that a fit is compared with.
const MOST_TESTS: usize = 150;
/// Upper bound on the distance that one vertex counts with, in mean rim edge lengths. It keeps outliers from dominating
/// the mean.
const FARTHEST: f64 = 10.0;
/// Added to each distance before the logarithm, in mean rim edge lengths. Smaller distances are rounding errors of
/// files in single precision.
const EXACT: f64 = 1e-5;
/// A candidate with a score below this is as good as exact, in mean rim edge lengths. What remains is the error of the
/// triangulation.
const AS_GOOD_AS_EXACT: f64 = 2e-3;
/// Factor on the scores of interpolating functions. They have as many degrees of freedom as data.
const INTERPOLATION_FACTOR: f64 = 1.25;
/// If the surroundings are noisy, the simplest candidate with a score within this factor of the best is chosen.
const NOISY_TOLERANCE: f64 = 1.12;
/// The score of the quintic kernel must be below this factor times the score of the cubic kernel, because the quintic
/// one overshoots where the surface has detail. Measured on 348 holes cut out of 14 models: 0.5 and 0.6 are best among
/// factors from 0.4 to 0.95.
const QUINTIC_FACTOR: f64 = 0.6;
/// On rims with more edges than this, the factor decreases in proportion. The middle of such a hole is eight times as
/// many rings away as the widest band that is left out, and the quintic kernel grows faster.
const WIDE_RIM: f64 = 150.0;
/// A candidate whose mean over the first bands exceeds the best mean over these bands by this factor is not compared
/// with the other bands. Measured on 2,226 holes in 59 models: with 3 no choice changes, with 2 one, with 1.5 nine.
const OUT_OF_REACH: f64 = 3.0;
/// A candidate with a gate ([`Candidate::gate`]) is fitted only if the score of the gate is within this factor of the
/// best score so far, or of `AS_GOOD_AS_EXACT`.
const GATE_FACTOR: f64 = 2.0;

/// A candidate with its score in rim edge lengths; smaller is better.
pub(crate) type Score = (Candidate, f64);

/// Rim edges for each ring between the rim and the middle of a hole: in a regular mesh, six edges are one ring away
/// from the middle, twelve edges two rings.
const EDGES_PER_RING: usize = 6;

/// Scores of the candidates that were fitted, in the order of fitting. The widest band that is left out has as many
/// rings as the hole has from rim to middle, but at most three.
///
/// If a candidate is as good as exact, candidates with more degrees of freedom are skipped. A candidate that is far
/// behind after some of the bands is not compared with the others. Its score is then the best score times the factor by
/// which it was behind.
///
/// # Errors
/// `Cancelled` when the job of the samples is cancelled.
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

/// The score of the cubic kernel, for original or smoothed points; only one of the two competes.
fn cubic_score(scores: &[Score]) -> Option<f64> {
    let is_cubic = |s: &&Score| matches!(s.0, Candidate::Cubic | Candidate::CubicSmoothed);
    scores.iter().find(is_cubic).map(|s| s.1)
}

/// The score of the quintic kernel. It is made worse than that of the cubic kernel unless it is clearly better.
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

/// The candidate to use: the simplest one that is as good as exact, otherwise the best one.
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

/// Whether a candidate with this score is as good as exact.
pub(crate) fn is_as_good_as_exact(score: f64) -> bool {
    score < AS_GOOD_AS_EXACT
}

/// The comparison of candidates, band by band.
#[derive(Default)]
struct Race {
    /// The best mean so far over the first band, the first two, and so on.
    best: Vec<f64>,
}

impl Race {
    /// The score of a candidate, for bands up to `widest` rings; infinite when nothing could be fitted. See [`scores`]
    /// for candidates that fall too far behind.
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
                // A candidate that was not compared with all bands must not count as exact.
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
