//! Which known vertex and triangle a new one is nearest to, along the patch.
//!
//! Fronts start at the rim and pass from neighbour to neighbour, nearest first, where near means the straight
//! distance to the place the front came from: what lies across a gap is not nearer than what lies along the
//! surface. O(n log n) for n vertices or triangles.

use crate::error::Result;
use crate::fill::cut::MeshPlace;
use crate::hole::Hole;
use crate::job::Job;
use crate::math::Vec3;
use crate::math::adjacency::CompressedRows;
use crate::patch::PatchSurface;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// For each interior vertex the mesh vertex on the rim that it is nearest to.
///
/// # Errors
/// `Cancelled` when the job is stopped.
pub(super) fn nearest_rim_vertices(
    place: &MeshPlace,
    surface: &PatchSurface,
    job: &Job<'_>,
) -> Result<Vec<u32>> {
    let count = surface.points.len();
    let neighbors = CompressedRows::corners(&surface.triangles, count);
    job.ask()?;
    let mut fronts = Fronts::new(count);
    for v in 0..surface.rim_count as u32 {
        fronts.source[v as usize] = Some(v);
    }
    let sources = fronts.spread(
        (0..surface.rim_count as u32).collect(),
        |v, visit| neighbors.of(v).iter().for_each(|&w| visit(w)),
        |v, source| surface.points[v as usize] - surface.points[source as usize],
    );
    let new = sources[surface.rim_count..].iter();
    Ok(new.map(|s| place.rim[s.unwrap_or(0) as usize]).collect())
}

/// For each triangle the mesh triangle along the rim that it is nearest to. A triangle with an edge on the rim
/// has that edge's.
pub(super) fn nearest_rim_faces(
    hole: &Hole,
    place: &MeshPlace,
    surface: &PatchSurface,
) -> Vec<u32> {
    let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * surface.triangles.len());
    for (f, t) in surface.triangles.iter().enumerate() {
        edges.extend((0..3).map(|k| (t[k], t[(k + 1) % 3], f as u32)));
    }
    edges.sort_unstable();
    let face_at = |a: u32, b: u32| {
        let i = edges.partition_point(|&(x, y, _)| (x, y) < (a, b));
        edges.get(i).filter(|e| (e.0, e.1) == (a, b)).map(|e| e.2)
    };
    let polygon = &hole.polygon;
    let rim_edge = |i: usize| (polygon[i], polygon[(i + 1) % polygon.len()]);
    let mut fronts = Fronts::new(surface.triangles.len());
    let mut seeds = Vec::new();
    for (i, &is_bridge) in hole.is_bridge.iter().enumerate() {
        let (a, b) = rim_edge(i);
        if let Some(face) = face_at(a, b)
            && !is_bridge
            && fronts.source[face as usize].is_none()
        {
            fronts.source[face as usize] = Some(i as u32);
            seeds.push(face);
        }
    }
    let sources = fronts.spread(
        seeds,
        |f, visit| {
            let t = surface.triangles[f as usize];
            let around = (0..3).filter_map(|k| face_at(t[(k + 1) % 3], t[k]));
            around.for_each(visit);
        },
        |f, i| {
            let corners = surface.triangles[f as usize].map(|v| surface.points[v as usize]);
            let (a, b) = rim_edge(i as usize);
            let middle = (surface.points[a as usize] + surface.points[b as usize]) / 2.0;
            corners.iter().sum::<Vec3>() / 3.0 - middle
        },
    );
    sources
        .into_iter()
        .map(|i| i.and_then(|i| place.outside_faces[i as usize]).unwrap_or(0))
        .collect()
}

/// The place that each element was reached from.
struct Fronts {
    source: Vec<Option<u32>>,
}

impl Fronts {
    fn new(count: usize) -> Self {
        Self {
            source: vec![None; count],
        }
    }

    /// Spreads the sources of `seeds` to all elements that are connected to them. `neighbours(e, visit)` calls
    /// `visit` with the elements next to `e`; `offset(e, s)` leads from source `s` to element `e`.
    fn spread(
        mut self,
        seeds: Vec<u32>,
        neighbours: impl Fn(u32, &mut dyn FnMut(u32)),
        offset: impl Fn(u32, u32) -> Vec3,
    ) -> Vec<Option<u32>> {
        // Squares of lengths are not negative: their bits are ordered as they are.
        let mut queue: BinaryHeap<Reverse<(u64, u32, u32)>> = BinaryHeap::new();
        let push = |element: u32, source: u32, queue: &mut BinaryHeap<_>| {
            let distance_sq = offset(element, source).norm_squared();
            queue.push(Reverse((distance_sq.to_bits(), element, source)));
        };
        for seed in seeds {
            if let Some(source) = self.source[seed as usize] {
                let of_patch = &self.source;
                neighbours(seed, &mut |e| {
                    if of_patch[e as usize].is_none() {
                        push(e, source, &mut queue);
                    }
                });
            }
        }
        while let Some(Reverse((_, element, source))) = queue.pop() {
            if self.source[element as usize].is_some() {
                continue;
            }
            self.source[element as usize] = Some(source);
            let known = &self.source;
            neighbours(element, &mut |e| {
                if known[e as usize].is_none() {
                    push(e, source, &mut queue);
                }
            });
        }
        self.source
    }
}
