//! The positions of samples inside a hole: the points of a square grid in the domain that lie inside the rim.
//!
//! Each grid line is cut with the rim; the points between two crossings are inside. Points too near to the rim are left
//! out. Source: J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed from point clouds",
//! 2007, section 4.3, which calls the rim's surroundings the mask.

use crate::error::{Error, Result};
use crate::job::Job;
use crate::triangulate::simple_polygon::Point2;

/// Lower bound on the distance of a sample from the rim, in grid widths.
const CLEARANCE: f64 = 0.5;
/// Upper bound on the coordinates of the rim, in grid widths. Larger ones would not fit the arithmetic below.
const MOST_LINES: f64 = 1e9;

/// The points of a grid of width `step` through the origin that lie inside the `loops` and at least half a step away
/// from them, sorted by `v`, then by `u`. Inside is decided by the parity of crossings, so an inner loop bounds an
/// island.
///
/// # Errors
/// [`crate::ErrorKind::Limit`] for more than `limit` samples; [`crate::ErrorKind::Cancelled`].
///
/// # Complexity
/// O(k + l log l) for k samples and l grid cells along the loops.
pub(crate) fn resampling_positions(
    loops: &[Vec<Point2>],
    step: f64,
    limit: usize,
    job: &Job<'_>,
) -> Result<Vec<Point2>> {
    let too_many = || {
        let message = format!("the hole needs more than {limit} new vertices");
        Error::limit(message)
    };
    let mut crossings: Vec<(i64, f64)> = Vec::new();
    let mut near: Vec<(i64, i64)> = Vec::new();
    for of_loop in loops {
        for (i, &a) in of_loop.iter().enumerate() {
            job.tick(10)?;
            let b = of_loop[(i + 1) % of_loop.len()];
            let edge = [a, b].map(|p| p.map(|x| x / step));
            if !edge.iter().flatten().all(|x| x.abs() < MOST_LINES) {
                return Err(too_many());
            }
            add_crossings(edge, &mut crossings);
            add_near(edge, &mut near);
            if near.len() / 16 > limit.saturating_add(of_loop.len()) {
                // A piece of a loop as long as the grid width has at most sixteen grid points near it.
                return Err(too_many());
            }
        }
    }
    crossings.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    near.sort_unstable();
    near.dedup();
    let mut samples = Vec::new();
    for pair in crossings.chunks_exact(2) {
        let [(row, from), (_, to)] = [pair[0], pair[1]];
        let first = from.ceil() as i64;
        let last = to.floor() as i64;
        job.tick((last - first).max(0) as usize)?;
        let start = near.partition_point(|&cell| cell < (row, first));
        let mut covered = near[start..].iter().copied().peekable();
        for column in first..=last {
            while covered.next_if(|&cell| cell < (row, column)).is_some() {}
            if covered.peek() != Some(&(row, column)) {
                if samples.len() >= limit {
                    return Err(too_many());
                }
                samples.push([column as f64 * step, row as f64 * step]);
            }
        }
    }
    Ok(samples)
}

/// Adds the crossings of an edge with the horizontal lines of the grid. An end of the edge on a line counts as above
/// it.
fn add_crossings([a, b]: [Point2; 2], crossings: &mut Vec<(i64, f64)>) {
    let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
    for row in low[1].ceil() as i64..high[1].ceil() as i64 {
        let share = (row as f64 - low[1]) / (high[1] - low[1]);
        crossings.push((row, low[0] + share * (high[0] - low[0])));
    }
}

/// Adds the points of the grid that are nearer to the edge than the clearance.
fn add_near([a, b]: [Point2; 2], near: &mut Vec<(i64, i64)>) {
    let range = |k: usize| {
        let (low, high) = (a[k].min(b[k]), a[k].max(b[k]));
        (low - CLEARANCE).ceil() as i64..=(high + CLEARANCE).floor() as i64
    };
    let d = [b[0] - a[0], b[1] - a[1]];
    let length_sq = d[0] * d[0] + d[1] * d[1];
    for row in range(1) {
        // The part of the edge that is near this line.
        let at = |bound: f64| ((bound - a[1]) / d[1]).clamp(0.0, 1.0);
        let (s, t) = if d[1] == 0.0 {
            (0.0, 1.0)
        } else {
            (at(row as f64 - CLEARANCE), at(row as f64 + CLEARANCE))
        };
        let (x, y) = (a[0] + s * d[0], a[0] + t * d[0]);
        let columns = (x.min(y) - CLEARANCE).ceil() as i64..=(x.max(y) + CLEARANCE).floor() as i64;
        for column in columns {
            let p = [column as f64 - a[0], row as f64 - a[1]];
            let share = if length_sq > 0.0 {
                ((p[0] * d[0] + p[1] * d[1]) / length_sq).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let off = [p[0] - share * d[0], p[1] - share * d[1]];
            if off[0] * off[0] + off[1] * off[1] < CLEARANCE * CLEARANCE {
                near.push((row, column));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;
    use proptest::prelude::*;

    fn distance(p: Point2, [a, b]: [Point2; 2]) -> f64 {
        let d = [b[0] - a[0], b[1] - a[1]];
        let along = (p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1];
        let share = (along / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
        (p[0] - a[0] - share * d[0]).hypot(p[1] - a[1] - share * d[1])
    }

    fn circle(radius: f64, n: usize, sign: f64) -> Vec<Point2> {
        let angle = |i: usize| sign * std::f64::consts::TAU * i as f64 / n as f64;
        (0..n)
            .map(|i| [radius * angle(i).cos(), radius * angle(i).sin()])
            .collect()
    }

    /// All grid points of a square, judged one by one.
    fn slowly(loops: &[Vec<Point2>], step: f64) -> Vec<Point2> {
        let edges: Vec<[Point2; 2]> = loops
            .iter()
            .flat_map(|l| (0..l.len()).map(|i| [l[i], l[(i + 1) % l.len()]]))
            .collect();
        let is_inside = |p: Point2| {
            let crosses = |e: &&[Point2; 2]| {
                let [a, b] = **e;
                (a[1] >= p[1]) != (b[1] >= p[1])
                    && a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) < p[0]
            };
            edges.iter().filter(crosses).count() % 2 == 1
        };
        let mut found = Vec::new();
        for row in -40..40 {
            for column in -40..40 {
                let p = [f64::from(column) * step, f64::from(row) * step];
                let clear = edges.iter().all(|&e| distance(p, e) >= CLEARANCE * step);
                if clear && is_inside(p) {
                    found.push(p);
                }
            }
        }
        found
    }

    proptest! {
        #[test]
        fn the_samples_are_those_that_each_grid_point_by_itself_gives(
            radii in proptest::collection::vec(0.3..1.0, 5..30),
            step in 0.04..0.2,
            inner in 0.05..0.25,
        ) {
            let n = radii.len();
            let angle = |i: usize| std::f64::consts::TAU * (i as f64 + 0.1) / n as f64;
            let star = (0..n).map(|i| [radii[i] * angle(i).cos(), radii[i] * angle(i).sin()]);
            let loops = [star.collect(), circle(inner, 7, -1.0)];
            let found = resampling_positions(&loops, step, 10_000, &Job::unlimited()).unwrap();
            prop_assert_eq!(found, slowly(&loops, step));
        }
    }

    #[test]
    fn an_island_is_left_out() {
        let loops = [circle(1.0, 60, 1.0), circle(0.5, 30, -1.0)];
        let found = resampling_positions(&loops, 0.05, 10_000, &Job::unlimited()).unwrap();
        let area = std::f64::consts::PI * (1.0 - 0.25) / (0.05 * 0.05);
        assert!((found.len() as f64) > 0.8 * area && (found.len() as f64) < area);
        let radius = |p: &Point2| p[0].hypot(p[1]);
        assert!(found.iter().all(|p| radius(p) > 0.52 && radius(p) < 0.98));
    }

    #[test]
    fn too_many_samples_and_a_stop_are_errors() {
        let loops = [circle(1.0, 60, 1.0)];
        for step in [0.01, 1e-12] {
            let error = resampling_positions(&loops, step, 100, &Job::unlimited()).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Limit);
        }
        let error = resampling_positions(&loops, 0.1, 1000, &Job::new(&|| true)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Cancelled);
    }
}
