//! The candidate surfaces: their names, their complexity, which surroundings they suit, and how they are fitted.
//!
//! How each kind is fitted stands in `algebraic`, `primitives` and `hermite_rbf`. `choice` chooses among them.

use super::algebraic::{AlgebraicSurface, Kind};
use super::frame::Fit;
use super::hermite_rbf::{HermiteRbf, Kernel};
use super::primitives::{cone::Cone, cylinder::Cylinder, torus::Torus};
use super::samples::SampledBand;
use super::{FITTED_RINGS, Implicit, Sample};
use crate::error::Result;

/// Upper bounds on the number of samples of a fit.
#[derive(Clone, Copy)]
struct SampleLimits {
    /// While candidates are compared.
    scored: usize,
    /// For the final fit.
    used: usize,
}

/// For interpolating functions. The cost grows with the cube of the number; the accuracy hardly changes.
const INTERPOLATING_LIMITS: SampleLimits = SampleLimits {
    scored: 80,
    used: 140,
};
/// For surfaces that are fitted by iteration. Each step reads all samples.
const ITERATED_LIMITS: SampleLimits = SampleLimits {
    scored: 60,
    used: 100,
};
/// For algebraic surfaces. One decomposition solves the fit.
const ALGEBRAIC_LIMITS: SampleLimits = SampleLimits {
    scored: 150,
    used: 300,
};
/// The last ring of vertices that the final fit of an interpolating function reads. The rings 0 and 1 determine
/// position, tangent plane and curvature at the rim; further rings only cost time.
const LAST_CENTER_LEVEL: u32 = 1;
/// Ridge of [`Candidate::CubicRidge`], in coordinates in which the samples have unit spread.
const RIDGE: f64 = 0.1;

/// A kind of surface that may continue the surroundings of a hole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Candidate {
    /// Plane.
    Plane,
    /// Sphere.
    Sphere,
    /// Circular cylinder.
    Cylinder,
    /// Circular cone.
    Cone,
    /// Torus.
    Torus,
    /// Any surface of degree two: ellipsoids, paraboloids, hyperboloids, cylinders, cones.
    Quadric,
    /// Darboux cyclide; quadrics and tori are special cases.
    Cyclide,
    /// Interpolating function with the kernel `r³`.
    Cubic,
    /// `Cubic` through smoothed points.
    CubicSmoothed,
    /// `CubicSmoothed` with a ridge: it approximates the smoothed points.
    CubicRidge,
    /// Interpolating function with the kernel `r⁵`.
    Quintic,
}

impl Candidate {
    /// All candidates, in the order in which they are scored. A gate (`Candidate::gate`) comes before the candidates
    /// that need it, and the cubic kernels before the quintic one, which is compared with them.
    pub const ALL: [Self; 11] = [
        Self::Quadric,
        Self::Plane,
        Self::Sphere,
        Self::Cyclide,
        Self::Cubic,
        Self::CubicSmoothed,
        Self::CubicRidge,
        Self::Quintic,
        Self::Cylinder,
        Self::Cone,
        Self::Torus,
    ];

    /// The name in reports and options.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Sphere => "sphere",
            Self::Cylinder => "cylinder",
            Self::Cone => "cone",
            Self::Torus => "torus",
            Self::Quadric => "quadric",
            Self::Cyclide => "cyclide",
            Self::Cubic => "rbf3",
            Self::CubicSmoothed => "rbf3-smoothed",
            Self::CubicRidge => "rbf3-ridge",
            Self::Quintic => "rbf5",
        }
    }

    /// Degrees of freedom. Interpolating functions have as many as data; they get numbers that only put them in order,
    /// after all others, with the more robust ones first.
    pub(crate) fn freedom(self) -> u32 {
        match self {
            Self::Plane => 3,
            Self::Sphere => 4,
            Self::Cylinder => 5,
            Self::Cone => 6,
            Self::Torus => 7,
            Self::Quadric => 9,
            Self::Cyclide => 13,
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

    /// Whether the candidate may compete on surroundings with this noise and detail.
    pub(crate) fn suits(self, samples: &SampledBand) -> bool {
        match self {
            Self::Cubic => !samples.is_detail_misleading(),
            Self::CubicSmoothed => samples.is_noisy() || samples.is_detail_misleading(),
            Self::CubicRidge => samples.is_noisy(),
            Self::Quintic => !samples.is_noisy(),
            _ => true,
        }
    }

    /// A cheaper candidate that contains or approximates this one. This one is tried only if its gate scores well.
    pub(crate) fn gate(self) -> Option<Self> {
        match self {
            Self::Plane | Self::Sphere | Self::Cylinder | Self::Cone => Some(Self::Quadric),
            Self::Torus => Some(Self::Cyclide),
            _ => None,
        }
    }

    fn sample_limits(self) -> SampleLimits {
        match self {
            Self::Cylinder | Self::Cone | Self::Torus => ITERATED_LIMITS,
            _ if self.interpolates() => INTERPOLATING_LIMITS,
            _ => ALGEBRAIC_LIMITS,
        }
    }

    /// Upper bound on the samples of a fit that is scored.
    pub(crate) fn most_scored(self) -> usize {
        self.sample_limits().scored
    }

    /// Fits the surface to the vertices, for scoring. If the surroundings are noisy, all candidates but `Cubic` and
    /// `Quintic` read smoothed points.
    pub(crate) fn fit(
        self,
        samples: &mut SampledBand,
        vertices: &[u32],
    ) -> Result<Option<Box<dyn Implicit>>> {
        let reads_smoothed = samples.is_noisy() && !matches!(self, Self::Cubic | Self::Quintic);
        let rings = reads_smoothed.then(|| samples.rings_over_noise());
        self.fit_to(samples, vertices, rings)
    }

    /// Fits the surface to the vertices. `rings` is the number of rings of neighbors to smooth over; `None` reads the
    /// vertices as they are.
    fn fit_to(
        self,
        samples: &mut SampledBand,
        vertices: &[u32],
        rings: Option<usize>,
    ) -> Result<Option<Box<dyn Implicit>>> {
        let mut chosen = Vec::with_capacity(vertices.len());
        for &v in vertices {
            samples.job.tick(300)?;
            chosen.push(match rings {
                Some(rings) => samples.smoothed_sample(v, rings),
                None => samples.sample(v),
            });
        }
        Ok(self.fit_samples(&chosen))
    }

    /// Fits the surface to the samples.
    pub(crate) fn fit_samples(self, samples: &[Sample]) -> Option<Box<dyn Implicit>> {
        let algebraic = |kind| boxed(AlgebraicSurface::fit(kind, samples));
        let rbf = |kernel, ridge| {
            HermiteRbf::fit(samples, kernel, ridge).map(|f| Box::new(f) as Box<dyn Implicit>)
        };
        match self {
            Self::Plane => algebraic(Kind::Plane),
            Self::Sphere => algebraic(Kind::Sphere),
            Self::Quadric => algebraic(Kind::Quadric),
            Self::Cyclide => algebraic(Kind::Cyclide),
            Self::Cylinder => boxed(Cylinder::fit(samples)),
            Self::Cone => boxed(Cone::fit(samples)),
            Self::Torus => boxed(Torus::fit(samples)),
            Self::Cubic | Self::CubicSmoothed => rbf(Kernel::Cubic, 0.0),
            Self::CubicRidge => rbf(Kernel::Cubic, RIDGE),
            Self::Quintic => rbf(Kernel::Quintic, 0.0),
        }
    }

    /// The final fit, which continues the surroundings into the hole. `None` when the samples determine no surface.
    pub(crate) fn fit_to_rim(self, samples: &mut SampledBand) -> Result<Option<Box<dyn Implicit>>> {
        let last = match self {
            Self::Cubic | Self::Quintic => LAST_CENTER_LEVEL,
            _ => FITTED_RINGS,
        };
        let vertices = samples.spread(0..last + 1, self.sample_limits().used)?;
        let over_noise = samples.is_noisy().then(|| samples.rings_over_noise());
        let rings = match self {
            Self::Cubic | Self::Quintic => None,
            Self::CubicSmoothed => samples
                .rings_over_detail()
                .or(Some(samples.rings_over_noise())),
            _ => over_noise,
        };
        self.fit_to(samples, &vertices, rings)
    }
}

fn boxed<S: Implicit + 'static>(fit: Option<Fit<S>>) -> Option<Box<dyn Implicit>> {
    fit.map(|f| Box::new(f.surface) as Box<dyn Implicit>)
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::rings_around;
    use super::super::project;
    use super::*;
    use crate::job::UNLIMITED;
    use crate::math::Vec3;
    use crate::surroundings::fits::QuadricFits;

    /// The surroundings of a round hole in a paraboloid, with ripples of height `ripple`, five edges long. At the rim
    /// the paraboloid has risen by a twentieth of the hole's width. All is scaled by `flatness` along one axis.
    fn rippled(around: u32, ripple: f64, phase: f64, flatness: f64) -> SampledBand<'static> {
        let radius = f64::from(around) / 6.0;
        let mut shape = rings_around(around, |x, y| {
            let rise = 0.1 / radius * (x * x + y * y);
            rise + ripple * ((1.2 * x + phase).sin() * (1.1 * y - phase).sin())
        });
        let mut points = shape.surroundings.points().to_vec();
        points.iter_mut().for_each(|p| p.y *= flatness);
        shape.surroundings = shape.surroundings.moved(points);
        let shape = Box::leak(Box::new(shape));
        let fits = QuadricFits::new(&shape.surroundings, &UNLIMITED).unwrap();
        SampledBand::new(fits, shape, 1.0, true, &UNLIMITED)
    }

    /// How far off the surface is in the middle, over eight phases of the ripples.
    fn off_at_middle(candidate: Candidate, around: u32, ripple: f64) -> f64 {
        let squares = (0..8).map(|i| {
            let mut samples = rippled(around, ripple, 0.7 * f64::from(i), 1.0);
            let surface = candidate.fit_to_rim(&mut samples).unwrap().unwrap();
            project::distance(surface.as_ref(), &Vec3::zeros()).powi(2)
        });
        (squares.sum::<f64>() / 8.0).sqrt()
    }

    #[test]
    fn wide_holes_with_detail_are_continued_from_smoothed_points() {
        let plain_over_smoothed = |around, ripple| {
            let off = |candidate| off_at_middle(candidate, around, ripple);
            off(Candidate::Cubic) / off(Candidate::CubicSmoothed)
        };
        let (wide, wider) = (
            plain_over_smoothed(240, 0.05),
            plain_over_smoothed(400, 0.1),
        );
        assert!(wide > 10.0 && wider > 20.0, "{wide} {wider}");
        let narrow = plain_over_smoothed(60, 0.1);
        assert!(narrow < 0.4, "{narrow}");
    }

    #[test]
    fn rings_are_smoothed_by_the_width_of_the_hole() {
        for (around, ripple, flatness, rings) in [
            (400, 0.1, 1.0, Some(9)),
            (2000, 0.1, 1.0, Some(9)),
            (240, 0.1, 1.0, Some(5)),
            (200, 0.05, 1.0, Some(4)),
            // Not wide.
            (198, 0.05, 1.0, None),
            // Nothing to smooth.
            (400, 0.0, 1.0, None),
            // Narrow.
            (400, 0.1, 0.1, Some(7)),
            // A slit.
            (400, 0.1, 0.03, None),
        ] {
            let samples = rippled(around, ripple, 0.0, flatness);
            assert_eq!(
                samples.rings_over_detail(),
                rings,
                "{around} {ripple} {flatness}"
            );
            assert_eq!(Candidate::Cubic.suits(&samples), rings.is_none());
        }
    }
}
