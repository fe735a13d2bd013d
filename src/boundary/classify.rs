//! What kind of boundary a loop is: a hole, a hole that touches another, a loose island, an outer rim.

use super::boundary_loop::{BoundaryLoop, LoopClass};
use crate::job::Job;
use crate::math::aabb::Aabb;
use crate::math::box_tree::BoxTree;
use crate::math::frame::axes_across;
use crate::math::{Vec3, cross_normal, unit};
use crate::mesh::halfedge::{BOUNDARY, DEGENERATE};
use crate::mesh::trimesh::TriMesh;
use std::collections::BTreeSet;

/// A loop counts as an outer rim when the mean cosine between its vector area and the normals along it is
/// above this; a flat sheet has 1.
const OUTER_RIM_ALIGNMENT: f64 = 0.5;
/// A sheet with more triangles than this per squared rim edge is not taken for an island.
const ISLAND_FACES_PER_SQUARED_EDGE: usize = 8;
/// An island's rim lies within the box of the hole, enlarged by this share of its diagonal: that is how high
/// half a sphere stands over its rim.
const ISLAND_BOX_MARGIN: f64 = 0.36;

/// Sets the class of every closed, oriented loop.
///
/// O(n log n) in the number of loops, linear in the triangles along them and in those of the islands; an island
/// costs its edges times those of the holes whose box it lies in.
pub(super) fn classify(mesh: &TriMesh, loops: &mut [BoundaryLoop]) {
    mark_touching(loops);
    let alignments: Vec<f64> = loops.iter().map(|l| outer_rim_alignment(mesh, l)).collect();
    for (l, &alignment) in loops.iter_mut().zip(&alignments) {
        if is_closed(l) && alignment > OUTER_RIM_ALIGNMENT {
            l.class = LoopClass::OuterRim;
        }
    }
    let hosts = Hosts::among(loops);
    let is_candidate = |l: &BoundaryLoop| is_closed(l) && alignments[l.id] > 0.0;
    let mut islands = Vec::new();
    for island in loops.iter().filter(|l| is_candidate(l)) {
        // The sheet is looked at last: that costs the most.
        let around = hosts.around(loops, island);
        let host = around
            .into_iter()
            .find(|&host| spans_over(mesh, &loops[host], island));
        if let Some(host) = host.filter(|_| bounds_small_sheet(mesh, island)) {
            islands.push((island.id, host));
        }
    }
    for (island, host) in islands {
        loops[island].class = LoopClass::Island;
        loops[island].host = Some(host);
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

/// The loops that an island may lie in.
struct Hosts {
    ids: Vec<usize>,
    /// Boxes within which the islands of each host lie.
    boxes: Vec<Aabb>,
    tree: BoxTree,
}

impl Hosts {
    fn among(loops: &[BoundaryLoop]) -> Self {
        let is_host = |l: &&BoundaryLoop| is_closed(l) && l.class != LoopClass::OuterRim;
        let hosts = || loops.iter().filter(is_host);
        let boxes: Vec<Aabb> = hosts()
            .map(|l| l.bounds.grown(ISLAND_BOX_MARGIN * l.diameter))
            .collect();
        Self {
            ids: hosts().map(|l| l.id).collect(),
            tree: BoxTree::build(boxes.len(), |i| boxes[i], &Job::unlimited())
                .expect("nothing stops it"),
            boxes,
        }
    }

    /// The hosts whose box holds the island and whose perimeter is longer, the shortest first.
    fn around(&self, loops: &[BoundaryLoop], island: &BoundaryLoop) -> Vec<usize> {
        let bounds = &island.bounds;
        let mut near = Vec::new();
        self.tree.overlapping(bounds, &mut near);
        let mut hosts: Vec<usize> = near
            .iter()
            .filter(|&&i| self.boxes[i as usize].contains(bounds))
            .map(|&i| self.ids[i as usize])
            .filter(|&id| id != island.id && loops[id].perimeter > island.perimeter)
            .collect();
        hosts.sort_by(|&a, &b| {
            loops[a]
                .perimeter
                .total_cmp(&loops[b].perimeter)
                .then(a.cmp(&b))
        });
        hosts
    }
}

/// Whether a surface across the hole of `host` would pass through the sheet of `island` and face the same
/// way: seen along the host's vector area, the island lies within the host's outline.
fn spans_over(mesh: &TriMesh, host: &BoundaryLoop, island: &BoundaryLoop) -> bool {
    let area = Vec3::from(host.vector_area);
    // The triangles round a hole run round it the other way than those of a sheet inside it.
    if area.dot(&Vec3::from(island.vector_area)) >= 0.0 {
        return false;
    }
    let across = unit(area);
    let [right, up] = axes_across(&across);
    let project = |&v: &u32| {
        let p = mesh.point(v);
        [p.dot(&right), p.dot(&up)]
    };
    let outline: Vec<[f64; 2]> = host.vertices.iter().map(project).collect();
    let is_within = |v: &u32| {
        let [x, y] = project(v);
        let mut is_inside = false;
        for (i, &[ax, ay]) in outline.iter().enumerate() {
            let [bx, by] = outline[(i + 1) % outline.len()];
            if (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax) {
                is_inside = !is_inside;
            }
        }
        is_inside || host.vertices.contains(v)
    };
    island.vertices.iter().all(is_within)
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxed_loop(id: usize, low: [i32; 3], size: [i32; 3], class: LoopClass) -> BoundaryLoop {
        let low = Vec3::from(low.map(f64::from));
        let extent = Vec3::from(size.map(f64::from));
        BoundaryLoop {
            id,
            vertices: Vec::new(),
            perimeter: extent.sum(),
            vector_area: [0.0; 3],
            diameter: extent.norm(),
            planarity: 0.0,
            class,
            halfedges: Vec::new(),
            reversed: Vec::new(),
            host: None,
            bounds: Aabb {
                lo: low,
                hi: low + extent,
            },
        }
    }

    fn any_loops() -> impl Strategy<Value = Vec<BoundaryLoop>> {
        let class = prop_oneof![
            Just(LoopClass::Simple),
            Just(LoopClass::Touching),
            Just(LoopClass::OuterRim),
            Just(LoopClass::OpenChain),
        ];
        let corner = || [0..8_i32, 0..8, 0..8];
        proptest::collection::vec((corner(), corner(), class), 1..60).prop_map(|raw| {
            let loops = raw.into_iter().enumerate();
            loops
                .map(|(id, (low, size, class))| boxed_loop(id, low, size, class))
                .collect()
        })
    }

    /// The host by looking at all loops, as the islands' rule says it.
    fn host_by_rule(loops: &[BoundaryLoop], island: &BoundaryLoop) -> Option<usize> {
        let holds = |host: &&BoundaryLoop| {
            let margin = ISLAND_BOX_MARGIN * host.diameter;
            matches!(host.class, LoopClass::Simple | LoopClass::Touching)
                && host.perimeter > island.perimeter
                && (0..3).all(|k| {
                    island.bounds.lo[k] >= host.bounds.lo[k] - margin
                        && island.bounds.hi[k] <= host.bounds.hi[k] + margin
                })
        };
        let hosts = loops.iter().filter(holds);
        hosts
            .min_by(|a, b| a.perimeter.total_cmp(&b.perimeter))
            .map(|host| host.id)
    }

    proptest! {
        #[test]
        fn the_first_host_is_the_shortest_loop_whose_box_holds_the_island(loops in any_loops()) {
            let hosts = Hosts::among(&loops);
            for island in &loops {
                prop_assert_eq!(
                    hosts.around(&loops, island).first().copied(),
                    host_by_rule(&loops, island)
                );
            }
        }
    }
}
