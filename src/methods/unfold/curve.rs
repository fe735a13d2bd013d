//! Curve unfolding: deforms a closed polygon in space to a simple polygon in the plane, without ever letting it
//! cross itself.
//!
//! Based on: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", Shape Modeling International, 2009, section 3.1. `annealing` is the solver of the paper,
//! `descent` ours.
//!
//! A motion without crossings keeps the knot that the polygon is: what was unfolded was not knotted, and a
//! knotted polygon is never unfolded, only given up.

use super::annealing::Annealing;
use super::descent::Descent;
use super::distance::SegmentDistances;
use super::options::{UnfoldOptions, UnfoldSolver};
use super::projection::onto_best_plane;
use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use crate::math::Vec3;
use crate::math::random::seeded;
use crate::triangulate::simple_polygon::Point2;

/// A curve that was unfolded.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Unfolding {
    /// The simple planar polygon, a vertex for each of the curve, in units of the curve's mean edge length. It may
    /// turn either way.
    pub polygon: Vec<[f64; 2]>,
    /// Runs of the solver, the last of which succeeded; 0 when the curve was projected as it is.
    pub runs: usize,
    /// Accepted steps of the last run.
    pub steps: usize,
    /// Perimeter of the polygon over that of the curve.
    pub length_ratio: f64,
    /// Full turns that the direction of the polygon's edges makes once round it: 1 or -1, up to rounding.
    pub winding: f64,
}

/// Unfolds the closed curve through `points` to a simple planar polygon, without letting it cross itself on the
/// way. The polygon is proved simple by exact predicates.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] for fewer than three points or one that is not finite; [`ErrorKind::Geometry`] when
/// the curve meets itself or comes nearer to itself than ε; [`ErrorKind::Knotted`] when all runs ended
/// without a simple polygon, as they do for every knotted curve.
///
/// # Complexity
/// Bounded by runs times steps; a step takes about O(m^1.5) for `m` points.
pub fn unfold_curve(points: &[[f64; 3]], options: &UnfoldOptions, seed: u64) -> Result<Unfolding> {
    let points: Vec<Vec3> = points.iter().map(|&p| p.into()).collect();
    unfold(&points, options, seed, &Job::unlimited())
}

/// As [`unfold_curve`]; [`ErrorKind::Cancelled`] when the job is stopped.
pub(crate) fn unfold(
    points: &[Vec3],
    options: &UnfoldOptions,
    seed: u64,
    job: &Job<'_>,
) -> Result<Unfolding> {
    let curve = in_mean_edges(points)?;
    if options.solver == UnfoldSolver::Descent
        && let Some(polygon) = onto_best_plane(&curve, job)?
    {
        return Ok(unfolded(&curve, polygon, 0, 0));
    }
    let distance = SegmentDistances::default().smallest(&curve);
    if distance.is_nan() || distance <= options.epsilon {
        return Err(Error::geometry(format!(
            "the rim of {} edges comes within {distance:.1e} mean edge lengths of itself",
            curve.len()
        )));
    }
    let default_restarts = match options.solver {
        UnfoldSolver::Descent => DESCENT_RUNS,
        UnfoldSolver::Annealing => ANNEALING_RUNS,
    };
    let restarts = options.restarts.unwrap_or(default_restarts);
    for run in 0..restarts {
        let outcome = match options.solver {
            UnfoldSolver::Descent => descend(&curve, options, (seed, run), job)?,
            UnfoldSolver::Annealing => anneal(&curve, options, (seed, run), job)?,
        };
        if let Some((polygon, steps)) = outcome {
            return Ok(unfolded(&curve, polygon, run + 1, steps));
        }
    }
    Err(Error::new(
        ErrorKind::Knotted,
        format!(
            "the rim of {} edges was not unfolded in {restarts} runs: it is knotted or too tangled",
            curve.len()
        ),
    ))
}

/// Runs before a curve counts as not unfolded: for the annealing that of the paper. The descent hardly depends
/// on chance: what it does not unfold at once it seldom unfolds later.
const ANNEALING_RUNS: usize = 100;
const DESCENT_RUNS: usize = 4;

/// A run does no more steps than keep `steps m^1.5` below this, some seconds; `unfold.steps` steps need less for all
/// but rims of thousands of edges.
const MOST_WORK: f64 = 5e8;

/// Steps that a run may take.
fn step_limit(options: &UnfoldOptions, m: usize) -> usize {
    let affordable = MOST_WORK / (m as f64).powf(1.5);
    options.steps.min(affordable as usize).max(1)
}

/// A run of the descent; the polygon and the number of steps if it was unfolded.
fn descend(
    curve: &[Vec3],
    options: &UnfoldOptions,
    (seed, run): (u64, usize),
    job: &Job<'_>,
) -> Result<Option<(Vec<Point2>, usize)>> {
    let kicks = (run > 0).then(|| seeded(seed, run as u64));
    let mut descent = Descent::new(curve, options.epsilon, kicks);
    for step in 1..=step_limit(options, curve.len()) {
        job.tick(curve.len())?;
        if !descent.step() {
            break;
        }
        if let Some(polygon) = onto_best_plane(descent.points(), job)? {
            return Ok(Some((polygon, step)));
        }
    }
    Ok(None)
}

/// A run of the annealing; the polygon and the number of accepted steps if it was unfolded.
fn anneal(
    curve: &[Vec3],
    options: &UnfoldOptions,
    (seed, run): (u64, usize),
    job: &Job<'_>,
) -> Result<Option<(Vec<Point2>, usize)>> {
    let mut annealing = Annealing::new(curve, options, seeded(seed, run as u64));
    let mut accepted = 0;
    for _ in 0..step_limit(options, curve.len()) {
        job.tick(curve.len())?;
        accepted += usize::from(annealing.step());
    }
    let polygon = onto_best_plane(annealing.points(), job)?;
    Ok(polygon.map(|polygon| (polygon, accepted)))
}

/// The curve about its centroid, in units of its mean edge length.
fn in_mean_edges(points: &[Vec3]) -> Result<Vec<Vec3>> {
    let m = points.len();
    let invalid = |message: String| Error::invalid(message);
    if m < 3 {
        return Err(invalid(format!("a curve of {m} points is not closed")));
    }
    let centroid = points.iter().sum::<Vec3>() / m as f64;
    let mean = perimeter(points) / m as f64;
    if !mean.is_finite() || !centroid.iter().all(|x| x.is_finite()) {
        return Err(invalid("a point of the curve is not finite".to_owned()));
    }
    if mean <= f64::MIN_POSITIVE {
        return Err(Error::geometry("all points of the curve coincide"));
    }
    Ok(points.iter().map(|p| (p - centroid) / mean).collect())
}

fn perimeter(points: &[Vec3]) -> f64 {
    let m = points.len();
    (0..m)
        .map(|i| (points[(i + 1) % m] - points[i]).norm())
        .sum()
}

fn unfolded(curve: &[Vec3], polygon: Vec<Point2>, runs: usize, steps: usize) -> Unfolding {
    let m = polygon.len();
    let edge = |i: usize| {
        let (p, q) = (polygon[i % m], polygon[(i + 1) % m]);
        [q[0] - p[0], q[1] - p[1]]
    };
    let length: f64 = (0..m).map(|i| edge(i)[0].hypot(edge(i)[1])).sum();
    let turning: f64 = (0..m)
        .map(|i| {
            let (a, b) = (edge(i), edge(i + 1));
            (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
        })
        .sum();
    Unfolding {
        length_ratio: length / perimeter(curve),
        winding: turning / std::f64::consts::TAU,
        polygon,
        runs,
        steps,
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
