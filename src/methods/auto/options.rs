//! The options of `auto` and `curvature`, the methods that predict the missing surface.

use super::surface::candidates::Candidate;
use super::surface::samples::SampledBand;
use crate::options::entry::{Choice, options};

impl Choice for Candidate {
    fn all() -> Vec<Self> {
        Self::ALL.to_vec()
    }

    fn name(self) -> &'static str {
        Self::name(self)
    }
}

options! {
    /// How the surface is predicted; see `docs/methods/auto.md`.
    ///
    /// The defaults suit every hole; the switches tell what each part contributes.
    pub struct AutoOptions {
        /// The surface that the patch lies on, whatever its score
        ///
        /// `None` chooses by the scores.
        candidate: Option<Candidate> = None, in ("choice", ());
        /// Normals from quadrics fitted to positions, not from triangles
        jets: bool = true, in ();
        /// Planes, spheres, cylinders, cones, tori, quadrics and cyclides compete
        primitives: bool = true, in ();
        /// The interpolating function with the kernel of degree five competes
        quintic: bool = true, in ();
        /// Missing tips of horns are recognized
        tips: bool = true, in ();
        /// Creases of the surroundings are continued across the hole
        creases: bool = true, in ();
    }
}

impl AutoOptions {
    /// Whether a candidate may compete.
    pub(crate) fn allows(&self, candidate: Candidate, samples: &SampledBand<'_>) -> bool {
        candidate.suits(samples)
            && (self.primitives || candidate.interpolates())
            && (self.quintic || candidate != Candidate::Quintic)
    }
}
