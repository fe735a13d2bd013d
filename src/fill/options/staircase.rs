//! Parameters of the staircase methods and of refinement.

use super::parameter::{Parameter, number};

/// How the refined patch of the methods `membrane`, `fair-c1` and `fair-c2` is faired; see `docs/methods/staircase.md`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FairingOptions {
    /// Weights of the Laplacian; default [`FairWeights::Lumped`].
    pub weights: FairWeights,
    /// Most solutions of the equations, each with the weights of the shape before it; default 2. Only
    /// [`Method::FairC2`](crate::Method::FairC2) takes two, the first for the tangent planes. 0 leaves the patch as it
    /// was refined.
    pub passes: usize,
}

impl Default for FairingOptions {
    fn default() -> Self {
        Self {
            weights: FairWeights::Lumped,
            passes: 2,
        }
    }
}

/// Weights of the Laplacian: cotangents over areas in each case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FairWeights {
    /// Over a third of the triangles' areas, limited so that the equations stay definite.
    Lumped,
    /// Over the areas of Voronoi cells, not limited: those of CGAL, for comparison with it.
    Voronoi,
}

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "flat.exact-limit",
        help: "largest rim, in edges, searched exhaustively; the cost grows with its cube",
        allowed: "an integer from 3 to 2048",
        get: |o| o.exact_limit.to_string(),
        set: |o, v| number(v, 3, 2048).map(|v| o.exact_limit = v),
    },
    Parameter {
        name: "refine.density",
        help: "target edge length of new triangles over that of the rim",
        allowed: "a number from 0.1 to 100",
        get: |o| o.density.to_string(),
        set: |o, v| number(v, 0.1, 100.0).map(|v| o.density = v),
    },
    Parameter {
        name: "refine.grading",
        help: "growth of the target edge length per unit of distance from the rim",
        allowed: "auto, or a number from 0 to 1",
        get: |o| {
            o.grading
                .map_or_else(|| "auto".to_owned(), |g| g.to_string())
        },
        set: |o, v| {
            o.grading = if v == "auto" {
                None
            } else {
                Some(number(v, 0.0, 1.0)?)
            };
            Some(())
        },
    },
    Parameter {
        name: "refine.max-vertices",
        help: "largest number of new vertices in one hole",
        allowed: "an integer from 0 to 1000000000",
        get: |o| o.max_new_vertices.to_string(),
        set: |o, v| number(v, 0, 1_000_000_000).map(|v| o.max_new_vertices = v),
    },
    Parameter {
        name: "fair.weights",
        help: "areas in the weights of fairing: thirds of the triangles, or Voronoi cells, as CGAL has them",
        allowed: "lumped or voronoi",
        get: |o| {
            match o.fairing.weights {
                FairWeights::Lumped => "lumped",
                FairWeights::Voronoi => "voronoi",
            }
            .to_owned()
        },
        set: |o, v| {
            o.fairing.weights = match v {
                "lumped" => FairWeights::Lumped,
                "voronoi" => FairWeights::Voronoi,
                _ => return None,
            };
            Some(())
        },
    },
    Parameter {
        name: "fair.passes",
        help: "most solutions of the fairing equations: fair-c2 takes two; 0 leaves the patch as it was refined",
        allowed: "an integer from 0 to 2",
        get: |o| o.fairing.passes.to_string(),
        set: |o, v| number(v, 0, 2).map(|v| o.fairing.passes = v),
    },
];
