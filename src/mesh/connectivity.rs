//! Which triangle lies on the other side of which edge: connectivity without coordinates.
//!
//! Halfedge `3 * f + k` runs from corner `k` of triangle `f` to corner `(k + 1) % 3`. Halfedges are
//! matched within per-vertex buckets made by a counting sort, so the cost is linear in the number of
//! triangles and no hash table is involved. Vertices of very high valence have their bucket sorted.

use super::defects::MeshDefects;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Link of a halfedge whose edge has one triangle.
pub(crate) const BOUNDARY: u32 = u32::MAX;
/// Link of a halfedge whose edge has three or more triangles.
pub(crate) const NON_MANIFOLD: u32 = u32::MAX - 1;
/// Link of the halfedges of a triangle that names a vertex twice; such a triangle has no neighbours.
pub(crate) const DEGENERATE: u32 = u32::MAX - 2;

/// Buckets longer than this are sorted and searched by bisection.
const LINEAR_SEARCH_LIMIT: usize = 48;
/// Triangles handled by one task.
const FACE_CHUNK: usize = 1 << 15;

/// A halfedge as seen from the vertex where it starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Outgoing {
    /// Vertex where the halfedge ends.
    pub(crate) target: u32,
    /// The halfedge.
    pub(crate) halfedge: u32,
}

/// Halfedge links and the outgoing halfedges of every vertex.
#[derive(Clone, Debug, Default)]
pub(crate) struct Connectivity {
    twin: Vec<u32>,
    first: Vec<u32>,
    outgoing: Vec<Outgoing>,
    /// Outgoing halfedges of triangles that were appended after the mesh was built.
    appended: BTreeMap<u32, Vec<Outgoing>>,
}

/// The next halfedge in the same triangle.
pub(crate) fn next(halfedge: u32) -> u32 {
    if halfedge % 3 == 2 {
        halfedge - 2
    } else {
        halfedge + 1
    }
}

/// The previous halfedge in the same triangle.
pub(crate) fn previous(halfedge: u32) -> u32 {
    if halfedge.is_multiple_of(3) {
        halfedge + 2
    } else {
        halfedge - 1
    }
}

/// Vertex where `halfedge` starts.
pub(crate) fn origin(triangles: &[[u32; 3]], halfedge: u32) -> u32 {
    triangles[halfedge as usize / 3][halfedge as usize % 3]
}

/// Vertex where `halfedge` ends.
pub(crate) fn target(triangles: &[[u32; 3]], halfedge: u32) -> u32 {
    origin(triangles, next(halfedge))
}

fn is_degenerate(t: &[u32; 3]) -> bool {
    t[0] == t[1] || t[1] == t[2] || t[2] == t[0]
}

impl Connectivity {
    /// Matches the halfedges of `triangles`, whose indices must be below `vertex_count`.
    ///
    /// Linear time and memory; runs on the current thread pool with the same result for any number
    /// of threads.
    pub(crate) fn build(vertex_count: usize, triangles: &[[u32; 3]]) -> (Self, MeshDefects) {
        let mut defects = MeshDefects::default();
        let (first, outgoing) = bucket_outgoing(vertex_count, triangles, &mut defects);
        let mut connectivity = Self {
            twin: vec![DEGENERATE; 3 * triangles.len()],
            first,
            outgoing,
            appended: BTreeMap::new(),
        };
        let mut twin = std::mem::take(&mut connectivity.twin);
        let suspects: Vec<Vec<u32>> = twin
            .par_chunks_mut(3 * FACE_CHUNK)
            .zip(triangles.par_chunks(FACE_CHUNK))
            .enumerate()
            .map(|(chunk, (links, faces))| {
                connectivity.link_faces(chunk * FACE_CHUNK, faces, links)
            })
            .collect();
        connectivity.twin = twin;
        for face in suspects.into_iter().flatten() {
            connectivity.record_suspect(triangles, face, &mut defects);
        }
        (connectivity, defects)
    }

    /// Fills in the links of `faces`; returns those with an edge that is not plainly regular.
    fn link_faces(&self, first_face: usize, faces: &[[u32; 3]], links: &mut [u32]) -> Vec<u32> {
        let mut suspects = Vec::new();
        for (offset, (t, links)) in faces.iter().zip(links.chunks_exact_mut(3)).enumerate() {
            if is_degenerate(t) {
                continue;
            }
            let face = first_face + offset;
            let mut suspect = false;
            for k in 0..3 {
                let halfedge = (3 * face + k) as u32;
                let (link, regular) = self.link_of(t[k], t[(k + 1) % 3], halfedge);
                links[k] = link;
                suspect |= !regular;
            }
            // Two edges shared with one neighbour: the neighbour has the same three vertices.
            suspect |= (0..3).any(|k| {
                let (a, b) = (links[k], links[(k + 1) % 3]);
                a < DEGENERATE && b < DEGENERATE && a / 3 == b / 3
            });
            if suspect {
                suspects.push(face as u32);
            }
        }
        suspects
    }

    /// The link of halfedge `a -> b`, and whether its edge is regular (boundary or two opposite
    /// halfedges).
    fn link_of(&self, a: u32, b: u32, halfedge: u32) -> (u32, bool) {
        let mut opposite = Matches::default();
        opposite.collect(self.built_outgoing(b), a, u32::MAX);
        let mut parallel = Matches::default();
        parallel.collect(self.built_outgoing(a), b, halfedge);
        match (opposite.count, parallel.count) {
            (0, 0) => (BOUNDARY, true),
            (1, 0) => (opposite.any, true),
            (0, 1) => (parallel.any, false),
            _ => (NON_MANIFOLD, false),
        }
    }

    fn record_suspect(&self, triangles: &[[u32; 3]], face: u32, defects: &mut MeshDefects) {
        let t = &triangles[face as usize];
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            let halfedge = 3 * face + k as u32;
            match self.twin[halfedge as usize] {
                NON_MANIFOLD => {
                    let mut lowest = halfedge;
                    for (from, to) in [(a, b), (b, a)] {
                        for o in self.built_outgoing(from).iter().filter(|o| o.target == to) {
                            lowest = lowest.min(o.halfedge);
                        }
                    }
                    if lowest == halfedge {
                        defects.nonmanifold_edges.record([a, b]);
                    }
                }
                link if link < DEGENERATE && origin(triangles, link) == a && halfedge < link => {
                    defects.inconsistent_edges.record([a, b]);
                }
                _ => {}
            }
        }
        let mut key = *t;
        key.sort_unstable();
        let is_same = |other: u32| {
            let mut k = triangles[other as usize];
            k.sort_unstable();
            k == key
        };
        // Every triangle has an outgoing halfedge at each of its corners.
        let earlier = self
            .built_outgoing(key[0])
            .iter()
            .map(|o| o.halfedge / 3)
            .any(|other| other < face && is_same(other));
        if earlier {
            defects.duplicate_faces.record(face);
        }
    }

    fn built_outgoing(&self, vertex: u32) -> &[Outgoing] {
        let v = vertex as usize;
        if v + 1 >= self.first.len() {
            return &[];
        }
        &self.outgoing[self.first[v] as usize..self.first[v + 1] as usize]
    }

    /// All halfedges that start at `vertex`, those of appended triangles last.
    pub(crate) fn outgoing(&self, vertex: u32) -> impl Iterator<Item = Outgoing> + '_ {
        let appended = self.appended.get(&vertex).map_or(&[][..], Vec::as_slice);
        self.built_outgoing(vertex).iter().chain(appended).copied()
    }

    /// The link of `halfedge`: the other halfedge of its edge, or [`BOUNDARY`], [`NON_MANIFOLD`],
    /// [`DEGENERATE`].
    ///
    /// The linked halfedge runs the other way, unless the two triangles are oriented inconsistently.
    pub(crate) fn twin(&self, halfedge: u32) -> u32 {
        self.twin[halfedge as usize]
    }

    /// Number of halfedges.
    pub(crate) fn halfedge_count(&self) -> usize {
        self.twin.len()
    }

    /// All boundary halfedges in ascending order.
    pub(crate) fn boundary_halfedges(&self) -> Vec<u32> {
        self.twin
            .par_chunks(3 * FACE_CHUNK)
            .enumerate()
            .flat_map_iter(|(chunk, links)| {
                let base = (chunk * 3 * FACE_CHUNK) as u32;
                let is_boundary = |&(_, &link): &(usize, &u32)| link == BOUNDARY;
                links
                    .iter()
                    .enumerate()
                    .filter(is_boundary)
                    .map(move |(i, _)| base + i as u32)
            })
            .collect()
    }

    /// Whether some triangle has the edge `{a, b}`.
    pub(crate) fn has_edge(&self, a: u32, b: u32) -> bool {
        self.outgoing(a).any(|o| o.target == b) || self.outgoing(b).any(|o| o.target == a)
    }

    /// Whether some triangle has exactly these three vertices.
    pub(crate) fn has_face(&self, triangles: &[[u32; 3]], t: [u32; 3]) -> bool {
        self.outgoing(t[0]).any(|o| {
            let other = &triangles[o.halfedge as usize / 3];
            t.iter().all(|v| other.contains(v))
        })
    }

    /// Links the triangles from `first_face` on, which were appended to `triangles`, with each other
    /// and with the boundary. Cost follows the number of appended triangles.
    ///
    /// Requires that the appended triangles close boundary edges with opposite halfedges and share no
    /// edge with any other triangle; the pipeline verifies that before it appends.
    pub(crate) fn append(&mut self, triangles: &[[u32; 3]], first_face: usize) {
        let first_halfedge = 3 * first_face as u32;
        for h in first_halfedge..3 * triangles.len() as u32 {
            let (a, b) = (origin(triangles, h), target(triangles, h));
            let outgoing = Outgoing {
                target: b,
                halfedge: h,
            };
            self.appended.entry(a).or_default().push(outgoing);
        }
        self.twin.resize(3 * triangles.len(), BOUNDARY);
        for h in first_halfedge..3 * triangles.len() as u32 {
            let (a, b) = (origin(triangles, h), target(triangles, h));
            let opposite = self.outgoing(b).find(|o| o.target == a).map(|o| o.halfedge);
            if let Some(opposite) = opposite {
                self.twin[h as usize] = opposite;
                self.twin[opposite as usize] = h;
            }
        }
    }
}

/// Halfedges of one bucket that run to a given vertex.
#[derive(Default)]
struct Matches {
    count: usize,
    any: u32,
}

impl Matches {
    fn collect(&mut self, bucket: &[Outgoing], target: u32, except: u32) {
        let run = if bucket.len() > LINEAR_SEARCH_LIMIT {
            let start = bucket.partition_point(|o| o.target < target);
            let length = bucket[start..].partition_point(|o| o.target == target);
            &bucket[start..start + length]
        } else {
            bucket
        };
        for o in run {
            if o.target == target && o.halfedge != except {
                self.count += 1;
                self.any = o.halfedge;
            }
        }
    }
}

/// Sorts all halfedges by their origin; long buckets also by target.
fn bucket_outgoing(
    vertex_count: usize,
    triangles: &[[u32; 3]],
    defects: &mut MeshDefects,
) -> (Vec<u32>, Vec<Outgoing>) {
    let mut first = vec![0_u32; vertex_count + 1];
    for t in triangles {
        for &v in t {
            first[v as usize] += 1;
        }
    }
    for (v, &count) in first[..vertex_count].iter().enumerate() {
        if count == 0 {
            defects.isolated_vertices.record(v as u32);
        }
    }
    let mut sum = 0;
    for f in &mut first {
        (*f, sum) = (sum, sum + *f);
    }
    let mut outgoing = vec![Outgoing::default(); 3 * triangles.len()];
    for (f, t) in triangles.iter().enumerate() {
        if is_degenerate(t) {
            defects.degenerate_faces.record(f as u32);
        }
        for k in 0..3 {
            let slot = &mut first[t[k] as usize];
            outgoing[*slot as usize] = Outgoing {
                target: t[(k + 1) % 3],
                halfedge: (3 * f + k) as u32,
            };
            *slot += 1;
        }
    }
    // Each start has moved to the end of its bucket, which is the start of the next one.
    first.rotate_right(1);
    first[0] = 0;
    if degenerate_or_long(&first, defects) {
        for v in 0..vertex_count {
            let bucket = &mut outgoing[first[v] as usize..first[v + 1] as usize];
            if defects.degenerate_faces.count > 0 {
                mute_degenerate(bucket, triangles);
            }
            if bucket.len() > LINEAR_SEARCH_LIMIT {
                bucket.sort_unstable();
            }
        }
    }
    (first, outgoing)
}

fn degenerate_or_long(first: &[u32], defects: &MeshDefects) -> bool {
    defects.degenerate_faces.count > 0
        || first
            .windows(2)
            .any(|w| (w[1] - w[0]) as usize > LINEAR_SEARCH_LIMIT)
}

/// Points the halfedges of degenerate triangles at no vertex, so that nothing is matched with them.
fn mute_degenerate(bucket: &mut [Outgoing], triangles: &[[u32; 3]]) {
    for o in bucket {
        if is_degenerate(&triangles[o.halfedge as usize / 3]) {
            o.target = u32::MAX;
        }
    }
}
