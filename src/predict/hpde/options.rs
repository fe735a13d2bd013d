//! What users can choose about HPDE.

/// Where the tangents of the two arcs come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HpdeTangents {
    /// The section plane cut with the triangle at the base point, as published.
    Chord,
    /// The section plane cut with the tangent plane of a quadric fitted to the surroundings.
    Jet,
}

/// How the heights of a section's points are found between the two arcs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HpdeSolver {
    /// Differential evolution, as published.
    De,
    /// The start value alone: the arcs blended by equation 16.
    Direct,
}

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
    /// Each coordinate by itself, equation 3.
    Bin,
    /// A run of consecutive coordinates.
    Exp,
}

/// In what plane the predicted points are triangulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HpdeProjection {
    /// The published planes; where they fold the patch, the sections laid side by side.
    Auto,
    /// One plane, or two that are unfolded, as published.
    Planes,
    /// The sections laid side by side.
    Sections,
}

/// Options of [`Method::Hpde`](crate::Method::Hpde); `docs/methods/hpde.md` explains them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct HpdeOptions {
    /// Where tangents come from; default [`HpdeTangents::Jet`].
    pub tangents: HpdeTangents,
    /// How heights are found; default [`HpdeSolver::De`].
    pub solver: HpdeSolver,
    /// Mutation of differential evolution; default [`DeMutation::Rand1`].
    pub mutation: DeMutation,
    /// Crossover of differential evolution; default [`DeCrossover::Bin`].
    pub crossover: DeCrossover,
    /// Individuals per variable; default 3.
    pub population: usize,
    /// Weight of a difference, `F`; default 0.8.
    pub f: f64,
    /// Probability of taking a coordinate from the mutant, `CR`; default 0.05.
    pub cr: f64,
    /// Largest number of generations; default 30.
    pub generations: usize,
    /// Distance between base points over the mean edge length of the surroundings; default 0.8.
    pub base_spacing: f64,
    /// Distance between predicted points of a section over the same; default 1.
    pub point_spacing: f64,
    /// Dihedral angle in degrees below which the base points are cut into two parts, `A_c`; default 110.
    pub segment_angle: f64,
    /// Smallest angle in degrees between a section and the rim, `I_c`; default 12.
    pub skip_angle: f64,
    /// The plane in which points are triangulated; default [`HpdeProjection::Auto`].
    pub projection: HpdeProjection,
    /// Whether the patch is smoothed; default true.
    pub smoothing: bool,
    /// Steps of smoothing, `NumSmooth`; default 60.
    pub smoothing_steps: usize,
    /// Edges shorter than this part of the mean edge length of the surroundings are collapsed; default 0.6.
    pub shortest_edge: f64,
    /// Steps of smoothing that the surroundings get before anything is read from them; default 0.
    pub denoise: usize,
}

impl Default for HpdeOptions {
    fn default() -> Self {
        Self {
            tangents: HpdeTangents::Jet,
            solver: HpdeSolver::De,
            mutation: DeMutation::Rand1,
            crossover: DeCrossover::Bin,
            population: 3,
            f: 0.8,
            cr: 0.05,
            generations: 30,
            base_spacing: 0.8,
            point_spacing: 1.0,
            segment_angle: 110.0,
            skip_angle: 12.0,
            projection: HpdeProjection::Auto,
            smoothing: true,
            smoothing_steps: 60,
            shortest_edge: 0.6,
            denoise: 0,
        }
    }
}
