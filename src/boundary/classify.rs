//! What kind of boundary a loop is: a hole, a hole that touches another, a loose island, an outer rim.

use super::loops::BoundaryLoop;
use crate::math::{Vec3, cross_normal};
use crate::mesh::connectivity::{BOUNDARY, DEGENERATE};
use crate::mesh::trimesh::TriMesh;
use std::collections::BTreeSet;
use std::fmt;

/// A loop counts as an outer rim when the mean cosine between its vector area and the normals along it is
/// above this; a flat sheet has 1.
const OUTER_RIM_ALIGNMENT: f64 = 0.5;
/// A sheet with more triangles than this per squared rim edge is not taken for an island.
const ISLAND_FACES_PER_SQUARED_EDGE: usize = 8;
/// An island's rim lies within the box of the hole, enlarged by this share of its diagonal.
const ISLAND_BOX_MARGIN: f64 = 0.1;

/// The kind of a boundary loop.
///
/// [`LoopClass::Island`] and [`LoopClass::OuterRim`] are judgements from geometry, meant as advice; they
/// can be wrong on strongly curved sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum LoopClass {
    /// The rim of a hole that touches no other loop.
    Simple,
    /// The rim of a hole that shares a vertex with another loop.
    Touching,
    /// The rim of a small sheet of its own that lies inside the hole of another loop.
    Island,
    /// The outer rim of an open sheet.
    OuterRim,
    /// The triangles along the loop are not oriented alike; it cannot be filled.
    NotOriented,
    /// The boundary runs into an edge with more than two triangles and does not close; it cannot be
    /// filled.
    OpenChain,
}

impl LoopClass {
    /// The name used in tables and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Simple => "simple",
            Self::Touching => "touching",
            Self::Island => "island",
            Self::OuterRim => "outer-rim",
            Self::NotOriented => "not-oriented",
            Self::OpenChain => "open-chain",
        }
    }
}

impl fmt::Display for LoopClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Sets the class of every closed, oriented loop.
pub(super) fn classify(mesh: &TriMesh, loops: &mut [BoundaryLoop]) {
    mark_touching(loops);
    for l in loops.iter_mut().filter(|l| is_closed(l)) {
        if outer_rim_alignment(mesh, l) > OUTER_RIM_ALIGNMENT {
            l.class = LoopClass::OuterRim;
        }
    }
    let hosts: Vec<Option<usize>> = (0..loops.len())
        .map(|i| host_of_island(mesh, loops, i))
        .collect();
    for (l, host) in loops.iter_mut().zip(hosts) {
        if host.is_some() {
            l.class = LoopClass::Island;
            l.host = host;
        }
    }
}

fn is_closed(l: &BoundaryLoop) -> bool {
    !matches!(l.class, LoopClass::OpenChain | LoopClass::NotOriented)
}

fn mark_touching(loops: &mut [BoundaryLoop]) {
    let mut uses: Vec<(u32, usize)> = loops
        .iter()
        .flat_map(|l| l.vertices.iter().map(|&v| (v, l.id)))
        .collect();
    uses.sort_unstable();
    let shared: Vec<usize> = uses
        .windows(2)
        .filter(|w| w[0].0 == w[1].0 && w[0].1 != w[1].1)
        .flat_map(|w| [w[0].1, w[1].1])
        .collect();
    for id in shared {
        if is_closed(&loops[id]) {
            loops[id].class = LoopClass::Touching;
        }
    }
}

/// The mean cosine between the vector area and the normals of the triangles along the loop, by area: near
/// 1 when a flat sheet lies inside the loop, near -1 when it lies outside, that is round a hole, and 0 at
/// the end of a tube.
fn outer_rim_alignment(mesh: &TriMesh, l: &BoundaryLoop) -> f64 {
    let mut normal = Vec3::zeros();
    let mut double_area = 0.0;
    for &h in &l.halfedges {
        let [a, b, c] = mesh.corners(h / 3);
        let n = cross_normal(&a, &b, &c);
        normal += n;
        double_area += n.norm();
    }
    let area = Vec3::from(l.vector_area);
    let scale = double_area * area.norm();
    if scale > 0.0 {
        normal.dot(&area) / scale
    } else {
        0.0
    }
}

/// The loop whose hole the island `candidate` lies in.
///
/// The candidate must bound a small sheet with no other boundary, and lie inside the bounding box of
/// exactly such a hole; among several the one with the shortest perimeter is meant.
fn host_of_island(mesh: &TriMesh, loops: &[BoundaryLoop], candidate: usize) -> Option<usize> {
    let island = &loops[candidate];
    if !is_closed(island) || outer_rim_alignment(mesh, island) <= 0.0 {
        return None;
    }
    let hosts = loops.iter().filter(|host| {
        let margin = ISLAND_BOX_MARGIN * host.diameter;
        host.id != candidate
            && is_closed(host)
            && host.perimeter > island.perimeter
            && host.class != LoopClass::OuterRim
            && (0..3).all(|k| {
                island.low[k] >= host.low[k] - margin && island.high[k] <= host.high[k] + margin
            })
    });
    let host = hosts.min_by(|a, b| a.perimeter.total_cmp(&b.perimeter))?.id;
    bounds_small_sheet(mesh, island).then_some(host)
}

/// Whether the triangles that hang together with the loop are few and have no other boundary.
fn bounds_small_sheet(mesh: &TriMesh, l: &BoundaryLoop) -> bool {
    let limit = ISLAND_FACES_PER_SQUARED_EDGE * l.edge_count() * l.edge_count();
    let mut seen = BTreeSet::from([l.halfedges[0] / 3]);
    let mut queue = vec![l.halfedges[0] / 3];
    let mut boundary_edges = 0;
    while let Some(face) = queue.pop() {
        for h in 3 * face..3 * face + 3 {
            let link = mesh.connectivity().twin(h);
            if link == BOUNDARY {
                boundary_edges += 1;
            } else if link < DEGENERATE && seen.insert(link / 3) {
                queue.push(link / 3);
            }
        }
        if seen.len() > limit || boundary_edges > l.edge_count() {
            return false;
        }
    }
    boundary_edges == l.edge_count()
}
