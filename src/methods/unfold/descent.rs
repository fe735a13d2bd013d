//! Unfolds a closed polygon: its vertices repel each other while its edges keep their lengths.
//!
//! The energy is the sum of the inverse distances of all pairs of vertices. Each step:
//!
//! 1. Compute the forces, which are the negative gradient of the energy, and smooth them along the polygon, so that
//!    long parts move as a whole. They give a target for each vertex.
//! 2. Change the targets so that edges get their lengths back and near segments move apart.
//! 3. Move each vertex toward its target, but by less than half of the distance between its two segments and all
//!    others. So no two segments can meet, and the polygon never crosses itself.
//!
//! Sources: J. H. Cantarella, E. D. Demaine, H. N. Iben, J. F. O'Brien, "An energy-driven approach to linkage
//! unfolding", Symposium on Computational Geometry, 2004, for the energy. The bound on steps is that of A. Brunton,
//! S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by curve unfolding", SMI 2009,
//! section 3.1, but for each vertex.
//!
//! Cost: O(m^1.5) for the forces of a step; far vertices act together, in runs of √m. Not guaranteed: that the energy
//! decreases in each step, that lengths are kept where the bound is tight, that every unknotted polygon is unfolded.

use super::distance::{Clearances, SegmentDistances};
use crate::math::{Vec3, unit};
use rand::RngExt;
use rand_pcg::Pcg64;

/// Distance from the vertex with the largest force to its first target, in mean edge lengths. With longer steps, edges
/// would turn so far that they lose their lengths.
const STEP: f64 = 0.5;

/// Width over which forces are smoothed along the polygon, as a share of its number of vertices. It is large enough for
/// the arms of a folded rim to move as a whole.
const SMOOTHING_SHARE: f64 = 0.1;

/// Number of sweeps in a step that restore lengths and push near segments apart.
const SWEEPS: usize = 20;

/// Distance below which two segments are pushed apart, in mean edge lengths. Forces act on vertices only, so they do
/// not keep the middles of two edges apart.
const CONTACT: f64 = 0.5;

/// Distances of segments are computed up to this, in mean edge lengths. No step is longer than half of it.
const REACH: f64 = 4.0 * STEP;

/// Upper bound on the motion of a vertex, as a share of half the distance to other segments. The rest allows for
/// rounding.
const CLEARANCE_SHARE: f64 = 0.98;

/// Lower bound on the distance at which a run of vertices acts as one, in radii of the run. The error of the force is
/// then below a tenth.
const FAR: f64 = 3.0;

/// Strength of the random forces that disturb all runs of the solver but the first, relative to the mean force.
const KICK: f64 = 1.0;
/// Number of steps that are disturbed.
const KICKED_STEPS: usize = 100;

/// The descent has stalled if the energy decreased by less than the share `STALL_SHARE` in `STALL_STEPS` steps.
const STALL_SHARE: f64 = 1e-3;
const STALL_STEPS: usize = 200;

/// One run of the descent.
pub(super) struct Descent {
    points: Vec<Vec3>,
    lengths: Vec<f64>,
    epsilon: f64,
    kicks: Option<Pcg64>,
    steps: usize,
    /// Energy at the last comparison.
    energy: f64,
    forces: Vec<Vec3>,
    targets: Vec<Vec3>,
    clearances: Clearances,
    distances: SegmentDistances,
}

impl Descent {
    /// Starts at `points`, whose mean edge length is 1. The distance of segments that are not neighbors must be above
    /// `epsilon`, and stays so. `kicks` disturbs the first steps.
    pub(super) fn new(points: &[Vec3], epsilon: f64, kicks: Option<Pcg64>) -> Self {
        let m = points.len();
        Self {
            points: points.to_vec(),
            lengths: (0..m)
                .map(|i| (points[(i + 1) % m] - points[i]).norm())
                .collect(),
            epsilon,
            kicks,
            steps: 0,
            energy: f64::INFINITY,
            forces: vec![Vec3::zeros(); m],
            targets: points.to_vec(),
            clearances: Clearances::default(),
            distances: SegmentDistances::default(),
        }
    }

    /// The present polygon.
    pub(super) fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// Does one step. Returns false if the descent has stalled.
    pub(super) fn step(&mut self) -> bool {
        let energy = self.repel();
        if self.steps.is_multiple_of(STALL_STEPS) {
            if energy > (1.0 - STALL_SHARE) * self.energy {
                return false;
            }
            self.energy = energy;
        }
        self.kick();
        self.steps += 1;
        let m = self.points.len();
        smooth(&mut self.forces, (SMOOTHING_SHARE * m as f64).powi(2));
        let largest = self.forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
        if largest <= f64::MIN_POSITIVE {
            return false;
        }
        for ((target, point), force) in self.targets.iter_mut().zip(&self.points).zip(&self.forces)
        {
            *target = point + force * (STEP / largest);
        }
        self.distances
            .at_vertices(&self.points, REACH, CONTACT, &mut self.clearances);
        for sweep in 0..SWEEPS {
            self.keep_lengths(sweep);
            self.keep_apart();
        }
        self.go();
        true
    }

    /// Computes the forces and returns the energy.
    fn repel(&mut self) -> f64 {
        let points = &self.points;
        let m = points.len();
        let run = (m as f64).sqrt().ceil() as usize;
        let runs: Vec<Run> = points.chunks(run).map(Run::of).collect();
        let mut energy = 0.0;
        for (i, (p, force)) in points.iter().zip(&mut self.forces).enumerate() {
            *force = Vec3::zeros();
            let mut add = |d: Vec3, count: f64| {
                let inverse = d.norm_squared().sqrt().recip();
                energy += count * inverse;
                *force += d * (count * inverse * inverse * inverse);
            };
            for (k, members) in runs.iter().enumerate() {
                let d = p - members.center;
                if d.norm_squared() > members.far_sq {
                    add(d, members.count);
                    continue;
                }
                let first = k * run;
                for (j, q) in points.iter().enumerate().skip(first).take(run) {
                    let apart = i.abs_diff(j);
                    if apart > 1 && apart < m - 1 {
                        add(p - q, 1.0);
                    }
                }
            }
        }
        energy
    }

    /// Adds random vectors to the forces, in the first steps of a disturbed run.
    fn kick(&mut self) {
        let Some(generator) = self.kicks.as_mut().filter(|_| self.steps < KICKED_STEPS) else {
            return;
        };
        let total: f64 = self.forces.iter().map(|f| f.norm()).sum();
        let strength = KICK * total / self.forces.len() as f64;
        for force in &mut self.forces {
            *force += Vec3::from_fn(|_, _| generator.random_range(-strength..=strength));
        }
    }

    /// Moves the targets at the ends of each edge so that the edge gets its length. Sweeps run forward and backward in
    /// turn.
    fn keep_lengths(&mut self, sweep: usize) {
        let m = self.targets.len();
        for k in 0..m {
            let i = if sweep.is_multiple_of(2) {
                k
            } else {
                m - 1 - k
            };
            let j = (i + 1) % m;
            let edge = self.targets[j] - self.targets[i];
            let length = edge.norm();
            if length > f64::MIN_POSITIVE {
                let way = edge * (0.5 * (1.0 - self.lengths[i] / length));
                self.targets[i] += way;
                self.targets[j] -= way;
            }
        }
    }

    /// Moves the targets of near segments apart, along the line between their nearest points before the step.
    fn keep_apart(&mut self) {
        let m = self.targets.len();
        for contact in &self.clearances.contacts {
            let [i, j] = contact.segments;
            let nearest = &contact.nearest;
            let corners = [i, (i + 1) % m, j, (j + 1) % m];
            let weights = [1.0 - nearest.x, nearest.x, nearest.y - 1.0, -nearest.y];
            let away = unit(nearest.way);
            let apart: f64 = corners
                .iter()
                .zip(weights)
                .map(|(&v, weight)| weight * self.targets[v].dot(&away))
                .sum();
            if apart < CONTACT {
                let push = (CONTACT - apart) / weights.iter().map(|w| w * w).sum::<f64>();
                for (&v, weight) in corners.iter().zip(weights) {
                    self.targets[v] += away * (push * weight);
                }
            }
        }
    }

    /// Moves the vertices to their targets, or as far as the distances of segments allow.
    fn go(&mut self) {
        let places = self.points.iter_mut().zip(&self.targets);
        for ((point, target), clearance) in places.zip(&self.clearances.distances) {
            let limit = 0.5 * CLEARANCE_SHARE * (clearance - self.epsilon);
            let way = target - *point;
            let length = way.norm();
            if length <= limit {
                *point = *target;
            } else if limit > 0.0 {
                *point += way * (limit / length);
            }
        }
    }
}

/// Successive vertices that act as one at a large distance.
struct Run {
    center: Vec3,
    count: f64,
    /// Square of that distance.
    far_sq: f64,
}

impl Run {
    fn of(points: &[Vec3]) -> Self {
        let count = points.len() as f64;
        let center = points.iter().sum::<Vec3>() / count;
        let radius_sq = points
            .iter()
            .map(|p| (p - center).norm_squared())
            .fold(0.0, f64::max);
        Self {
            center,
            count,
            // The radius counts as at least 1. So the run of a vertex's neighbors, which do not repel it, is never far.
            far_sq: FAR * FAR * radius_sq.max(1.0),
        }
    }
}

/// Smooths the vectors `f` on the vertices of a cycle: replaces them by the solution of `(1 + strength L) x = f`, where
/// `L` is the graph Laplacian of the cycle. O(m).
fn smooth(f: &mut [Vec3], strength: f64) {
    // The matrix is tridiagonal plus a matrix of rank one for the corners, which the Sherman-Morrison formula treats.
    let m = f.len();
    let (side, middle) = (-strength, 1.0 + 2.0 * strength);
    let corner = -middle;
    let mut cut = vec![0.0; m];
    (cut[0], cut[m - 1]) = (corner, side);
    let diagonal = |i: usize| match i {
        0 => middle - corner,
        _ if i == m - 1 => middle - side * side / corner,
        _ => middle,
    };
    let mut upper = vec![0.0; m];
    let mut pivot = diagonal(0);
    f[0] /= pivot;
    cut[0] /= pivot;
    for i in 1..m {
        upper[i - 1] = side / pivot;
        pivot = diagonal(i) - side * upper[i - 1];
        f[i] = (f[i] - f[i - 1] * side) / pivot;
        cut[i] = (cut[i] - cut[i - 1] * side) / pivot;
    }
    for i in (0..m - 1).rev() {
        let next = f[i + 1];
        f[i] -= next * upper[i];
        cut[i] -= cut[i + 1] * upper[i];
    }
    let ratio = side / corner;
    let part = (f[0] + f[m - 1] * ratio) / (1.0 + cut[0] + cut[m - 1] * ratio);
    for (x, c) in f.iter_mut().zip(&cut) {
        *x -= part * *c;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smoothing_solves_its_equations() {
        for (m, strength) in [(3, 0.5), (4, 100.0), (51, 3.0), (200, 400.0)] {
            let given: Vec<Vec3> = (0..m)
                .map(|i| Vec3::new((i * i % 7) as f64, f64::from(i == 0), -1.0))
                .collect();
            let mut x = given.clone();
            smooth(&mut x, strength);
            for i in 0..m {
                let neighbors = x[(i + 1) % m] + x[(i + m - 1) % m];
                let image = x[i] + (x[i] * 2.0 - neighbors) * strength;
                assert!(
                    (image - given[i]).norm() < 1e-9 * strength.max(1.0),
                    "{m} {i}"
                );
            }
        }
    }

    #[test]
    fn runs_far_away_act_almost_as_their_vertices() {
        let points: Vec<Vec3> = (0..400)
            .map(|i| {
                let t = 0.05 * i as f64;
                Vec3::new(20.0 * t.cos(), 20.0 * t.sin(), 8.0 * (0.7 * t).sin())
            })
            .collect();
        let m = points.len();
        let mut descent = Descent::new(&points, 1e-5, None);
        descent.repel();
        for i in (0..m).step_by(17) {
            let exact: Vec3 = (0..m)
                .filter(|&j| i.abs_diff(j) > 1 && i.abs_diff(j) < m - 1)
                .map(|j| (points[i] - points[j]) / (points[i] - points[j]).norm().powi(3))
                .sum();
            assert!((descent.forces[i] - exact).norm() < 0.1 * exact.norm());
        }
    }
}
