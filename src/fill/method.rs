//! The names of the fill methods.

use crate::error::{Error, ErrorKind};
use std::fmt;
use std::str::FromStr;

/// A way to fill a hole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Method {
    /// Predicts the surface that was there: the surface that continues the surroundings best, chosen among
    /// primitives and interpolating functions by predicting what is known.
    #[default]
    Auto,
    /// The same with one interpolating function and no choice.
    Curvature,
    /// Minimum-weight triangulation of the rim, without new vertices.
    Flat,
    /// Refined to the rim's density, then a membrane: continuous with the surroundings.
    Membrane,
    /// Refined, then faired to meet the surroundings with a common tangent plane.
    FairC1,
    /// Refined, then faired to meet the surroundings with common curvature.
    FairC2,
    /// Sections between facing points of the rim, by differential evolution (Xie & Zou 2013).
    Hpde,
    /// Sections continued from both sides by grey prediction (Wang & Hung 2012).
    Grey,
    /// Sections by splines through layers of known points (Kumar et al. 2011).
    Nurbs,
    /// The rim unfolded to the plane and triangulated there; refined, of least area.
    UnfoldArea,
    /// The rim unfolded to the plane and triangulated there; refined, faired by the second-order umbrella.
    UnfoldFairing,
    /// A height field fitted to the points round the hole by moving least squares, and resampled.
    Mls,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 12] = [
        Self::Auto,
        Self::Curvature,
        Self::Flat,
        Self::Membrane,
        Self::FairC1,
        Self::FairC2,
        Self::Hpde,
        Self::Grey,
        Self::Nurbs,
        Self::UnfoldArea,
        Self::UnfoldFairing,
        Self::Mls,
    ];

    /// The name used on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Curvature => "curvature",
            Self::Flat => "flat",
            Self::Membrane => "membrane",
            Self::FairC1 => "fair-c1",
            Self::FairC2 => "fair-c2",
            Self::Hpde => "hpde",
            Self::Grey => "grey",
            Self::Nurbs => "nurbs",
            Self::UnfoldArea => "unfold-area",
            Self::UnfoldFairing => "unfold-fairing",
            Self::Mls => "mls",
        }
    }

    /// Whether the method unfolds the rim, and so works only where the rim bounds a disk that nothing pierces.
    pub(crate) fn unfolds(self) -> bool {
        matches!(self, Self::UnfoldArea | Self::UnfoldFairing)
    }

    /// What the method does, in one line.
    #[must_use]
    pub fn summary(self) -> &'static str {
        match self {
            Self::Auto => {
                "predict the surface that was there: the best of many candidates, chosen by what is known"
            }
            Self::Curvature => {
                "continue the surface by a function through the rim's points and normals"
            }
            Self::Flat => "minimum-weight triangulation of the rim, no new vertices",
            Self::Membrane => {
                "refine to the rim's density, then a membrane (meets the rim, may crease there)"
            }
            Self::FairC1 => "refine, then fair with a common tangent plane along the rim",
            Self::FairC2 => "refine, then fair with common curvature along the rim",
            Self::Hpde => "sections between facing points of the rim, by differential evolution",
            Self::Grey => "sections continued from both sides by grey prediction",
            Self::Nurbs => "sections by splines through layers of known points",
            Self::UnfoldArea => {
                "unfold the rim to the plane, triangulate there; refined, of least area"
            }
            Self::UnfoldFairing => {
                "unfold the rim to the plane, triangulate there; refined and faired"
            }
            Self::Mls => "fit heights round the hole by moving least squares, and resample them",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Method {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        Self::ALL
            .into_iter()
            .find(|m| m.name() == name)
            .ok_or_else(|| {
                let names: Vec<&str> = Self::ALL.iter().map(|m| m.name()).collect();
                Error::new(
                    ErrorKind::InvalidInput,
                    format!(
                        "unknown method '{name}'; the methods are {}",
                        names.join(", ")
                    ),
                )
            })
    }
}
