//! Implicit surfaces that interpolate points and normals: Hermite radial basis functions.
//!
//! Based on: H. Wendland, "Scattered Data Approximation", Cambridge University Press, 2005, section 16.2
//! (Hermite-Birkhoff interpolation by conditionally positive definite functions), as used for surfaces by
//! I. Macêdo, J. P. Gois, L. Velho, "Hermite radial basis functions implicits", Computer Graphics Forum 30(1), 2011.
//!
//! With the kernel `φ(r) = r³` or `r⁵`, the centers `x_i` and their normals `n_i`,
//!
//! `f(x) = Σ a_i φ(|x - x_i|) - Σ b_i · ∇φ(|x - x_i|) + Σ c_j B_j(x)`,
//!
//! where `B` are the ten monomials up to degree two. The conditions are `f(x_i) = 0`, `∇f(x_i) = n_i`, and that `a` and
//! `b` annihilate all `B_j`. They make a symmetric system of `4n + 10` unknowns. Among all interpolating functions, `f`
//! has the smallest energy that belongs to the kernel. Because of `B`, quadrics are reproduced exactly.
//!
//! Cost: `O(n³)` for a fit, `O(n)` for a value. Not guaranteed: that `f = 0` is a single sheet away from the centers.

use super::{Implicit, Sample};
use crate::math::Vec3;
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};

/// The radial function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kernel {
    /// `r³`: robust.
    Cubic,
    /// `r⁵`: more exact where the surface is smooth, but overshoots where it is not.
    Quintic,
}

impl Kernel {
    /// `φ`, `φ'/r` and `(φ'/r)'/r` at the distance `r`.
    #[inline]
    fn derivatives(self, r: f64) -> [f64; 3] {
        match self {
            Self::Cubic => [r * r * r, 3.0 * r, if r > 0.0 { 3.0 / r } else { 0.0 }],
            Self::Quintic => {
                let cube = r * r * r;
                [cube * r * r, 5.0 * cube, 15.0 * r]
            }
        }
    }
}

/// Number of monomials up to degree two.
const TAIL: usize = 10;
/// Added to the diagonal, in coordinates in which the samples have unit spread. Samples of a plane or another quadric
/// do not determine all monomials; the shift keeps the system regular.
const SHIFT: f64 = 1e-12;

/// An interpolating function.
#[derive(Clone, Debug)]
pub(crate) struct HermiteRbf {
    kernel: Kernel,
    center: Vec3,
    scale: f64,
    nodes: Vec<Node>,
    tail: [f64; TAIL],
}

#[derive(Clone, Debug)]
struct Node {
    point: Vec3,
    a: f64,
    b: Vec3,
}

impl HermiteRbf {
    /// Interpolates the samples. `ridge` is added to the diagonal, in coordinates in which the samples have unit
    /// spread: 0 interpolates exactly, more approximates noisy samples.
    ///
    /// `None` for fewer than four samples, samples without spread or a solution that is not finite.
    pub(crate) fn fit(samples: &[Sample], kernel: Kernel, ridge: f64) -> Option<Self> {
        let n = samples.len();
        if n < 4 {
            return None;
        }
        let center = samples.iter().map(|s| s.point).sum::<Vec3>() / n as f64;
        let squares: f64 = samples
            .iter()
            .map(|s| (s.point - center).norm_squared())
            .sum();
        let scale = (squares / n as f64).sqrt();
        if !(scale.is_finite() && scale > 0.0) {
            return None;
        }
        let points: Vec<Vec3> = samples.iter().map(|s| (s.point - center) / scale).collect();
        let size = 4 * n + TAIL;
        let mut matrix = Mat::<f64>::zeros(size, size);
        for (j, q) in points.iter().enumerate() {
            for (i, p) in points.iter().enumerate() {
                let d = p - q;
                let [value, first, second] = kernel.derivatives(d.norm());
                matrix[(4 * i, 4 * j)] = value;
                for k in 0..3 {
                    matrix[(4 * i, 4 * j + 1 + k)] = -first * d[k];
                    matrix[(4 * i + 1 + k, 4 * j)] = first * d[k];
                    for l in 0..3 {
                        let isotropic = if k == l { first } else { 0.0 };
                        matrix[(4 * i + 1 + k, 4 * j + 1 + l)] = -second * d[k] * d[l] - isotropic;
                    }
                }
            }
            let (monomials, gradients) = monomials(q);
            for t in 0..TAIL {
                let column = [monomials[t], gradients[t].x, gradients[t].y, gradients[t].z];
                for (k, &value) in column.iter().enumerate() {
                    matrix[(4 * j + k, 4 * n + t)] = value;
                    matrix[(4 * n + t, 4 * j + k)] = value;
                }
            }
        }
        for i in 0..size {
            matrix[(i, i)] += if i < 4 * n { ridge + SHIFT } else { SHIFT };
        }
        let mut right_side = Mat::<f64>::zeros(size, 1);
        for (i, s) in samples.iter().enumerate() {
            for k in 0..3 {
                right_side[(4 * i + 1 + k, 0)] = s.normal[k];
            }
        }
        let solution = PartialPivLu::new(matrix.as_ref()).solve(&right_side);
        let at = |i: usize| solution[(i, 0)];
        if !(0..size).all(|i| at(i).is_finite()) {
            return None;
        }
        let nodes = points.iter().enumerate().map(|(i, &point)| Node {
            point,
            a: at(4 * i),
            b: Vec3::new(at(4 * i + 1), at(4 * i + 2), at(4 * i + 3)),
        });
        Some(Self {
            kernel,
            center,
            scale,
            nodes: nodes.collect(),
            tail: std::array::from_fn(|t| at(4 * n + t)),
        })
    }
}

impl Implicit for HermiteRbf {
    fn value_and_gradient(&self, p: &Vec3) -> (f64, Vec3) {
        let q = (p - self.center) / self.scale;
        let (mut value, mut gradient) = (0.0, Vec3::zeros());
        for node in &self.nodes {
            let d = q - node.point;
            let [phi, first, second] = self.kernel.derivatives(d.norm());
            let along = node.b.dot(&d);
            value += node.a * phi - first * along;
            gradient += (node.a * first - second * along) * d - first * node.b;
        }
        let (monomials, gradients) = monomials(&q);
        for t in 0..TAIL {
            value += self.tail[t] * monomials[t];
            gradient += self.tail[t] * gradients[t];
        }
        (value * self.scale, gradient)
    }
}

/// The monomials up to degree two at `p`, and their gradients.
fn monomials(p: &Vec3) -> ([f64; TAIL], [Vec3; TAIL]) {
    let (x, y, z) = (p.x, p.y, p.z);
    let v = Vec3::new;
    (
        [1.0, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z],
        [
            v(0.0, 0.0, 0.0),
            v(1.0, 0.0, 0.0),
            v(0.0, 1.0, 0.0),
            v(0.0, 0.0, 1.0),
            v(2.0 * x, 0.0, 0.0),
            v(0.0, 2.0 * y, 0.0),
            v(0.0, 0.0, 2.0 * z),
            v(y, x, 0.0),
            v(z, 0.0, x),
            v(0.0, z, y),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of the ellipsoid with the half axes 1, 1.5 and 2 above the height 0.4.
    fn ellipsoid() -> Vec<Sample> {
        let axes = Vec3::new(1.0, 1.5, 2.0);
        let mut samples = Vec::new();
        for i in 0..6 {
            for k in 0..12 {
                let (height, turn) = (0.2 + 0.1 * f64::from(i), f64::from(k) * 0.52 + f64::from(i));
                let radius = (1.0_f64 - height * height).sqrt();
                let p = Vec3::new(radius * turn.cos(), radius * turn.sin(), height);
                samples.push(Sample {
                    point: p.component_mul(&axes),
                    normal: p.component_div(&axes).normalize(),
                });
            }
        }
        samples
    }

    #[test]
    fn points_and_normals_are_interpolated() {
        for kernel in [Kernel::Cubic, Kernel::Quintic] {
            let samples = ellipsoid();
            let f = HermiteRbf::fit(&samples, kernel, 0.0).unwrap();
            for s in &samples {
                let (value, gradient) = f.value_and_gradient(&s.point);
                assert!(value.abs() < 1e-8, "{value}");
                assert!((gradient - s.normal).norm() < 1e-7);
            }
        }
    }

    #[test]
    fn the_gradient_is_that_of_the_value() {
        for kernel in [Kernel::Cubic, Kernel::Quintic] {
            let f = HermiteRbf::fit(&ellipsoid(), kernel, 0.0).unwrap();
            let p = Vec3::new(0.3, -0.2, 1.9);
            let (_, gradient) = f.value_and_gradient(&p);
            for k in 0..3 {
                let step = Vec3::ith(k, 1e-5);
                let difference =
                    f.value_and_gradient(&(p + step)).0 - f.value_and_gradient(&(p - step)).0;
                assert!((difference / 2e-5 - gradient[k]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn the_surface_turns_and_scales_with_its_samples() {
        let samples = ellipsoid();
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, -1.1, 2.0);
        let moved: Vec<Sample> = samples
            .iter()
            .map(|s| Sample {
                point: turn * s.point * 50.0 + Vec3::new(100.0, 7.0, -30.0),
                normal: turn * s.normal,
            })
            .collect();
        let f = HermiteRbf::fit(&samples, Kernel::Cubic, 0.0).unwrap();
        let g = HermiteRbf::fit(&moved, Kernel::Cubic, 0.0).unwrap();
        let p = Vec3::new(0.1, 0.2, 1.7);
        let (value, gradient) = f.value_and_gradient(&p);
        let (moved_value, moved_gradient) =
            g.value_and_gradient(&(turn * p * 50.0 + Vec3::new(100.0, 7.0, -30.0)));
        assert!((moved_value / 50.0 - value).abs() < 1e-8);
        assert!((moved_gradient - turn * gradient).norm() < 1e-8);
    }

    #[test]
    fn a_plane_is_no_singular_case() {
        let samples: Vec<Sample> = (0..20)
            .map(|i| Sample {
                point: Vec3::new(f64::from(i % 5), f64::from(i / 5), 0.0),
                normal: Vec3::z(),
            })
            .collect();
        let f = HermiteRbf::fit(&samples, Kernel::Cubic, 0.0).unwrap();
        let (value, gradient) = f.value_and_gradient(&Vec3::new(2.3, 1.7, 0.5));
        assert!((value - 0.5).abs() < 1e-6 && (gradient - Vec3::z()).norm() < 1e-6);
        assert!(HermiteRbf::fit(&samples[..3], Kernel::Cubic, 0.0).is_none());
    }
}
