//! Unfolds a closed polygon by simulated annealing.
//!
//! Based on: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, section 3.1; W. H. Press, S. A. Teukolsky, W. T. Vetterling, B. P. Flannery,
//! "Numerical recipes in C", 2nd edition, 1992, section 10.9 (acceptance by the Boltzmann distribution).
//!
//! A step moves each vertex in a random direction of its own; all move by the same length. A step that decreases the
//! planarity energy is accepted, and the next step has similar directions. Another step is accepted with the
//! probability exp(-ΔE / (k T)). The temperature T falls from level to level by the factor k.
//!
//! The length of a step is below half of the smallest distance of two segments, so the polygon never crosses itself.
//! Cost: O(m) for a step, without the computation of that distance.

use super::distance::SegmentDistances;
use super::energy::planarity;
use super::options::UnfoldOptions;
use crate::math::{Vec3, unit};
use rand::RngExt;
use rand_pcg::Pcg64;

/// Number of temperature levels in a run. With k = 0.9 the last temperature is half a percent of the first.
const LEVELS: usize = 50;

/// Upper bound on a step, as a share of half the smallest distance of two segments. The rest allows for rounding.
const CLEARANCE_SHARE: f64 = 0.98;

/// One run of the annealing.
pub(super) struct Annealing<'a> {
    options: &'a UnfoldOptions,
    generator: Pcg64,
    points: Vec<Vec3>,
    energy: f64,
    /// The smallest distance of two segments that are not neighbors.
    distance: f64,
    /// The directions of the last step, if it decreased the energy.
    directions: Option<Vec<Vec3>>,
    temperature: f64,
    steps: usize,
    distances: SegmentDistances,
}

impl<'a> Annealing<'a> {
    /// Starts at `points`. Their mean edge length is 1, and the distance of segments that are not neighbors is above
    /// epsilon.
    pub(super) fn new(points: &[Vec3], options: &'a UnfoldOptions, generator: Pcg64) -> Self {
        let mut distances = SegmentDistances::default();
        Self {
            options,
            generator,
            energy: planarity(points),
            distance: distances.smallest(points),
            points: points.to_vec(),
            directions: None,
            temperature: options.temperature,
            steps: 0,
            distances,
        }
    }

    /// The present polygon.
    pub(super) fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// Tries a step, and returns whether it was accepted.
    pub(super) fn step(&mut self) -> bool {
        self.steps += 1;
        if self
            .steps
            .is_multiple_of((self.options.steps / LEVELS).max(1))
        {
            self.temperature *= self.options.k;
        }
        let longest = 0.5 * CLEARANCE_SHARE * (self.distance - self.options.epsilon);
        let length = longest.clamp(0.0, 1.0) * self.generator.random_range(0.0..=1.0);
        let directions = self.next_directions();
        let moved: Vec<Vec3> = self
            .points
            .iter()
            .zip(&directions)
            .map(|(p, d)| p + d * length)
            .collect();
        let energy = planarity(&moved);
        let rise = energy - self.energy;
        let is_lower = rise < 0.0;
        if !is_lower {
            let chance = (-rise / (self.options.k * self.temperature)).exp();
            if self.generator.random_range(0.0..1.0) >= chance {
                self.directions = None;
                return false;
            }
        }
        self.points = moved;
        self.energy = energy;
        self.distance = self.distances.smallest(&self.points);
        self.directions = is_lower.then_some(directions);
        true
    }

    /// A direction for each vertex: near the last one if the last step decreased the energy, otherwise any direction.
    fn next_directions(&mut self) -> Vec<Vec3> {
        let generator = &mut self.generator;
        match &self.directions {
            None => self
                .points
                .iter()
                .map(|_| any_direction(generator))
                .collect(),
            Some(last) => {
                let most = self.options.cone.to_radians();
                last.iter()
                    .map(|&d| near_direction(d, most, generator))
                    .collect()
            }
        }
    }
}

/// A random direction, uniform on the sphere.
fn any_direction(generator: &mut Pcg64) -> Vec3 {
    let height: f64 = generator.random_range(-1.0..=1.0);
    let turn = generator.random_range(0.0..std::f64::consts::TAU);
    let radius = (1.0 - height * height).max(0.0).sqrt();
    Vec3::new(radius * turn.cos(), radius * turn.sin(), height)
}

/// A random direction that makes at most the angle `most` with the unit vector `direction`.
fn near_direction(direction: Vec3, most: f64, generator: &mut Pcg64) -> Vec3 {
    let angle = generator.random_range(0.0..=most);
    let any = any_direction(generator);
    let side = unit(any - direction * any.dot(&direction));
    unit(direction * angle.cos() + side * angle.sin())
}
