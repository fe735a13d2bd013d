//! Options of the faired methods.

use crate::options::entry::{choice, options};

/// Weights of the Laplacian: cotangents over areas in each case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FairWeights {
    /// Over a third of the triangles' areas, limited so that the equations stay definite.
    Lumped,
    /// Over the areas of Voronoi cells, not limited: those of CGAL, for comparison with it.
    Voronoi,
}

choice!(FairWeights {
    Lumped = "lumped",
    Voronoi = "voronoi"
});

options! {
    /// How the refined patch is faired; see `docs/methods/staircase.md`.
    pub struct FairingOptions {
        /// Areas in the weights of fairing: thirds of the triangles, or Voronoi cells, as CGAL has them
        weights: FairWeights = FairWeights::Lumped, in ();
        /// Most solutions of the fairing equations: fair-c2 takes two; 0 leaves the patch as it was refined
        ///
        /// The second solution has the weights of the shape that the first one gives.
        passes: usize = 2, in 0..=2;
    }
}
