//! All boundary loops of a mesh, each of them simple.

use super::boundary_loop::{BoundaryLoop, LoopClass, measure_points};
use super::classify::classify;
use crate::math::Vec3;
use crate::mesh::halfedge::{BOUNDARY, NON_MANIFOLD, origin, previous, target};
use crate::mesh::rings::{FanEnd, walk_fan};
use crate::mesh::trimesh::TriMesh;
use std::collections::BTreeMap;

/// The boundary of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoundaryLoops {
    /// All loops, ordered by the lowest halfedge that each contains (that is by the lowest triangle along
    /// it, and in this triangle by corner). Each loop starts with that halfedge.
    pub loops: Vec<BoundaryLoop>,
}

impl BoundaryLoops {
    /// Finds all boundary loops of `mesh`.
    ///
    /// The boundary is followed through the triangles round each vertex; where two fans of triangles meet
    /// in a vertex, it goes on with the other fan, so that a hole is followed and not a sheet. Where it
    /// visits a vertex twice it is cut there, so that every loop is simple: two holes that touch in a
    /// vertex are two loops. Where it runs into an edge with three or more triangles it cannot be followed; such a
    /// piece is listed with [`LoopClass::OpenChain`].
    ///
    /// # Complexity
    /// O(b log b) for `b` boundary edges, plus the triangles at their vertices and those of islands; no pass
    /// over the mesh.
    #[must_use]
    pub fn find(mesh: &TriMesh) -> Self {
        let boundary = mesh.connectivity().boundary_halfedges();
        let mut visited = vec![false; boundary.len()];
        let mut chains = Vec::new();
        for (i, &start) in boundary.iter().enumerate() {
            if visited[i] {
                continue;
            }
            let chain = follow(mesh, start);
            for edge in &chain.edges {
                if let Ok(k) = boundary.binary_search(&edge.halfedge) {
                    visited[k] = true;
                }
            }
            if chain.is_closed {
                split_at_repeated_vertices(chain, &mut chains);
            } else {
                chains.push(chain);
            }
        }
        for chain in chains.iter_mut().filter(|c| c.is_closed) {
            let count = chain.edges.len();
            let lowest = (0..count)
                .min_by_key(|&i| chain.edges[i].halfedge)
                .unwrap_or(0);
            chain.edges.rotate_left(lowest);
            let first = chain.edges[0];
            if origin(mesh.triangles(), first.halfedge) != first.from {
                reverse(mesh, chain);
            }
        }
        chains.sort_by_key(|c| c.edges.iter().map(|e| e.halfedge).min());
        let mut loops: Vec<BoundaryLoop> = chains
            .iter()
            .enumerate()
            .map(|(id, chain)| measure(mesh, id, chain))
            .collect();
        classify(mesh, &mut loops);
        Self { loops }
    }

    /// The loop that contains the directed boundary edge `edge`, as in its triangle.
    #[must_use]
    pub fn with_edge(&self, edge: [u32; 2]) -> Option<&BoundaryLoop> {
        self.loops
            .iter()
            .find(|l| (0..l.edge_count()).any(|i| l.directed_edge(i) == edge))
    }
}

/// A boundary edge as it is passed when the boundary is followed.
#[derive(Clone, Copy, Debug)]
struct ChainEdge {
    halfedge: u32,
    /// Vertex where the edge is entered: its halfedge's origin, unless the triangles along the boundary
    /// are not oriented alike.
    from: u32,
}

#[derive(Debug)]
struct Chain {
    edges: Vec<ChainEdge>,
    is_closed: bool,
}

fn other_end(mesh: &TriMesh, halfedge: u32, vertex: u32) -> u32 {
    let start = origin(mesh.triangles(), halfedge);
    if start == vertex {
        target(mesh.triangles(), halfedge)
    } else {
        start
    }
}

/// The boundary edge with which the boundary goes on at `vertex` after the edge of `halfedge`; `None` when
/// it runs into an edge with more than two triangles.
///
/// That is the other end of the triangles round the vertex. But where exactly two fans of triangles meet
/// in the vertex, it is the end of the other fan, so that the hole between them is followed.
fn next_boundary_edge(mesh: &TriMesh, vertex: u32, halfedge: u32) -> Option<u32> {
    let connectivity = mesh.connectivity();
    let end = match walk_fan(mesh, vertex, halfedge, |_| {}) {
        FanEnd::At(end) if connectivity.twin(end) == BOUNDARY => end,
        _ => return None,
    };
    let mut ends = [Vec::new(), Vec::new()];
    for o in connectivity.outgoing(vertex) {
        for (side, h) in [(0, o.halfedge), (1, previous(o.halfedge))] {
            match connectivity.twin(h) {
                // Of more than two fans none is the other one: there is no need to look at them all.
                BOUNDARY if ends[side].len() == 2 => return Some(end),
                BOUNDARY => ends[side].push(h),
                NON_MANIFOLD => return Some(end),
                _ => {}
            }
        }
    }
    let side = usize::from(!ends[0].contains(&end));
    let is_oriented = ends[side].contains(&end) && ends[1 - side].contains(&halfedge);
    match ends[side][..] {
        [a, b] if is_oriented && ends[1 - side].len() == 2 => Some(if a == end { b } else { a }),
        _ => Some(end),
    }
}

/// Follows the boundary from the halfedge `start` forwards, and backwards too if it is not closed.
fn follow(mesh: &TriMesh, start: u32) -> Chain {
    let from = origin(mesh.triangles(), start);
    let mut edges = vec![ChainEdge {
        halfedge: start,
        from,
    }];
    let leave = |halfedge: u32, vertex: u32, edges: &mut Vec<ChainEdge>| {
        let (mut halfedge, mut vertex) = (halfedge, vertex);
        loop {
            let Some(h) = next_boundary_edge(mesh, vertex, halfedge) else {
                return false;
            };
            if h == start {
                return true;
            }
            edges.push(ChainEdge {
                halfedge: h,
                from: vertex,
            });
            (halfedge, vertex) = (h, other_end(mesh, h, vertex));
        }
    };
    let is_closed = leave(start, other_end(mesh, start, from), &mut edges);
    if !is_closed {
        let mut before = Vec::new();
        leave(start, from, &mut before);
        before.reverse();
        turn(mesh, &mut before);
        before.append(&mut edges);
        edges = before;
    }
    Chain { edges, is_closed }
}

/// Passes each of the edges the other way.
fn turn(mesh: &TriMesh, edges: &mut [ChainEdge]) {
    for e in edges {
        e.from = other_end(mesh, e.halfedge, e.from);
    }
}

/// Runs a closed chain the other way round, from the same first edge.
fn reverse(mesh: &TriMesh, chain: &mut Chain) {
    chain.edges[1..].reverse();
    turn(mesh, &mut chain.edges);
}

/// Cuts a closed chain at the vertices that it visits more than once.
fn split_at_repeated_vertices(chain: Chain, simple: &mut Vec<Chain>) {
    let mut sorted: Vec<u32> = chain.edges.iter().map(|e| e.from).collect();
    sorted.sort_unstable();
    if sorted.windows(2).all(|w| w[0] != w[1]) {
        simple.push(chain);
        return;
    }
    let mut path: Vec<ChainEdge> = Vec::new();
    let mut place_of = BTreeMap::new();
    for edge in chain.edges {
        if let Some(&place) = place_of.get(&edge.from) {
            let cut = path.split_off(place);
            for e in &cut {
                place_of.remove(&e.from);
            }
            simple.push(Chain {
                edges: cut,
                is_closed: true,
            });
        }
        place_of.insert(edge.from, path.len());
        path.push(edge);
    }
    simple.push(Chain {
        edges: path,
        is_closed: true,
    });
}

fn measure(mesh: &TriMesh, id: usize, chain: &Chain) -> BoundaryLoop {
    let halfedges: Vec<u32> = chain.edges.iter().map(|e| e.halfedge).collect();
    let reversed: Vec<usize> = (0..chain.edges.len())
        .filter(|&i| origin(mesh.triangles(), chain.edges[i].halfedge) != chain.edges[i].from)
        .collect();
    let mut vertices: Vec<u32> = chain.edges.iter().map(|e| e.from).collect();
    if let Some(last) = chain.edges.last().filter(|_| !chain.is_closed) {
        vertices.push(other_end(mesh, last.halfedge, last.from));
    }
    let points: Vec<Vec3> = vertices.iter().map(|&v| mesh.point(v)).collect();
    BoundaryLoop {
        id,
        class: match (chain.is_closed, reversed.is_empty()) {
            (false, _) => LoopClass::OpenChain,
            (true, false) => LoopClass::NotOriented,
            (true, true) => LoopClass::Simple,
        },
        reversed,
        ..measure_points(vertices, &points, halfedges)
    }
}
