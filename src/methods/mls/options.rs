//! The options of the method `mls`.

use crate::options::entry::{choice, options};

/// The surface over which [`Mls`](crate::Method::Mls) measures heights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum MlsDomain {
    /// The plane, if the vicinity projects to it one-to-one and at less than 45 degrees on average. Otherwise the
    /// sphere, if there is one.
    #[default]
    Auto,
    /// The reference plane of the paper.
    Plane,
    /// The sphere fitted to the vicinity; the plane, if the vicinity is nearly flat.
    Curved,
}

/// The unit of the distances in the weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum MlsUnit {
    /// The sampling step.
    #[default]
    Step,
    /// A quarter of the mean distance of the rim from its centroid.
    Radius,
}

choice!(MlsDomain {
    Auto = "auto",
    Plane = "plane",
    Curved = "curved"
});

choice!(MlsUnit {
    Step = "step",
    Radius = "radius"
});

options! {
    /// How heights are fitted and resampled.
    pub struct MlsOptions {
        /// α of the weights exp(-α d²)/d², with d in the unit mls.unit
        alpha: f64 = 0.0625, in 0.0..=1e3;
        /// Width of the vicinity, in sampling steps
        beta: f64 = 3.75, in 0.5..=100.0;
        /// Degree of the polynomials
        degree: usize = 2, in 0..=3;
        /// Surface over which heights are taken; auto is the plane where that is one-to-one
        domain: MlsDomain = MlsDomain::Auto, in ();
        /// Unit of the distances in the weights: the sampling step, or a quarter of the hole's radius
        unit: MlsUnit = MlsUnit::Step, in ();
    }
}
