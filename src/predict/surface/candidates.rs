//! The surfaces that compete to continue the known one.

use super::hermite_rbf::{HermiteRbf, Kernel};
use super::samples::SampledBand;
use super::{Implicit, Sample};

/// Most samples of an interpolating function: its cost grows with the cube, its accuracy does not grow any more.
const MOST_CENTERS: usize = 140;
/// Rings of samples of an interpolating function of the whole surroundings: two determine position, tangent plane
/// and curvature at the rim, and further ones only cost.
const LAST_CENTER_LEVEL: u32 = 1;
/// Ridge of the function that passes by noisy samples, in coordinates of unit spread.
const RIDGE: f64 = 0.1;

/// A kind of surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Candidate {
    /// Interpolating function with the kernel `r³`.
    Cubic,
    /// The same through smoothed points.
    CubicSmoothed,
    /// The same passing by smoothed points.
    CubicRidge,
    /// Interpolating function with the kernel `r⁵`.
    Quintic,
}

impl Candidate {
    /// The candidates in the order in which they are scored: those that rule others out come first.
    pub(crate) fn list(is_noisy: bool) -> Vec<Self> {
        if is_noisy {
            vec![Self::Cubic, Self::CubicSmoothed, Self::CubicRidge]
        } else {
            vec![Self::Cubic, Self::Quintic]
        }
    }

    /// The name in reports.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Cubic => "rbf3",
            Self::CubicSmoothed => "rbf3-smoothed",
            Self::CubicRidge => "rbf3-ridge",
            Self::Quintic => "rbf5",
        }
    }

    /// Degrees of freedom; for interpolating functions, which have as many as data, numbers that put them last, and
    /// the smoother ones behind.
    pub(crate) fn freedom(self) -> u32 {
        match self {
            Self::Cubic => 30,
            Self::CubicSmoothed => 31,
            Self::CubicRidge => 32,
            Self::Quintic => 40,
        }
    }

    /// Whether it is a radial basis function.
    pub(crate) fn interpolates(self) -> bool {
        self.freedom() >= Self::Cubic.freedom()
    }

    /// Candidates that must score well for this one to be fitted.
    pub(crate) fn gates(self) -> &'static [Self] {
        &[]
    }

    /// Most samples that a fit uses.
    pub(crate) fn most_samples(self) -> usize {
        MOST_CENTERS
    }

    /// Fits the surface to the vertices.
    pub(crate) fn fit(
        self,
        samples: &mut SampledBand,
        vertices: &[u32],
    ) -> Option<Box<dyn Implicit>> {
        let reads_smoothed = samples.is_noisy() && !matches!(self, Self::Cubic | Self::Quintic);
        let chosen: Vec<Sample> = vertices
            .iter()
            .map(|&v| {
                if reads_smoothed {
                    samples.smoothed_sample(v)
                } else {
                    samples.sample(v)
                }
            })
            .collect();
        let rbf = |kernel, ridge| {
            HermiteRbf::fit(&chosen, kernel, ridge).map(|f| Box::new(f) as Box<dyn Implicit>)
        };
        match self {
            Self::Cubic | Self::CubicSmoothed => rbf(Kernel::Cubic, 0.0),
            Self::CubicRidge => rbf(Kernel::Cubic, RIDGE),
            Self::Quintic => rbf(Kernel::Quintic, 0.0),
        }
    }

    /// The surface that continues the surroundings into the hole.
    pub(crate) fn fit_to_rim(self, samples: &mut SampledBand) -> Option<Box<dyn Implicit>> {
        let last = match self {
            Self::Cubic | Self::Quintic => LAST_CENTER_LEVEL,
            _ => super::choice::FITTED_RINGS,
        };
        let vertices = samples.spread(0..last + 1, self.most_samples());
        self.fit(samples, &vertices)
    }
}
