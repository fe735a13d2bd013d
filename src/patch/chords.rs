//! Chords: edges inside a patch between two rim vertices that the mesh round the hole joins already. The stitched mesh
//! would have such an edge twice, so it is split.
//!
//! `O(n log n)` for `n` triangles.

use super::mesh::{Halfedge, PatchMesh};
use super::{HoleShape, PatchSurface};
use crate::error::Result;

/// The chords of `mesh` that the mesh round `hole` has, smaller end first, in the order of their half-edges.
pub(crate) fn joined_chords(mesh: &PatchMesh, hole: &HoleShape) -> Vec<(u32, u32)> {
    let ends = |h: Halfedge| {
        let (a, b) = (mesh.origin(h), mesh.target(h));
        (a.min(b), a.max(b))
    };
    let edges = mesh.interior_edges().map(ends);
    edges.filter(|&(a, b)| hole.is_joined(a, b)).collect()
}

/// Splits `chords` of `surface` in the middle, in their order, and returns the triangulation.
///
/// Each of the two triangles of a chord keeps its number and the half of the chord that it runs into first:
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
///
/// # Errors
/// Those of [`PatchMesh::new`].
pub(crate) fn split_chords(
    surface: &mut PatchSurface,
    choose: impl FnOnce(&PatchMesh) -> Vec<(u32, u32)>,
) -> Result<PatchMesh> {
    let triangles = std::mem::take(&mut surface.triangles);
    let mut mesh = PatchMesh::new(triangles, surface.points.len(), surface.rim_count)?;
    for (a, b) in choose(&mesh) {
        let Some(h) = mesh.edge_between(a, b) else {
            continue;
        };
        let Some(g) = mesh.opposite(h) else { continue };
        let (h, g) = (h.min(g), h.max(g));
        let (t, u, added) = (h / 3, g / 3, mesh.triangles().len() as u32);
        let ends = [a, b].map(|v| surface.points[v as usize]);
        surface.points.push((ends[0] + ends[1]) / 2.0);
        mesh.split(h, g);
        mesh.place(h, t);
        // The triangles on the side of `g` change numbers.
        mesh.place(3 * (added + 1), u);
        mesh.place(3 * (added + 1) + g % 3, added + 1);
    }
    Ok(mesh)
}
