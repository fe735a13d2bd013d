//! How the attributes of the new vertices are made.

use super::parameter::{Parameter, number};

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
    /// Moving least squares over the hole's reference domain, by the parameters of the method `mls`.
    Mls,
}

impl Interpolator {
    const ALL: [Self; 6] = [
        Self::Auto,
        Self::Rbf,
        Self::Biharmonic,
        Self::Harmonic,
        Self::Nearest,
        Self::Mls,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Rbf => "rbf",
            Self::Biharmonic => "biharmonic",
            Self::Harmonic => "harmonic",
            Self::Nearest => "nearest",
            Self::Mls => "mls",
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

/// How the attributes of the new vertices are made.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct AttributeOptions {
    /// How values are interpolated; default [`Interpolator::Auto`].
    pub interpolator: Interpolator,
    /// Which attributes are interpolated; default [`FilledAttributes::Smooth`].
    pub filled: FilledAttributes,
    /// Most places round a hole that [`Interpolator::Rbf`] passes through; default 400. The time grows with
    /// its cube, whatever the size of the hole.
    pub centers: usize,
}

impl Default for AttributeOptions {
    fn default() -> Self {
        Self {
            interpolator: Interpolator::Auto,
            filled: FilledAttributes::Smooth,
            centers: 400,
        }
    }
}

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "attributes.interpolator",
        help: "how colors and other numbers are carried into a patch",
        allowed: "auto, rbf, biharmonic, harmonic, nearest or mls",
        get: |o| o.attributes.interpolator.name().to_owned(),
        set: |o, v| {
            let known = Interpolator::ALL.into_iter().find(|i| i.name() == v)?;
            o.attributes.interpolator = known;
            Some(())
        },
    },
    Parameter {
        name: "attributes.filled",
        help: "vertex attributes that are interpolated; the others are copied from the nearest vertex",
        allowed: "auto (what varies smoothly), none, or names with commas between them",
        get: |o| match &o.attributes.filled {
            FilledAttributes::Smooth => "auto".to_owned(),
            FilledAttributes::Only(names) if names.is_empty() => "none".to_owned(),
            FilledAttributes::Only(names) => names.join(","),
        },
        set: |o, v| {
            o.attributes.filled = match v {
                "auto" => FilledAttributes::Smooth,
                "none" => FilledAttributes::Only(Vec::new()),
                _ => {
                    let names: Vec<String> = v.split(',').map(|n| n.trim().to_owned()).collect();
                    if names.iter().any(String::is_empty) {
                        return None;
                    }
                    FilledAttributes::Only(names)
                }
            };
            Some(())
        },
    },
    Parameter {
        name: "attributes.centers",
        help: "most places round a hole that the interpolator rbf passes through",
        allowed: "an integer from 4 to 2000",
        get: |o| o.attributes.centers.to_string(),
        set: |o, v| number(v, 4, 2000).map(|v| o.attributes.centers = v),
    },
];
