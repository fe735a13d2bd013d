//! Chords: edges inside a patch between two rim vertices that the mesh round the hole joins already. The stitched mesh
//! would have such an edge twice, so it is split.
//!
//! `O(n log n)` for `n` triangles.

use super::mesh::{Halfedge, PatchMesh};
use crate::hole::Hole;
use crate::math::Vec3;

/// The chords of `mesh` that the mesh round `hole` has, smaller end first, in the order of their half-edges.
pub(crate) fn joined_chords(mesh: &PatchMesh, hole: &Hole) -> Vec<(u32, u32)> {
    let ends = |h: Halfedge| {
        let (a, b) = (mesh.origin(h), mesh.target(h));
        (a.min(b), a.max(b))
    };
    let edges = mesh.interior_edges().map(ends);
    edges.filter(|&(a, b)| hole.is_joined(a, b)).collect()
}

/// Splits the edge of `h` and its opposite `g` in the middle.
///
/// Each of the two triangles keeps its number and the half of the edge that its half-edge runs through first; what is
/// left of that of `h` is appended, then what is left of that of `g`:
///
/// ```text
///       c                  c
///     /   \              / | \
///    /  t  \            / t | t'\
///    a -----> b   =>   a --v-- b
///    \  u  /            \ u'| u /
///     \   /              \ | /
///       d                  d
/// ```
pub(crate) fn split_middle(mesh: &mut PatchMesh, points: &mut Vec<Vec3>, h: Halfedge, g: Halfedge) {
    let (t, u, added) = (h / 3, g / 3, mesh.triangles().len() as u32);
    let ends = [h, g].map(|h| points[mesh.origin(h) as usize]);
    points.push((ends[0] + ends[1]) / 2.0);
    mesh.split(h, g);
    mesh.place(h, t);
    // The triangles on the side of `g` change numbers.
    mesh.place(3 * (added + 1), u);
    mesh.place(3 * (added + 1) + g % 3, added + 1);
}

/// Splits in the middle every chord of `mesh` that the mesh round `hole` has, triangle after triangle.
pub(crate) fn split_joined_chords(mesh: &mut PatchMesh, points: &mut Vec<Vec3>, hole: &Hole) {
    let mut t = 0;
    while t < mesh.triangles().len() as u32 {
        let chord = (3 * t..3 * t + 3).find_map(|h| {
            let g = mesh.opposite(h)?;
            hole.is_joined(mesh.origin(h), mesh.target(h))
                .then_some((h, g))
        });
        if let Some((h, g)) = chord {
            split_middle(mesh, points, h, g);
        }
        t += 1;
    }
}
