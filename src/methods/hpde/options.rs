//! The options of the method `hpde`.

use crate::methods::sections::options::SectionOptions;
use crate::options::entry::{Choice, choice, options};

/// How the heights of a section's points are found between the two arcs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HpdeSolver {
    /// Differential evolution, as published.
    De,
    /// The start value alone: the two arcs, blended by equation 16.
    Direct,
}

choice!(HpdeSolver {
    De = "de",
    Direct = "direct"
});

/// How differential evolution makes a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeMutation {
    /// A random individual and one difference, equation 2.
    Rand1,
    /// The best individual and one difference, equation 6.
    Best1,
    /// A random individual and two differences, equation 7.
    Rand2,
}

/// How differential evolution mixes a mutant with its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeCrossover {
    /// Binomial: each height is chosen by itself, equation 3.
    Bin,
    /// Exponential: a run of consecutive heights is taken from the mutant.
    Exp,
}

/// A variant of differential evolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeVariant {
    /// How mutants are made.
    pub mutation: DeMutation,
    /// How mutants are mixed with their parents.
    pub crossover: DeCrossover,
}

impl Choice for DeVariant {
    fn all() -> Vec<Self> {
        let of = |crossover| {
            [DeMutation::Rand1, DeMutation::Best1, DeMutation::Rand2].map(|mutation| Self {
                mutation,
                crossover,
            })
        };
        [of(DeCrossover::Bin), of(DeCrossover::Exp)].concat()
    }

    fn name(self) -> &'static str {
        match (self.mutation, self.crossover) {
            (DeMutation::Rand1, DeCrossover::Bin) => "rand/1/bin",
            (DeMutation::Best1, DeCrossover::Bin) => "best/1/bin",
            (DeMutation::Rand2, DeCrossover::Bin) => "rand/2/bin",
            (DeMutation::Rand1, DeCrossover::Exp) => "rand/1/exp",
            (DeMutation::Best1, DeCrossover::Exp) => "best/1/exp",
            (DeMutation::Rand2, DeCrossover::Exp) => "rand/2/exp",
        }
    }
}

/// The published variant.
const PUBLISHED: DeVariant = DeVariant {
    mutation: DeMutation::Rand1,
    crossover: DeCrossover::Bin,
};

options! {
    /// How the points of sections are predicted; `docs/methods/hpde.md` explains the options.
    pub struct HpdeOptions {
        /// Heights of the points: differential evolution, or its start value alone
        solver: HpdeSolver = HpdeSolver::De, in ();
        /// Mutation and crossover of differential evolution
        variant: DeVariant = PUBLISHED, in ();
        /// Individuals of differential evolution per predicted point of a section
        population: usize = 3, in 1..=20;
        /// Weight F of the difference in a mutation
        f: f64 = 0.8, in 0.0..=2.0;
        /// Probability CR of taking a height from the mutant
        cr: f64 = 0.05, in 0.0..=1.0;
        /// Largest number of generations
        generations: usize = 30, in 0..=100_000;
    }
    groups {
        /// How sections are laid through the hole; the methods that predict other curves use these options too.
        "" sections: SectionOptions;
    }
}
