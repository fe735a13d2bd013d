//! Rims and first triangulations that the tests of this module share.

use super::density::{grading, rim_sizes};
use super::flip::Blocked;
use super::isotropic::{RefineOptions, RefineReport, refine};
use crate::job::UNLIMITED;
use crate::math::Vec3;
use crate::patch::PatchSurface;
use crate::patch::mesh::PatchMesh;
use std::f64::consts::TAU;

/// `n` points on the circle whose chords have length one.
pub(super) fn disc_rim(n: usize) -> Vec<Vec3> {
    let radius = 0.5 / (0.5 * TAU / n as f64).sin();
    (0..n)
        .map(|i| TAU * i as f64 / n as f64)
        .map(|angle| radius * Vec3::new(angle.cos(), angle.sin(), 0.0))
        .collect()
}

/// A polygon with the given distances from the origin at equal angles. A fan from its first corner
/// may overlap itself, which is what the tests want.
pub(super) fn star_rim(radii: &[f64]) -> Vec<Vec3> {
    let step = TAU / radii.len() as f64;
    radii
        .iter()
        .enumerate()
        .map(|(i, r)| {
            Vec3::new(
                r * (step * i as f64).cos(),
                r * (step * i as f64).sin(),
                0.0,
            )
        })
        .collect()
}

/// All triangles from vertex 0 of a polygon with `n` corners.
pub(super) fn fan(n: usize) -> Vec<[u32; 3]> {
    (1..n as u32 - 1).map(|i| [0, i, i + 1]).collect()
}

/// A fan over `rim`.
pub(super) fn fan_patch(rim: Vec<Vec3>) -> PatchSurface {
    PatchSurface {
        rim_count: rim.len(),
        triangles: fan(rim.len()),
        points: rim,
    }
}

/// A strip between two rails, `(bottom, top)` at each station; the rim runs along the bottom and
/// back along the top.
pub(super) fn strip_patch(rails: &[(Vec3, Vec3)]) -> PatchSurface {
    let n = rails.len() as u32;
    let points: Vec<_> = rails
        .iter()
        .map(|r| r.0)
        .chain(rails.iter().rev().map(|r| r.1))
        .collect();
    let triangles = (0..n - 1)
        .flat_map(|k| {
            [
                [k, k + 1, 2 * n - 1 - k],
                [k + 1, 2 * n - 2 - k, 2 * n - 1 - k],
            ]
        })
        .collect();
    PatchSurface {
        rim_count: points.len(),
        points,
        triangles,
    }
}

/// The connectivity of a patch.
pub(super) fn connect(surface: &PatchSurface) -> PatchMesh {
    let triangles = surface.triangles.clone();
    PatchMesh::new(triangles, surface.points.len(), surface.rim_count).unwrap()
}

/// Refines at the rim's density and checks all that holds for any input.
pub(super) fn refined_with(
    surface: &PatchSurface,
    options: &RefineOptions,
    blocked: &Blocked<'_>,
) -> (PatchSurface, Vec<f64>, RefineReport) {
    let mut sizes = rim_sizes(surface, &[]).unwrap();
    let mut out = surface.clone();
    let report = refine(&mut out, &mut sizes, options, blocked).unwrap();
    check_invariants(surface, &out, &sizes);
    assert_eq!(out.points.len(), surface.points.len() + report.splits);
    (out, sizes, report)
}

/// Refines at the rim's density with the grading of its size.
pub(super) fn refined(surface: &PatchSurface) -> (PatchSurface, Vec<f64>) {
    let options = RefineOptions {
        grading: grading(surface.rim_count),
        ..RefineOptions::new(&UNLIMITED)
    };
    let (out, sizes, _) = refined_with(surface, &options, &|_, _| false);
    (out, sizes)
}

/// Panics unless `after` has the rim, topology and orientation of `before` and finite values.
pub(super) fn check_invariants(before: &PatchSurface, after: &PatchSurface, sizes: &[f64]) {
    let (old, new) = (connect(before), connect(after));
    new.validate();
    assert_eq!(new.rim_pairs(), old.rim_pairs(), "rim edges");
    assert_eq!(new.euler(), old.euler(), "Euler characteristic");
    let bits = |s: &PatchSurface| -> Vec<[u64; 3]> {
        s.points[..s.rim_count]
            .iter()
            .map(|p| [p.x, p.y, p.z].map(f64::to_bits))
            .collect()
    };
    assert_eq!(bits(before), bits(after), "rim points");
    assert!(after.points.iter().flatten().all(|x| x.is_finite()));
    assert_eq!(sizes.len(), after.points.len());
    assert!(sizes.iter().all(|s| s.is_finite() && *s > 0.0));
}
