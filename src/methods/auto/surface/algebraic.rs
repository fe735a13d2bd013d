//! Fits planes, spheres, quadrics and Darboux cyclides by linear least squares.
//!
//! The function is `f(x) = Σ c_k B_k(x)` with the monomials
//!
//! * plane: `1, x, y, z`;
//! * sphere: those of the plane and `|x|²`;
//! * quadric: those of the plane and all six of degree two;
//! * cyclide: those of the quadric and `|x|² x, |x|² y, |x|² z, |x|⁴`. All quadrics, tori and Dupin cyclides are
//!   Darboux cyclides (G. Darboux, "Sur une classe remarquable de courbes et de surfaces algébriques", 1873).
//!
//! The coefficients minimize `Σ f(p)² + |∇f(p) - n|²` over the samples `(p, n)`, in the coordinates of [`Frame`]. The
//! conditions on gradients follow I. Macêdo, J. P. Gois, L. Velho, "Hermite radial basis functions implicits", CGF
//! 30(1), 2011. They exclude the solution `f = 0`.
//!
//! On a torus and on most quadrics no such `f` has gradients of length one. So a difference of length counts less than
//! a difference of direction ([`LENGTH_WEIGHT`]), and the system is solved several times: each solution sets the target
//! lengths for the next one, `∇f·n` divided by its mean. The influence of the first target decreases with the square of
//! the weight each time.
//!
//! Singular directions of the system, as for a sphere through coplanar samples, are left out; the result is then the
//! simplest surface of the kind. Not guaranteed: that `f = 0` has no second sheet nearby.

use super::frame::{Fit, Frame, rms_distance};
use super::{Implicit, Sample};
use crate::math::Vec3;
use faer::Mat;
use faer::linalg::solvers::Svd;

/// Weight of the length of a gradient, relative to its direction. With a small weight the lengths converge quickly;
/// with weight 1 an ellipsoid takes fifty rounds. It must not be 0: then coplanar samples would not determine which of
/// the surfaces that contain a plane is taken.
const LENGTH_WEIGHT: f64 = 0.1;

/// Number of solutions after the first one. The first one has the target length 1 for all gradients.
const REWEIGHTINGS: usize = 6;

/// Singular values below this part of the largest one are rounding errors.
const SINGULAR: f64 = 1e-11;

/// Number of monomials of the largest kind.
const MOST_TERMS: usize = 14;

/// Lower bound on the conditions for each unknown. With fewer, a fit would follow single samples.
const CONDITIONS_PER_TERM: usize = 2;

/// A kind of surface that is the zero set of a sum of monomials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Plane,
    Sphere,
    Quadric,
    Cyclide,
}

impl Kind {
    /// Number of monomials, one more than the degrees of freedom of the surface.
    pub(crate) fn terms(self) -> usize {
        match self {
            Self::Plane => 4,
            Self::Sphere => 5,
            Self::Quadric => 10,
            Self::Cyclide => MOST_TERMS,
        }
    }

    /// The values of the monomials at `p` and their gradients; only the first [`Self::terms`] count.
    fn monomials(self, p: &Vec3) -> ([f64; MOST_TERMS], [Vec3; MOST_TERMS]) {
        let (x, y, z) = (p.x, p.y, p.z);
        let square = p.norm_squared();
        let (mut values, mut gradients) = ([0.0; MOST_TERMS], [Vec3::zeros(); MOST_TERMS]);
        values[..4].copy_from_slice(&[1.0, x, y, z]);
        gradients[1..4].copy_from_slice(&[Vec3::x(), Vec3::y(), Vec3::z()]);
        if self == Self::Sphere {
            values[4] = square;
            gradients[4] = 2.0 * p;
        }
        if self >= Self::Quadric {
            values[4..10].copy_from_slice(&[x * x, y * y, z * z, x * y, x * z, y * z]);
            gradients[4..10].copy_from_slice(&[
                Vec3::new(2.0 * x, 0.0, 0.0),
                Vec3::new(0.0, 2.0 * y, 0.0),
                Vec3::new(0.0, 0.0, 2.0 * z),
                Vec3::new(y, x, 0.0),
                Vec3::new(z, 0.0, x),
                Vec3::new(0.0, z, y),
            ]);
        }
        if self == Self::Cyclide {
            for k in 0..3 {
                values[10 + k] = square * p[k];
                gradients[10 + k] = 2.0 * p[k] * p;
                gradients[10 + k][k] += square;
            }
            values[13] = square * square;
            gradients[13] = 4.0 * square * p;
        }
        (values, gradients)
    }
}

/// The zero set of a sum of monomials.
#[derive(Clone, Debug)]
pub(crate) struct AlgebraicSurface {
    kind: Kind,
    frame: Frame,
    coefficients: [f64; MOST_TERMS],
}

impl AlgebraicSurface {
    /// Fits a surface of the kind. `None` when the samples lie in one place, are too few, have a number that is not
    /// finite, or when the mean gradient does not point along the normals.
    ///
    /// # Complexity
    /// Linear in the number of samples.
    pub(crate) fn fit(kind: Kind, samples: &[Sample]) -> Option<Fit<Self>> {
        let terms = kind.terms();
        let frame = Frame::around(samples)?;
        if 4 * samples.len() < CONDITIONS_PER_TERM * terms {
            return None;
        }
        let system = System::new(kind, &frame.enter_all(samples))?;
        let mut lengths = Mat::from_fn(samples.len(), 1, |_, _| 1.0);
        let mut solution = Mat::zeros(terms, 1);
        for _ in 0..=REWEIGHTINGS {
            solution = system.solve(&lengths);
            lengths = &system.lengths * &solution;
            let mean = lengths.sum() / samples.len() as f64;
            if !(mean.is_finite() && mean > 0.0) {
                return None;
            }
            lengths /= mean;
        }
        let mut coefficients = [0.0; MOST_TERMS];
        for (k, coefficient) in coefficients[..terms].iter_mut().enumerate() {
            *coefficient = solution[(k, 0)];
        }
        let surface = Self {
            kind,
            frame,
            coefficients,
        };
        let rms = rms_distance(&surface, samples)?;
        Some(Fit { surface, rms })
    }
}

impl Implicit for AlgebraicSurface {
    fn value_and_gradient(&self, p: &Vec3) -> (f64, Vec3) {
        let (values, gradients) = self.kind.monomials(&self.frame.enter(p));
        let (mut value, mut gradient) = (0.0, Vec3::zeros());
        for (k, coefficient) in self.coefficients[..self.kind.terms()].iter().enumerate() {
            value += coefficient * values[k];
            gradient += *coefficient * gradients[k];
        }
        (self.frame.leave_value(value), gradient)
    }
}

/// The least squares problem for the coefficients, with its singular value decomposition.
struct System {
    svd: Svd<f64>,
    /// Maps the target lengths of the gradients to the right-hand side, in components along the left singular vectors.
    components: Mat<f64>,
    /// Maps the coefficients to the lengths of the gradients along the normals of the samples.
    lengths: Mat<f64>,
}

impl System {
    /// `None` when the decomposition does not converge.
    fn new(kind: Kind, samples: &[Sample]) -> Option<Self> {
        let terms = kind.terms();
        let mut matrix = Mat::zeros(4 * samples.len(), terms);
        let mut lengths = Mat::zeros(samples.len(), terms);
        for (i, sample) in samples.iter().enumerate() {
            let (values, gradients) = kind.monomials(&sample.point);
            for k in 0..terms {
                let length = sample.normal.dot(&gradients[k]);
                let row = gradients[k] - (1.0 - LENGTH_WEIGHT) * length * sample.normal;
                lengths[(i, k)] = length;
                matrix[(4 * i, k)] = values[k];
                for axis in 0..3 {
                    matrix[(4 * i + 1 + axis, k)] = row[axis];
                }
            }
        }
        let svd = matrix.thin_svd().ok()?;
        let left = svd.U();
        let components = Mat::from_fn(left.ncols(), samples.len(), |k, i| {
            let along: f64 = (0..3)
                .map(|axis| left[(4 * i + 1 + axis, k)] * samples[i].normal[axis])
                .sum();
            LENGTH_WEIGHT * along
        });
        Some(Self {
            svd,
            components,
            lengths,
        })
    }

    /// The coefficients for the given target lengths of the gradients; those of smallest norm where the samples do not
    /// determine them.
    fn solve(&self, lengths: &Mat<f64>) -> Mat<f64> {
        let mut components = &self.components * lengths;
        let singular_values = self.svd.S().column_vector();
        let cut = SINGULAR * singular_values[0];
        for k in 0..components.nrows() {
            let value = singular_values[k];
            components[(k, 0)] *= if value > cut { value.recip() } else { 0.0 };
        }
        self.svd.V() * components
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{
        Parametric, cylinder, deviation, ellipsoid, plane, sampled, scatter, sphere, torus,
    };
    use super::*;
    use nalgebra::Rotation3;

    const KINDS: [Kind; 4] = [Kind::Plane, Kind::Sphere, Kind::Quadric, Kind::Cyclide];

    /// Each surface with the kinds that contain it.
    const CONTAINED: [(Parametric, &[Kind]); 5] = [
        (plane, &KINDS),
        (sphere, &[Kind::Sphere, Kind::Quadric, Kind::Cyclide]),
        (cylinder, &[Kind::Quadric, Kind::Cyclide]),
        (ellipsoid, &[Kind::Quadric, Kind::Cyclide]),
        (torus, &[Kind::Cyclide]),
    ];

    #[test]
    fn surfaces_that_a_kind_contains_are_reproduced_to_rounding_errors() {
        for (i, (surface, kinds)) in CONTAINED.iter().enumerate() {
            for &kind in *kinds {
                let fit = AlgebraicSurface::fit(kind, &sampled(*surface, 9, 0.0)).unwrap();
                let (distance, angle) = deviation(&fit.surface, *surface);
                let what = format!("{kind:?} of surface {i}: {distance:e} {angle:e}");
                assert!(distance < 1e-9 && fit.rms < 1e-9, "{what}");
                assert!(angle < 1e-7, "{what}");
            }
        }
    }

    #[test]
    fn noise_is_averaged_out() {
        for (surface, kinds) in CONTAINED {
            for &kind in kinds {
                let fit = AlgebraicSurface::fit(kind, &sampled(surface, 15, 0.01)).unwrap();
                let (distance, _) = deviation(&fit.surface, surface);
                assert!(distance < 0.02, "{kind:?} {distance}");
                assert!((0.003..0.01).contains(&fit.rms), "{kind:?} {}", fit.rms);
            }
        }
    }

    #[test]
    fn a_kind_that_is_too_simple_shows_it_in_its_residual() {
        let fit = |kind, surface| AlgebraicSurface::fit(kind, &sampled(surface, 9, 0.0)).unwrap();
        assert!(fit(Kind::Plane, sphere).rms > 0.02);
        assert!(fit(Kind::Sphere, cylinder).rms > 0.02);
        assert!(fit(Kind::Quadric, torus).rms > 0.002);
    }

    #[test]
    fn a_turn_turns_the_surface() {
        let turn = Rotation3::from_euler_angles(1.0, 2.0, 3.0);
        for kind in KINDS {
            let samples = sampled(torus, 9, 0.01);
            let turned: Vec<Sample> = samples
                .iter()
                .map(|s| Sample {
                    point: 1e3 * (turn * s.point),
                    normal: turn * s.normal,
                })
                .collect();
            let fit = AlgebraicSurface::fit(kind, &samples).unwrap();
            let other = AlgebraicSurface::fit(kind, &turned).unwrap();
            for (s, t) in samples.iter().zip(&turned) {
                let (value, gradient) = fit.surface.value_and_gradient(&s.point);
                let (other_value, other_gradient) = other.surface.value_and_gradient(&t.point);
                assert!((value - other_value / 1e3).abs() < 1e-12, "{kind:?}");
                assert!(
                    (turn * gradient - other_gradient).norm() < 1e-12,
                    "{kind:?}"
                );
            }
        }
    }

    #[test]
    fn values_have_the_gradient_that_is_given() {
        for kind in KINDS {
            let surface = AlgebraicSurface::fit(kind, &sampled(torus, 9, 0.02))
                .unwrap()
                .surface;
            let p = Vec3::new(5.5, -3.5, 2.0);
            let (_, gradient) = surface.value_and_gradient(&p);
            for k in 0..3 {
                let step = Vec3::ith(k, 1e-5);
                let ahead = surface.value_and_gradient(&(p + step)).0;
                let behind = surface.value_and_gradient(&(p - step)).0;
                assert!(
                    ((ahead - behind) / 2e-5 - gradient[k]).abs() < 1e-6,
                    "{kind:?}"
                );
            }
        }
    }

    #[test]
    fn samples_that_determine_too_little_give_a_simple_surface_or_none() {
        let flat = sampled(plane, 6, 0.0);
        let line: Vec<Sample> = flat[..6].to_vec();
        let repeated: Vec<Sample> = flat
            .iter()
            .chain(&flat)
            .chain(&flat[..5])
            .copied()
            .collect();
        for kind in KINDS {
            for samples in [&flat, &repeated] {
                let fit = AlgebraicSurface::fit(kind, samples).unwrap();
                assert!(deviation(&fit.surface, plane).0 < 1e-9, "{kind:?}");
            }
            if let Some(fit) = AlgebraicSurface::fit(kind, &line) {
                assert!(fit.rms < 1e-9, "{kind:?}");
            }
            assert!(AlgebraicSurface::fit(kind, &[]).is_none());
            assert!(AlgebraicSurface::fit(kind, &flat[..1]).is_none());
            assert!(AlgebraicSurface::fit(kind, &[flat[0]; 40]).is_none());
            let mut broken = flat.clone();
            broken[7].point.y = f64::NAN;
            assert!(AlgebraicSurface::fit(kind, &broken).is_none());
            broken[7].point.y = f64::INFINITY;
            assert!(AlgebraicSurface::fit(kind, &broken).is_none());
        }
        assert!(AlgebraicSurface::fit(Kind::Cyclide, &flat[..6]).is_none());
    }

    #[test]
    fn normals_without_a_common_side_give_no_surface_that_is_no_number() {
        let mut samples = sampled(sphere, 6, 0.0);
        for (i, sample) in samples.iter_mut().enumerate() {
            sample.normal *= scatter(i).signum();
        }
        for kind in KINDS {
            if let Some(fit) = AlgebraicSurface::fit(kind, &samples) {
                assert!(fit.rms.is_finite(), "{kind:?}");
            }
        }
    }
}
