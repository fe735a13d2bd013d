//! The surfaces that compete to continue the known one.

use super::algebraic::{AlgebraicSurface, Kind};
use super::choice::FITTED_RINGS;
use super::frame::Fit;
use super::hermite_rbf::{HermiteRbf, Kernel};
use super::primitives::{cone::Cone, cylinder::Cylinder, torus::Torus};
use super::samples::SampledBand;
use super::{Implicit, Sample};
use crate::error::Result;

/// Most samples of an interpolating function that is scored, and of one that is used: the cost grows with the cube, the
/// accuracy little.
const MOST_CENTERS: [usize; 2] = [80, 140];
/// The same for surfaces that are found by iteration, whose every step reads all samples.
const MOST_ITERATED_SAMPLES: [usize; 2] = [60, 100];
/// The same for algebraic surfaces, which are decomposed once.
const MOST_LINEAR_SAMPLES: [usize; 2] = [150, 300];
/// Rings of samples of an interpolating function of the whole surroundings: two determine position, tangent plane
/// and curvature at the rim, and further ones only cost.
const LAST_CENTER_LEVEL: u32 = 1;
/// Ridge of the function that passes by noisy samples, in coordinates of unit spread.
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
    /// Darboux cyclide: contains the quadrics and the tori.
    Cyclide,
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
    /// All candidates, in the order in which they are scored: those that rule others out come first, and the quintic
    /// kernel, which is judged by the cubic one, after that.
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

    /// Degrees of freedom; for interpolating functions, which have as many as data, numbers that put them last, and
    /// the less robust ones behind.
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

    /// Whether the candidate suits surroundings with such noise and detail.
    pub(crate) fn suits(self, samples: &SampledBand) -> bool {
        match self {
            Self::Cubic => !samples.is_detail_misleading(),
            Self::CubicSmoothed => samples.is_noisy() || samples.is_detail_misleading(),
            Self::CubicRidge => samples.is_noisy(),
            Self::Quintic => !samples.is_noisy(),
            _ => true,
        }
    }

    /// The candidate that contains or approximates this one and costs less: it must score well for this one to be
    /// tried.
    pub(crate) fn gate(self) -> Option<Self> {
        match self {
            Self::Plane | Self::Sphere | Self::Cylinder | Self::Cone => Some(Self::Quadric),
            Self::Torus => Some(Self::Cyclide),
            _ => None,
        }
    }

    /// Most samples of a fit that is scored, and of one that is used.
    fn most_samples(self) -> [usize; 2] {
        match self {
            Self::Cylinder | Self::Cone | Self::Torus => MOST_ITERATED_SAMPLES,
            _ if self.interpolates() => MOST_CENTERS,
            _ => MOST_LINEAR_SAMPLES,
        }
    }

    /// Most samples of a fit that is scored.
    pub(crate) fn most_scored(self) -> usize {
        self.most_samples()[0]
    }

    /// Fits the surface to the vertices, which robust candidates smooth where there is noise: that is what is scored.
    pub(crate) fn fit(
        self,
        samples: &mut SampledBand,
        vertices: &[u32],
    ) -> Result<Option<Box<dyn Implicit>>> {
        let reads_smoothed = samples.is_noisy() && !matches!(self, Self::Cubic | Self::Quintic);
        let rings = reads_smoothed.then(|| samples.rings_over_noise());
        self.fit_to(samples, vertices, rings)
    }

    /// Fits the surface to the vertices, smoothed over so many rings of neighbours.
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

    /// The surface that continues the surroundings into the hole.
    pub(crate) fn fit_to_rim(self, samples: &mut SampledBand) -> Result<Option<Box<dyn Implicit>>> {
        let last = match self {
            Self::Cubic | Self::Quintic => LAST_CENTER_LEVEL,
            _ => FITTED_RINGS,
        };
        let vertices = samples.spread(0..last + 1, self.most_samples()[1])?;
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

    /// The surroundings of a round hole in a paraboloid that rises by a twentieth of the hole's width, with ripples of
    /// this height, five edges long; then all is flattened by the factor along one axis.
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
