//! The options for the attributes of new vertices.

use super::entry::{Choice, Value, options};
use crate::methods::method::Method;

/// How values that vary over the surface are carried into a patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Interpolator {
    /// [`Interpolator::Mls`] for the method of that name, else [`Interpolator::Rbf`].
    #[default]
    Auto,
    /// Radial basis functions `r³` with a linear part, through values round the hole.
    Rbf,
    /// The thin-plate surface over the patch: goes on with the slope round the rim.
    Biharmonic,
    /// The membrane over the patch: stays in the range of the rim.
    Harmonic,
    /// A copy of the nearest rim vertex's value.
    Nearest,
    /// Moving least squares over the hole's reference domain, by the options of [`Method::Mls`].
    Mls,
}

impl Choice for Interpolator {
    fn all() -> Vec<Self> {
        vec![
            Self::Auto,
            Self::Rbf,
            Self::Biharmonic,
            Self::Harmonic,
            Self::Nearest,
            Self::Mls,
        ]
    }

    fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Rbf => "rbf",
            Self::Biharmonic => "biharmonic",
            Self::Harmonic => "harmonic",
            Self::Nearest => "nearest",
            Self::Mls => Method::Mls.name(),
        }
    }
}

/// Which vertex attributes are interpolated; the others are copied from the nearest rim vertex.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum FilledAttributes {
    /// Every number that varies over a surface: floating-point ones, and integers whose name is not that of a
    /// label, an id or the like. Normals become those of the patch.
    #[default]
    Smooth,
    /// Those of these names, whatever they are.
    Only(Vec<String>),
}

impl FilledAttributes {
    /// Whether a column of this name may be computed.
    pub(crate) fn may_fill(&self, name: &str) -> bool {
        match self {
            Self::Smooth => true,
            Self::Only(names) => names.iter().any(|n| n == name),
        }
    }
}

impl Value for FilledAttributes {
    type Limits = ();

    fn read(text: &str, (): &()) -> Option<Self> {
        match text {
            "auto" => Some(Self::Smooth),
            "none" => Some(Self::Only(Vec::new())),
            _ => {
                let names: Vec<String> = text.split(',').map(|n| n.trim().to_owned()).collect();
                names
                    .iter()
                    .all(|name| !name.is_empty())
                    .then_some(Self::Only(names))
            }
        }
    }

    fn write(&self, (): &()) -> String {
        match self {
            Self::Smooth => "auto".to_owned(),
            Self::Only(names) if names.is_empty() => "none".to_owned(),
            Self::Only(names) => names.join(","),
        }
    }

    fn is_within(&self, (): &()) -> bool {
        true
    }

    fn allowed((): &()) -> String {
        "auto (what varies smoothly), none, or names with commas between them".to_owned()
    }
}

options! {
    /// How the attributes of the new vertices are made.
    pub struct AttributeOptions {
        /// How colors and other numbers are carried into a patch
        interpolator: Interpolator = Interpolator::Auto, in ();
        /// Vertex attributes that are interpolated; the others are copied from the nearest vertex
        filled: FilledAttributes = FilledAttributes::Smooth, in ();
        /// Most places round a hole that the interpolator rbf passes through
        ///
        /// The time grows with its cube, whatever the size of the hole.
        centers: usize = 400, in 4..=2000;
    }
}
