//! Decides which side of each connected piece is outside, when no normals are given.
//!
//! A piece is oriented so that the volume between it and the centroid of its area is positive: its normals point away
//! from the middle, whether it is closed or not. A flat piece, which has no volume, is oriented so that the largest
//! component of its vector area is positive. So a sheet over the xy-plane faces up.
//!
//! Complexity: linear.

use crate::math::{Vec3, cross_normal};

/// A piece is flat if its volume, divided by (area)^1.5, is below this. A sphere has 0.094.
const FLAT_VOLUME: f64 = 1e-6;

/// Orients the triangles of each piece outward.
///
/// Pieces are connected across vertices; each must be oriented consistently.
pub(super) fn face_outward(points: &[Vec3], triangles: &mut [[u32; 3]]) {
    let pieces = pieces(points.len(), triangles);
    let count = pieces.iter().max().map_or(0, |&last| last as usize + 1);
    let mut moments = vec![Moments::default(); count];
    for (t, &piece) in triangles.iter().zip(&pieces) {
        moments[piece as usize].add(t.map(|v| points[v as usize]));
    }
    for (t, &piece) in triangles.iter_mut().zip(&pieces) {
        if moments[piece as usize].faces_inward() {
            t.swap(1, 2);
        }
    }
}

/// Sums over the triangles of a piece, for its volume and its vector area.
#[derive(Clone, Default)]
struct Moments {
    area: f64,
    area_centroid: Vec3,
    vector_area: Vec3,
    volume: f64,
}

impl Moments {
    fn add(&mut self, [a, b, c]: [Vec3; 3]) {
        let vector = cross_normal(&a, &b, &c) / 2.0;
        let area = vector.norm();
        self.area += area;
        self.area_centroid += (a + b + c) / 3.0 * area;
        self.vector_area += vector;
        self.volume += a.dot(&vector) / 3.0;
    }

    fn faces_inward(&self) -> bool {
        if self.area <= 0.0 {
            return false;
        }
        let centroid = self.area_centroid / self.area;
        let volume = self.volume - centroid.dot(&self.vector_area) / 3.0;
        if volume.abs() > FLAT_VOLUME * self.area.powf(1.5) {
            return volume < 0.0;
        }
        self.vector_area[self.vector_area.iamax()] < 0.0
    }
}

/// The number of each triangle's piece. Pieces are numbered in the order of their first triangles.
pub(super) fn pieces(vertex_count: usize, triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut parents: Vec<u32> = (0..vertex_count as u32).collect();
    for &[a, b, c] in triangles {
        for v in [b, c] {
            let (root, other) = (find(&mut parents, a), find(&mut parents, v));
            parents[root.max(other) as usize] = root.min(other);
        }
    }
    let mut numbers = vec![None; vertex_count];
    let mut count = 0;
    triangles
        .iter()
        .map(|t| {
            *numbers[find(&mut parents, t[0]) as usize].get_or_insert_with(|| {
                count += 1;
                count - 1
            })
        })
        .collect()
}

fn find(parents: &mut [u32], mut v: u32) -> u32 {
    while parents[v as usize] != v {
        let above = parents[parents[v as usize] as usize];
        parents[v as usize] = above;
        v = above;
    }
    v
}
