//! The methods. Each one makes a patch from the shape of a hole.
//!
//! A method has a file or folder here and a line in the list below. Its file has a [`MethodSpec`], which is all that
//! the rest of the library knows of the method. `docs/methods/adding.md` shows how to add one.

/// All methods, in the order in which they are listed everywhere, as `module (group, options) { summary Method = SPEC
/// }`.
///
/// Calls the macro `$expand` with the list.
macro_rules! for_each_method {
    ($expand:ident) => {
        $expand! {
            auto ("auto", crate::methods::auto::options::AutoOptions) {
                /// Predict the surface that was there: the best of many candidates, chosen by what is known
                Auto = AUTO,
                /// Continue the surface by a function through the rim's points and normals
                Curvature = CURVATURE,
            }
            flat ("flat", crate::methods::flat::options::FlatOptions) {
                /// Minimum-weight triangulation of the rim, no new vertices
                Flat = FLAT,
            }
            fair ("fair", crate::methods::fair::options::FairingOptions) {
                /// Refine to the rim's density, then a membrane (meets the rim, may crease there)
                Membrane = MEMBRANE,
                /// Refine, then fair with a common tangent plane along the rim
                FairC1 = FAIR_C1,
                /// Refine, then fair with common curvature along the rim
                FairC2 = FAIR_C2,
            }
            hpde ("hpde", crate::methods::hpde::options::HpdeOptions) {
                /// Sections between facing points of the rim, by differential evolution
                Hpde = HPDE,
            }
            grey ("grey", crate::methods::grey::options::GreyOptions) {
                /// Sections continued from both sides by grey prediction
                Grey = GREY,
            }
            nurbs ("nurbs", crate::methods::nurbs::options::NurbsOptions) {
                /// Sections by splines through layers of known points
                Nurbs = NURBS,
            }
            unfold ("unfold", crate::methods::unfold::options::UnfoldOptions) {
                /// Unfold the rim to the plane, triangulate there; refined, of least area
                UnfoldArea = UNFOLD_AREA,
                /// Unfold the rim to the plane, triangulate there; refined and faired
                UnfoldFairing = UNFOLD_FAIRING,
            }
            mls ("mls", crate::methods::mls::options::MlsOptions) {
                /// Fit heights round the hole by moving least squares, and resample them
                Mls = MLS,
            }
            centroid {
                /// Join every rim edge to one new vertex in the middle of the rim
                Centroid = CENTROID,
            }
        }
    };
}

pub(crate) mod auto;
mod centroid;
pub(crate) mod fair;
pub(crate) mod flat;
pub(crate) mod grey;
pub(crate) mod hpde;
pub(crate) mod method;
pub(crate) mod mls;
pub(crate) mod nurbs;
mod sections;
pub(crate) mod spec;
mod start;
pub(crate) mod task;
pub(crate) mod unfold;

pub use auto::options::AutoOptions;
pub use auto::prediction::Prediction;
pub use auto::surface::candidates::Candidate;
pub use fair::options::{FairWeights, FairingOptions};
pub use flat::options::FlatOptions;
pub use grey::options::GreyOptions;
pub use hpde::options::{DeCrossover, DeMutation, DeVariant, HpdeOptions, HpdeSolver};
pub use hpde::section_curve::{SectionCurve, evolve_section};
pub use method::{Method, MethodOptions};
pub use mls::options::{MlsDomain, MlsOptions, MlsUnit};
pub use nurbs::options::NurbsOptions;
pub use sections::options::{SectionOptions, SectionProjection, SectionTangents};
pub use unfold::curve::{Unfolding, unfold_curve};
pub use unfold::options::{UnfoldOptions, UnfoldSolver};

use spec::MethodSpec;

macro_rules! specs {
    ($($family:ident $(($prefix:literal, $options:path))? {
        $($(#[doc = $summary:literal])* $Method:ident = $spec:ident,)*
    })*) => {
        impl Method {
            /// What the library knows of the method.
            pub(crate) fn spec(self) -> &'static MethodSpec {
                match self {
                    $($(Self::$Method => &$family::$spec,)*)*
                }
            }
        }
    };
}
for_each_method!(specs);

impl Method {
    /// The name used on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.spec().name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_different_and_are_read_back() {
        for method in Method::ALL {
            assert_eq!(method.name().parse::<Method>().unwrap(), method);
            assert!(!method.summary().is_empty());
        }
    }

    #[test]
    fn every_chain_of_fallbacks_ends_with_a_method_that_needs_none() {
        for method in Method::ALL {
            let falls_back_to = method.spec().falls_back_to;
            assert!(!falls_back_to.contains(&method), "{method}");
            let last = falls_back_to.last().copied().unwrap_or(method);
            assert!(last.spec().falls_back_to.is_empty(), "{method}: {last}");
        }
    }
}
