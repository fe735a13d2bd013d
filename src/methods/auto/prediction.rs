//! The part of a hole's report that says how the missing surface was predicted.

use super::surface::candidates::Candidate;
use serde::{Serialize, Serializer};

/// Noise, in rim edge lengths, above which fairing with common curvature amplifies it.
const TOO_NOISY_FOR_CURVATURE: f64 = 0.06;

/// How the missing surface was predicted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// The candidate that was chosen.
    pub chosen: Candidate,
    /// The score of each candidate that was compared; the smallest is best. A score is about the distance between the
    /// candidate and rings of vertices that were left out of its fit, in mean rim edge lengths. `docs/methods/auto.md`
    /// has the formula. Empty when nothing was compared.
    #[serde(serialize_with = "as_map")]
    pub scores: Vec<(Candidate, f64)>,
    /// Standard deviation of the vertices round the hole from smooth surfaces, in mean rim edge lengths.
    pub noise: f64,
    /// Whether the hole was taken for the missing tip of a horn, higher than half a sphere.
    pub is_tip: bool,
    /// Whether the hole was taken for a gap in a flat face. If so, the patch lies in the plane of the rim, and the
    /// scores were not used.
    pub is_flat: bool,
    /// Number of creases in the patch. If there is any, `chosen` was not used.
    #[serde(rename = "creases")]
    pub crease_count: usize,
    /// The surfaces between the creases, in order along the rim.
    pub crease_surfaces: Vec<Candidate>,
    /// Why creases round the hole were not continued; `None` when they were, or when there are none.
    pub without_creases: Option<String>,
}

impl Prediction {
    /// Whether the surroundings are too noisy to read second derivatives from them.
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
