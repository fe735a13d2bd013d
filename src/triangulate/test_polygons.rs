//! Polygons of holes for the tests of this module.

use super::polygon::HolePolygon;
use crate::math::{Vec3, cross_normal, unit};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// The owned parts of a [`HolePolygon`] without blocked chords.
#[derive(Clone, Debug)]
pub(super) struct Rim {
    pub(super) points: Vec<Vec3>,
    pub(super) normals: Vec<Option<Vec3>>,
    pub(super) ids: Vec<u32>,
}

impl Rim {
    pub(super) fn polygon(&self) -> HolePolygon<'_> {
        HolePolygon {
            points: &self.points,
            outside_normals: &self.normals,
            vertex_ids: &self.ids,
            blocked: &|_, _| false,
        }
    }

    fn new(points: Vec<Vec3>, normals: Vec<Option<Vec3>>) -> Self {
        let ids = (0..points.len() as u32).collect();
        Self {
            points,
            normals,
            ids,
        }
    }

    /// In the plane z = 0, inside a sheet that faces up; made counter-clockwise.
    pub(super) fn planar(outline: &[[f64; 2]]) -> Self {
        let points: Vec<_> = outline.iter().map(|p| Vec3::new(p[0], p[1], 0.0)).collect();
        let mut rim = Self::new(points, vec![Some(Vec3::z()); outline.len()]);
        if rim.planar_area() < 0.0 {
            rim.points.reverse();
        }
        rim
    }

    pub(super) fn regular(len: usize) -> Self {
        let angles = (0..len).map(|i| TAU * i as f64 / len as f64);
        Self::planar(&angles.map(|a| [a.cos(), a.sin()]).collect::<Vec<_>>())
    }

    /// A circle whose height oscillates, in a surface that slopes outward.
    pub(super) fn wavy(len: usize, lobes: u32, height: f64) -> Self {
        let at = |i: usize, radius: f64| {
            let a = TAU * i as f64 / len as f64;
            let z = height * (f64::from(lobes) * a + 0.3 * a.sin()).sin();
            Vec3::new(radius * a.cos(), radius * a.sin(), z)
        };
        let points: Vec<_> = (0..len).map(|i| at(i, 1.0)).collect();
        let normal = |i: usize| unit(cross_normal(&at(i + 1, 1.0), &at(i, 1.0), &at(i, 1.3)));
        Self::new(points, (0..len).map(|i| Some(normal(i))).collect())
    }

    /// A ribbon's rim that climbs a helix and returns beside it; no neighbors known.
    pub(super) fn helix(len: usize) -> Self {
        let half = len / 2;
        let at = |k: usize, radius: f64| {
            let a = TAU * 3.0 * k as f64 / half as f64;
            Vec3::new(radius * a.cos(), radius * a.sin(), 0.2 * a)
        };
        let up = (0..half).map(|k| at(k, 1.0));
        let points: Vec<_> = up
            .chain((0..len - half).rev().map(|k| at(k, 0.6)))
            .collect();
        Self::new(points, vec![None; len])
    }

    /// A closed curve that runs three times round an axis; no neighbors known.
    pub(super) fn wound(len: usize) -> Self {
        let at = |k: usize| {
            let b = TAU * k as f64 / len as f64;
            let radius = 2.0 + 0.4 * b.cos();
            Vec3::new(radius * (3.0 * b).cos(), radius * (3.0 * b).sin(), b.sin())
        };
        Self::new((0..len).map(at).collect(), vec![None; len])
    }

    /// A triangle round a triangle, joined by a bridge walked both ways.
    pub(super) fn bridged_triangles() -> Self {
        Self::bridged_rings(3)
    }

    /// A regular `half`-gon round a smaller one, joined by a bridge walked both ways.
    pub(super) fn bridged_rings(half: usize) -> Self {
        let ring = |radius: f64, shift: f64| {
            (0..half).map(move |i| {
                let a = TAU * (i as f64 + shift) / half as f64;
                [radius * a.cos(), radius * a.sin()]
            })
        };
        let outer: Vec<_> = ring(1.0, 0.0).collect();
        let inner: Vec<_> = ring(0.3, 0.1).rev().collect();
        let mut outline = outer.clone();
        outline.push(outer[0]);
        outline.push(inner[half - 1]);
        outline.extend(&inner);
        let mut rim = Self::planar(&outline);
        let half = half as u32;
        rim.ids = (0..half)
            .chain([0, 2 * half - 1])
            .chain(half..2 * half)
            .collect();
        // No triangle is known across the bridge.
        rim.normals[half as usize] = None;
        rim.normals[2 * half as usize + 1] = None;
        rim
    }

    /// The same rim, listed from another position on.
    pub(super) fn rotated(&self, start: usize) -> Self {
        let mut rim = self.clone();
        rim.points.rotate_left(start);
        rim.normals.rotate_left(start);
        rim.ids.rotate_left(start);
        rim
    }

    pub(super) fn area(&self, triangle: &[u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| &self.points[i as usize]);
        0.5 * cross_normal(a, b, c).norm()
    }

    pub(super) fn areas(&self, triangles: &[[u32; 3]]) -> f64 {
        triangles.iter().map(|t| self.area(t)).sum()
    }

    /// Signed area of the projection to z = 0.
    pub(super) fn planar_area(&self) -> f64 {
        let p = &self.points;
        (0..p.len())
            .map(|i| 0.5 * p[i].cross(&p[(i + 1) % p.len()]).z)
            .sum()
    }

    /// Whether every edge between two vertices has at most two triangles, counting the known ones,
    /// and no triangle has a vertex twice.
    pub(super) fn joins_no_vertices_twice(&self, triangles: &[[u32; 3]]) -> bool {
        let len = self.ids.len();
        let sides = triangles
            .iter()
            .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
        // One entry per place on the polygon where an edge lies; the two ways of a bridge are one.
        let mut places: Vec<(u32, u32, bool, u32, u32)> = sides
            .map(|(i, j)| {
                let (a, b) = (self.ids[i as usize], self.ids[j as usize]);
                let (low, high) = (i.min(j), i.max(j));
                let is_edge = high == low + 1 || (low == 0 && high as usize + 1 == len);
                (a.min(b), a.max(b), is_edge, low, high)
            })
            .collect();
        places.sort_unstable();
        places.dedup();
        let once = places
            .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
            .all(|same| {
                let chords = same.iter().filter(|place| !place.2).count();
                chords == 0 || same.len() == 1
            });
        once && places.iter().all(|place| place.0 != place.1)
    }
}

/// The outline with points at most `spacing` apart on its sides.
pub(super) fn subdivided(outline: &[[f64; 2]], spacing: f64) -> Vec<[f64; 2]> {
    let mut points = vec![];
    for (i, a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        let pieces = ((b[0] - a[0]).hypot(b[1] - a[1]) / spacing).ceil();
        for k in 0..pieces as usize {
            let t = k as f64 / pieces;
            points.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
    }
    points
}

/// A bar with long narrow teeth.
pub(super) fn comb() -> Vec<[f64; 2]> {
    let mut outline = vec![];
    for x in 0..20 {
        let x = f64::from(x);
        outline.extend([[x, 0.0], [x + 0.5, 10.0], [x + 0.6, 0.0]]);
    }
    outline.extend([[20.0, 0.0], [20.0, -1.0], [0.0, -1.0]]);
    subdivided(&outline, 0.5)
}

/// A narrow slit rolled up, `half` points on each side.
pub(super) fn spiral_slit(half: usize) -> Vec<[f64; 2]> {
    let at = |k: usize, offset: f64| {
        let a = k as f64 * 0.03;
        let radius = 1.0 + a + offset;
        [radius * a.cos(), radius * a.sin()]
    };
    (0..half)
        .map(|k| at(k, 0.0))
        .chain((0..half).rev().map(|k| at(k, 2.0)))
        .collect()
}

/// Rims in general position: noise on a wavy circle, from slight to total, with some of the known
/// normals missing.
pub(super) fn arbitrary_rim(len: std::ops::Range<usize>) -> impl Strategy<Value = Rim> {
    let coordinate = || -1.0..1.0_f64;
    let place = (coordinate(), coordinate(), coordinate(), 0_u8..4);
    (prop::collection::vec(place, len), 0.01..2.0_f64).prop_map(|(places, noise)| {
        let mut rim = Rim::wavy(places.len(), 2, 0.3);
        for (i, (x, y, z, known)) in places.into_iter().enumerate() {
            rim.points[i] += noise * Vec3::new(x, y, z);
            if known == 0 {
                rim.normals[i] = None;
            }
        }
        rim
    })
}
