//! Predicts one section by itself. It serves experiments on the convergence and the cost of differential evolution.

use super::evolution::evolve;
use super::options::{HpdeOptions, HpdeSolver};
use crate::error::{Error, Result};
use crate::job::Job;
use crate::math::random::seeded;
use crate::methods::sections::arcs::{Arc, profile};
use std::f64::consts::PI;

/// The points that were predicted in a section, in its plane.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SectionCurve {
    /// The points from the end at the origin to the end at `(length, 0)`, without the ends.
    pub points: Vec<[f64; 2]>,
    /// The objective of equation 14 for the best individual, at the start and after each generation: the largest angle
    /// between consecutive edges, in radians. It never increases.
    pub largest_turns: Vec<f64>,
}

/// Predicts `count` points of a section, the fifth step of [`Method::Hpde`](crate::Method::Hpde). `length` is the
/// distance of the ends in mean edge lengths. `angles` are the angles in radians by which the surface rises from the
/// line between the ends. Only the solver and the options of differential evolution are read.
///
/// # Errors
/// [`crate::ErrorKind::InvalidInput`] unless the length is positive and finite and the angles are between -π and π.
///
/// # Complexity
/// `O(count · generations)`.
pub fn evolve_section(
    length: f64,
    angles: [f64; 2],
    count: usize,
    options: &HpdeOptions,
    seed: u64,
) -> Result<SectionCurve> {
    let is_sound = length.is_finite() && length > 0.0 && angles.iter().all(|a| a.abs() < PI);
    if !is_sound {
        return Err(Error::invalid(format!(
            "there is no section of length {length} with the angles {angles:?}"
        )));
    }
    let [first, second] = angles.map(|angle| Arc { length, angle });
    let profile = profile(&first, &second, count);
    let generations = match options.solver {
        HpdeSolver::Direct => 0,
        HpdeSolver::De => options.generations,
    };
    let options = HpdeOptions {
        generations,
        ..options.clone()
    };
    let found = evolve(&profile, &options, &mut seeded(seed, 0), &Job::unlimited())?;
    let points = profile.x.iter().zip(&found.values);
    Ok(SectionCurve {
        points: points.map(|(x, y)| [*x, *y]).collect(),
        largest_turns: found.history,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    #[test]
    fn a_circle_is_continued_and_needs_no_generation() {
        let (angle, length): (f64, f64) = (0.8, 6.0);
        let curve = evolve_section(length, [angle; 2], 7, &HpdeOptions::default(), 1).unwrap();
        assert_eq!(curve.largest_turns.len(), 1);
        // Eight chords turn by twice the angle together, half a chord's share of it at each end.
        assert!((curve.largest_turns[0] - angle / 4.0).abs() < 1e-9);
        let radius = length / (2.0 * angle.sin());
        for p in &curve.points {
            let distance = (p[0] - length / 2.0).hypot(p[1] + radius * angle.cos());
            assert!((distance - radius).abs() < 1e-9);
        }
    }

    #[test]
    fn the_direct_solver_is_the_start_of_the_search() {
        let direct = HpdeOptions {
            solver: HpdeSolver::Direct,
            ..HpdeOptions::default()
        };
        let run = |options: &HpdeOptions| evolve_section(8.0, [1.1, 0.2], 9, options, 3).unwrap();
        let (start, evolved) = (run(&direct), run(&HpdeOptions::default()));
        assert_eq!(start.largest_turns.len(), 1);
        assert_eq!(start.largest_turns[0], evolved.largest_turns[0]);
        assert!(evolved.largest_turns.windows(2).all(|w| w[1] <= w[0]));
        assert_ne!(start.points, evolved.points);
    }

    #[test]
    fn impossible_sections_are_refused() {
        let run = |length: f64, angles: [f64; 2]| {
            evolve_section(length, angles, 3, &HpdeOptions::default(), 0).map_err(|e| e.kind())
        };
        for (length, angles) in [
            (0.0, [0.1, 0.1]),
            (f64::NAN, [0.1, 0.1]),
            (1.0, [f64::NAN, 0.1]),
            (1.0, [0.1, PI]),
        ] {
            assert_eq!(run(length, angles), Err(ErrorKind::InvalidInput));
        }
        let none = evolve_section(1.0, [0.1, 0.2], 0, &HpdeOptions::default(), 0).unwrap();
        assert!(none.points.is_empty());
    }
}
