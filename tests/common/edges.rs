//! The edges of a mesh, counted one by one.
#![allow(dead_code, reason = "each test program uses a part of it")]

use std::collections::BTreeMap;

/// How many triangles each edge has, whatever their direction: counted one by one.
fn edge_counts(triangles: &[[u32; 3]]) -> BTreeMap<[u32; 2], Vec<bool>> {
    let mut counts: BTreeMap<[u32; 2], Vec<bool>> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for (v, w) in [(a, b), (b, c), (c, a)] {
            counts.entry([v.min(w), v.max(w)]).or_default().push(v < w);
        }
    }
    counts
}

/// Whether each edge has one triangle, or two that run along it in opposite directions.
pub(crate) fn is_oriented_manifold(triangles: &[[u32; 3]]) -> bool {
    edge_counts(triangles)
        .values()
        .all(|ways| ways.len() == 1 || (ways.len() == 2 && ways[0] != ways[1]))
}

pub(crate) fn boundary_edges(triangles: &[[u32; 3]]) -> usize {
    let counts = edge_counts(triangles);
    counts.values().filter(|ways| ways.len() == 1).count()
}
