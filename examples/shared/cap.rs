//! A sphere without a cap, of any resolution.

use holefill::TriMesh;
use std::f64::consts::TAU;

/// A unit sphere without a cap round its pole. Meridians and parallels have the same spacing at the equator. The
/// vertices of the rim come first, then those of the parallels.
pub(crate) fn sphere_without_cap(meridians: usize, degrees: usize) -> TriMesh {
    let rows = meridians / 2;
    let first = rows * degrees / 180;
    let at = |row: usize, i: usize| {
        let (theta, phi) = (
            TAU / 2.0 * row as f64 / rows as f64,
            TAU * i as f64 / meridians as f64,
        );
        [
            theta.sin() * phi.cos(),
            theta.sin() * phi.sin(),
            theta.cos(),
        ]
    };
    let parallels = first..rows;
    let mut positions: Vec<[f64; 3]> = parallels
        .clone()
        .flat_map(|row| (0..meridians).map(move |i| at(row, i)))
        .collect();
    positions.push([0.0, 0.0, -1.0]);
    let mut triangles = Vec::new();
    for row in parallels {
        let v = |row: usize, i: usize| match row == rows {
            true => ((rows - first) * meridians) as u32,
            false => ((row - first) * meridians + i % meridians) as u32,
        };
        for i in 0..meridians {
            triangles.push([v(row, i), v(row + 1, i), v(row, i + 1)]);
            if row + 1 < rows {
                triangles.push([v(row, i + 1), v(row + 1, i), v(row + 1, i + 1)]);
            }
        }
    }
    TriMesh::new(positions, triangles).expect("a sphere is a mesh")
}
