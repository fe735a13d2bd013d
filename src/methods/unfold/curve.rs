//! Curve unfolding: deforms a closed polygon in space to a simple polygon in the plane, such that it never crosses
//! itself on the way.
//!
//! A run of a solver moves the polygon in small steps. It succeeds when the projection of the polygon to its least
//! squares plane is simple. If a run fails, the next one has other random numbers.
//!
//! Source: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", Shape Modeling International, 2009, section 3.1. `annealing` is the solver of the paper; `descent`
//! is our own.
//!
//! A motion without crossings does not change the knot type. So a polygon that was unfolded is not knotted, and a
//! knotted polygon is never unfolded. Not guaranteed: that every unknotted polygon is unfolded.

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
    /// The simple planar polygon, with one vertex for each vertex of the curve, in mean edge lengths of the curve. It
    /// may be clockwise or counter-clockwise.
    pub polygon: Vec<[f64; 2]>,
    /// Runs of the solver up to the one that succeeded; 0 when the curve itself had a simple projection.
    pub runs: usize,
    /// Accepted steps of the last run.
    pub steps: usize,
    /// Perimeter of the polygon, divided by that of the curve.
    pub length_ratio: f64,
    /// Turning number of the polygon: 1 or -1, up to rounding.
    pub winding: f64,
}

/// Unfolds the closed curve through `points` to a simple planar polygon. The curve never crosses itself on the way.
/// Exact predicates verify that the polygon is simple.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] for fewer than three points or one that is not finite; [`ErrorKind::Geometry`] when
/// the distance of two parts of the curve is at most `options.epsilon`; [`ErrorKind::Knotted`] when all runs fail, as
/// they do for every knotted curve.
///
/// # Complexity
/// Bounded by runs times steps; a step takes about O(m^1.5) for `m` points.
pub fn unfold_curve(points: &[[f64; 3]], options: &UnfoldOptions, seed: u64) -> Result<Unfolding> {
    let points: Vec<Vec3> = points.iter().map(|&p| p.into()).collect();
    unfold(&points, options, seed, &Job::unlimited())
}

/// As [`unfold_curve`], for a job of the caller; [`ErrorKind::Cancelled`] when it is cancelled.
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

/// Default for the upper bound on the runs of the annealing, as in the paper.
const ANNEALING_RUNS: usize = 100;
/// Default for the upper bound on the runs of the descent. It hardly depends on random numbers, so further runs seldom
/// succeed.
const DESCENT_RUNS: usize = 4;

/// Upper bound on `steps · m^1.5` of a run, some seconds of work. It matters only for rims of thousands of edges.
const MOST_WORK: f64 = 5e8;

/// Upper bound on the steps of a run for a curve of `m` points.
fn step_limit(options: &UnfoldOptions, m: usize) -> usize {
    let affordable = MOST_WORK / (m as f64).powf(1.5);
    options.steps.min(affordable as usize).max(1)
}

/// A run of the descent. Returns the polygon and the number of steps if it succeeds.
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

/// A run of the annealing. Returns the polygon and the number of accepted steps if it succeeds.
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

/// The curve with its centroid as origin and its mean edge length as unit.
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
