//! How a missing surface was predicted: what the report says of it.

use super::surface::candidates::Candidate;
use serde::{Serialize, Serializer};

/// Noise above which fairing with common curvature amplifies it.
const TOO_NOISY_FOR_CURVATURE: f64 = 0.06;

/// How the missing surface was predicted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// The candidate that was chosen.
    pub chosen: Candidate,
    /// The score of each candidate that was compared, which is about the distance in mean rim edges at which it misses
    /// rings round the hole that it has not seen; the smallest is best. See `docs/methods/auto.md` for what enters it.
    /// Empty when nothing was compared.
    #[serde(serialize_with = "as_map")]
    pub scores: Vec<(Candidate, f64)>,
    /// Standard deviation of the surroundings' vertices from smooth surfaces, in rim edge lengths.
    pub noise: f64,
    /// Whether the hole was taken for the missing tip of a horn, higher than half a sphere.
    pub is_tip: bool,
    /// Whether the hole was taken for a gap in a flat face: then the patch lies in the plane of the rim, whatever the
    /// scores say.
    pub is_flat: bool,
    /// Number of creases in the patch; when there are any, `chosen` was not used.
    #[serde(rename = "creases")]
    pub crease_count: usize,
    /// The surfaces between the creases, in the order in which the rim meets them.
    pub crease_surfaces: Vec<Candidate>,
    /// Why creases of the surroundings were not continued; `None` when they were, or when there are none.
    pub without_creases: Option<String>,
}

impl Prediction {
    /// Whether the surroundings are too noisy for second derivatives.
    pub(crate) fn is_noisy(&self) -> bool {
        self.noise > TOO_NOISY_FOR_CURVATURE
    }
}

impl Serialize for Candidate {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

fn as_map<S: Serializer>(scores: &[(Candidate, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(scores.iter().copied())
}
