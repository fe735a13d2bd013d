//! Recognizes a hole that is a gap in a flat face.
//!
//! A hole is such a gap if most of its rim edges and their triangles lie in one plane. Cross-validation can miss this:
//! on a coarse model a flat face may have only a few triangles round the hole, and the rings that are left out already
//! lie on the surface that it bends into.
//!
//! The normal and the position of the plane are medians, weighted by edge lengths. They are not changed by outliers
//! with less than half of the weight. Cost: O(m log m) for `m` rim edges.

use super::Implicit;
use crate::hole::Hole;
use crate::math::{Vec3, unit};

/// Lower bound on the length of the rim edges in the plane, divided by the length of all rim edges with a triangle.
const SHARE: f64 = 0.8;
/// Lower bound on the cosine of the angle between the plane and a triangle in it. It stands for one degree.
const ALIKE: f64 = 0.99985;
/// Upper bound on the distance between the plane and a rim vertex in it, in mean rim edge lengths.
const NEAR: f64 = 0.005;

/// A plane with a unit normal.
pub(crate) struct RimPlane {
    normal: Vec3,
    offset: f64,
}

impl Implicit for RimPlane {
    fn value_and_gradient(&self, p: &Vec3) -> (f64, Vec3) {
        (self.normal.dot(p) - self.offset, self.normal)
    }
}

/// The plane in which most of the rim lies, with its triangles; `None` if there is no such plane.
pub(crate) fn plane_of_rim(hole: &Hole) -> Option<RimPlane> {
    let corners: Vec<Vec3> = hole
        .polygon
        .iter()
        .map(|&v| hole.surroundings.point(v))
        .collect();
    let next = |i: usize| corners[(i + 1) % corners.len()];
    // Length, ends and normal of each edge with a triangle.
    let edges: Vec<(f64, [Vec3; 2], Vec3)> = hole
        .outside_normals
        .iter()
        .zip(corners.iter().enumerate())
        .filter_map(|(normal, (i, &p))| Some(((next(i) - p).norm(), [p, next(i)], (*normal)?)))
        .collect();
    let median = |value: &dyn Fn(&[Vec3; 2], &Vec3) -> f64| {
        let weighted = edges.iter().map(|(l, ends, n)| (value(ends, n), *l));
        weighted_median(weighted.collect())
    };
    let normal = Vec3::new(
        median(&|_, n| n.x)?,
        median(&|_, n| n.y)?,
        median(&|_, n| n.z)?,
    );
    let normal = unit(normal);
    let offset = median(&|[a, b], _| 0.5 * (a + b).dot(&normal))?;
    let whole: f64 = edges.iter().map(|e| e.0).sum();
    let flat: f64 = edges
        .iter()
        .filter(|(_, ends, n)| {
            n.dot(&normal) > ALIKE && ends.iter().all(|p| (p.dot(&normal) - offset).abs() < NEAR)
        })
        .map(|e| e.0)
        .sum();
    (flat >= SHARE * whole && whole > 0.0).then_some(RimPlane { normal, offset })
}

/// The median of values with weights: the smallest value such that it and the smaller ones have half of the weight.
fn weighted_median(mut pairs: Vec<(f64, f64)>) -> Option<f64> {
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * pairs.iter().map(|p| p.1).sum::<f64>();
    let mut sum = 0.0;
    pairs.into_iter().find_map(|(value, weight)| {
        sum += weight;
        (sum >= half).then_some(value)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surroundings::Surroundings;

    /// A round rim in the plane z = 0 whose triangles lean by `lean(i)` radians, and whose vertices rise by `rise(i)`.
    fn hole(lean: impl Fn(usize) -> f64, rise: impl Fn(usize) -> f64) -> Hole {
        let m = 20;
        let angle = |i: usize| i as f64 * std::f64::consts::TAU / m as f64;
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, -0.9, 1.3);
        let point =
            |i: usize| turn * Vec3::new(3.2 * angle(i).cos(), 3.2 * angle(i).sin(), rise(i));
        let normal = |i: usize| {
            let out = Vec3::new(angle(i).cos(), angle(i).sin(), 0.0);
            Some(turn * (out * lean(i).sin() + Vec3::z() * lean(i).cos()))
        };
        Hole {
            surroundings: Surroundings::bare((0..m).map(point).collect()),
            polygon: (0..m as u32).collect(),
            outside_normals: (0..m).map(normal).collect(),
            ..Hole::default()
        }
    }

    #[test]
    fn a_flat_rim_is_found_though_a_few_triangles_lean() {
        let lean = |i| if i < 3 { 0.8 } else { 0.0 };
        let plane = plane_of_rim(&hole(lean, |i| if i == 1 { 0.3 } else { 0.0 })).unwrap();
        let flat = hole(lean, |_| 0.0);
        for p in flat.rim() {
            assert!(plane.value_and_gradient(p).0.abs() < 1e-12);
        }
        assert!(plane_of_rim(&hole(|i| if i < 5 { 0.8 } else { 0.0 }, |_| 0.0)).is_none());
    }

    #[test]
    fn the_rims_of_caps_tubes_and_bent_sheets_are_not_flat() {
        assert!(plane_of_rim(&hole(|_| 0.05, |_| 0.0)).is_none());
        assert!(plane_of_rim(&hole(|_| std::f64::consts::FRAC_PI_2, |_| 0.0)).is_none());
        assert!(plane_of_rim(&hole(|_| 0.0, |i| 0.02 * (i % 3) as f64)).is_none());
        assert!(plane_of_rim(&Hole::default()).is_none());
    }
}
