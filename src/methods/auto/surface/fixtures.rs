//! Samples of analytic surfaces, for the tests of this module.

use super::RINGS;
use super::{Implicit, Sample};
use crate::hole::Hole;
use crate::math::{Vec3, unit};
use crate::surroundings::Surroundings;
use nalgebra::Rotation3;
use std::f64::consts::TAU;

/// A parametric surface: point and normal for a parameter in the unit square.
pub(crate) type Parametric = fn(f64, f64) -> (Vec3, Vec3);

pub(crate) fn plane(u: f64, v: f64) -> (Vec3, Vec3) {
    (Vec3::new(3.0 * u, 2.0 * v, 0.0), Vec3::z())
}

/// A piece of a sphere of radius 2, 60 degrees wide.
pub(crate) fn sphere(u: f64, v: f64) -> (Vec3, Vec3) {
    let (a, b) = (u - 0.5, v - 0.5);
    let n = Vec3::new(a.cos() * b.cos(), a.sin() * b.cos(), b.sin());
    (2.0 * n, n)
}

/// A quarter of a cylinder of radius 1.5, seen from inside.
pub(crate) fn cylinder(u: f64, v: f64) -> (Vec3, Vec3) {
    let (sin, cos) = (1.5 * u).sin_cos();
    (
        Vec3::new(1.5 * cos, 1.5 * sin, 2.0 * v),
        -Vec3::new(cos, sin, 0.0),
    )
}

/// A piece of a cone of half angle 30 degrees, 1 to 2 from its apex along the axis.
pub(crate) fn cone(u: f64, v: f64) -> (Vec3, Vec3) {
    let (sin, cos) = (2.0 * u).sin_cos();
    let (slope, height) = (30_f64.to_radians(), 1.0 + v);
    let r = height * slope.tan();
    let n = slope.cos() * Vec3::new(cos, sin, 0.0) - slope.sin() * Vec3::z();
    (Vec3::new(r * cos, r * sin, height), n)
}

/// A piece of a torus of radii 2 and 0.7.
pub(crate) fn torus(u: f64, v: f64) -> (Vec3, Vec3) {
    let (sin, cos) = (0.8 * u).sin_cos();
    let (tilt_sin, tilt_cos) = (1.5 * v + 0.3).sin_cos();
    let n = Vec3::new(tilt_cos * cos, tilt_cos * sin, tilt_sin);
    (2.0 * Vec3::new(cos, sin, 0.0) + 0.7 * n, n)
}

/// A piece of an ellipsoid with half axes 3, 2, 1.
pub(crate) fn ellipsoid(u: f64, v: f64) -> (Vec3, Vec3) {
    let unit_sphere = sphere(u, v).1;
    let axes = Vec3::new(3.0, 2.0, 1.0);
    (
        unit_sphere.component_mul(&axes),
        unit(unit_sphere.component_div(&axes)),
    )
}

/// Pseudorandom numbers between -1 and 1, the same each time.
pub(crate) fn scatter(index: usize) -> f64 {
    let x = ((index as f64 + 1.0) * 12.9898).sin() * 43_758.545_3;
    2.0 * (x - x.floor()) - 1.0
}

/// `count` times `count` samples of the surface, turned and shifted so that no axis is special. Each coordinate is
/// moved by up to `noise`, and each normal by ten times that.
pub(crate) fn sampled(surface: Parametric, count: usize, noise: f64) -> Vec<Sample> {
    let turn = turn();
    (0..count * count)
        .map(|i| {
            let (u, v) = ((i / count) as f64, (i % count) as f64);
            let (p, n) = surface(u / count as f64, v / count as f64);
            let off = |k: usize| {
                Vec3::new(
                    scatter(6 * i + k),
                    scatter(6 * i + k + 1),
                    scatter(6 * i + k + 2),
                )
            };
            Sample {
                point: turn * (p + noise * off(0)) + Vec3::new(5.0, -3.0, 1.0),
                normal: turn * unit(n + 10.0 * noise * off(3)),
            }
        })
        .collect()
}

pub(crate) fn turn() -> Rotation3<f64> {
    Rotation3::from_euler_angles(0.4, -1.2, 2.1)
}

/// The largest distance of `fitted` from the clean surface, over a grid between the samples, and the largest
/// angle between the normals.
pub(crate) fn deviation(fitted: &impl Implicit, surface: Parametric) -> (f64, f64) {
    let clean = sampled(surface, 23, 0.0);
    let deviations = clean.iter().map(|s| {
        let (value, gradient) = fitted.value_and_gradient(&s.point);
        ((value / gradient.norm()).abs(), gradient.angle(&s.normal))
    });
    deviations.fold((0.0, 0.0), |a, b| (a.0.max(b.0), a.1.max(b.1)))
}

/// The rings of triangles round a round hole with `around` edges, 1.05 long, in the surface with the given height above
/// the plane.
pub(crate) fn rings_around(around: u32, height: impl Fn(f64, f64) -> f64) -> Hole {
    let point = |ring: u32, k: u32| {
        let radius = f64::from(around) / 6.0 + f64::from(ring);
        let (sin, cos) = (TAU * f64::from(k) / f64::from(around)).sin_cos();
        Vec3::new(
            radius * cos,
            radius * sin,
            height(radius * cos, radius * sin),
        )
    };
    let ring = |r: u32| (0..around).map(move |k| point(r, k));
    let vertex = |r: u32, k: u32| r * around + k % around;
    let quads = (0..RINGS).flat_map(|r| (0..around).map(move |k| (r, k)));
    let triangles = quads.flat_map(|(r, k)| {
        let quad = [
            vertex(r, k),
            vertex(r + 1, k),
            vertex(r + 1, k + 1),
            vertex(r, k + 1),
        ];
        [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
    });
    Hole {
        polygon: (0..around).collect(),
        surroundings: Surroundings::new(
            around as usize,
            (0..=RINGS).flat_map(&ring).collect(),
            (0..=RINGS).flat_map(|r| vec![r; around as usize]).collect(),
            triangles.collect(),
        ),
        ..Hole::default()
    }
}
