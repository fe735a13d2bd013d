//! The method `flat`: the minimum-weight triangulation of the rim, without new vertices.
//!
//! Large rims are reduced by ear clipping first; the rest is searched exhaustively. Source: G. Barequet, M. Sharir,
//! "Filling gaps in the boundary of a polyhedron", CAGD 12(2), 1995. Cost: cubic in the number of vertices that are
//! searched exhaustively.

pub(crate) mod options;

use super::spec::MethodSpec;
use super::start::triangulated;

/// The method.
pub(super) const FLAT: MethodSpec = MethodSpec {
    name: "flat",
    make: |task| triangulated(task, task.options.methods.flat.exact_limit, EAR_REMAINDER),
    ..MethodSpec::USUAL
};

/// Number of rim vertices that ear clipping leaves to the exhaustive search.
const EAR_REMAINDER: usize = 64;
