//! The options of the unfolding.

use crate::options::entry::{choice, options};

/// How a curve is unfolded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnfoldSolver {
    /// The vertices repel each other, and the edges keep their lengths. The curve is projected to a plane before the
    /// first step and after each step, until the projection is simple.
    #[default]
    Descent,
    /// Simulated annealing of the planarity of successive vertices, as published. The curve is projected after each
    /// run.
    Annealing,
}

choice!(UnfoldSolver {
    Descent = "descent",
    Annealing = "annealing"
});

options! {
    /// How to unfold a curve. Lengths are in mean edge lengths of the curve.
    pub struct UnfoldOptions {
        /// What unfolds the rim
        solver: UnfoldSolver = UnfoldSolver::Descent, in ();
        /// Runs after which the rim counts as not unfolded; auto is 100 for annealing, 4 for descent
        restarts: Option<usize> = None, in ("auto", 1..=10_000);
        /// Most steps of a run
        steps: usize = 5000, in 1..=1_000_000;
        /// Start temperature T of the annealing, in radians of its energy
        temperature: f64 = 0.5, in 1e-6..=1e3;
        /// Rate of cooling k of the annealing
        k: f64 = 0.9, in 0.1..=0.999;
        /// Least distance of the rim from itself on the way, in mean rim edges
        epsilon: f64 = 1e-5, in 1e-9..=0.1;
        /// Degrees by which the annealing turns a direction that lowered the energy
        cone: f64 = 10.0, in 0.0..=180.0;
    }
}
