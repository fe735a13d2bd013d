//! The triangulation of least weight, without new vertices.
//!
//! Based on: G. Barequet, M. Sharir, "Filling gaps in the boundary of a polyhedron", CAGD 12(2), 1995.

pub(crate) mod options;

use super::spec::MethodSpec;
use super::start::triangulated;

/// The method.
pub(super) const FLAT: MethodSpec = MethodSpec {
    name: "flat",
    make: |task| triangulated(task, task.options.methods.flat.exact_limit, EAR_REMAINDER),
    ..MethodSpec::USUAL
};

/// Polygon vertices that ear clipping leaves to the exhaustive search.
const EAR_REMAINDER: usize = 64;
