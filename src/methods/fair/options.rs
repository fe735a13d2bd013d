//! The options of the faired methods.

use crate::options::entry::{choice, options};

/// The weights of the Laplacian. They are cotangents divided by the area of a vertex, which is defined in two ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FairWeights {
    /// A third of the area of the triangles round the vertex. Weights are limited, so that the equations stay definite.
    Lumped,
    /// The area of the Voronoi cell, as in CGAL, for comparison with it. Weights are not limited.
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
