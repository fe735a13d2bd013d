//! Links the two halfedges of every edge, in one pass over the triangles and without a hash table.
//!
//! Each vertex has a linked list of the edges to its neighbors of higher index. A halfedge is looked up in the list
//! of its lower end. If the list has an edge with the same other end, the halfedge joins it; otherwise it becomes the
//! first halfedge of a new edge. The lists need no memory of their own, because their pointers are stored in the
//! slots that will hold the links:
//!
//! ```text
//! first halfedge h, alone:       slot[h] = next edge of the list (an earlier halfedge, so below h)
//! joined by a later one, g:      slot[h] = g (above h)       slot[g] = next edge of the list
//! ```
//!
//! While the lists exist, the halfedge of corner `k` of triangle `f` has the [`Key`] `4 * f + k + 1`. So triangle and
//! corner are computed without a division, and zero ends a list.
//!
//! The vertices are divided into ranges that are processed in parallel. A slot belongs to the range with the lower
//! end of its edge, so no slot is used by two ranges. Edges with a third halfedge and lists that are too long are set
//! aside and sorted at the end.
//!
//! Cost: linear; O(n log n) in what is set aside.

use super::defects::MeshDefects;
use super::halfedge::{
    BOUNDARY, DEGENERATE, NON_MANIFOLD, is_degenerate, origin, previous, target,
};
use super::survey::{FACE_CHUNK, FaceChunk};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// Upper bound on the edges of a list. A longer list is set aside, so that vertices of very high valence cost O(n log
/// n).
const LONGEST_LIST: usize = 48;
/// Upper bound on the number of parallel parts. If the vertices have no spatial order, each part reads all triangles.
const MOST_PARTS: usize = 16;
/// Mark at the head of a list that was set aside. It is the key of no triangle.
const TAKEN_APART: u32 = u32::MAX;

/// The result of linking.
pub(super) struct Links {
    /// The link of every halfedge.
    pub(super) twin: Vec<u32>,
    /// All boundary halfedges, unordered.
    pub(super) boundary: Vec<Vec<u32>>,
}

/// Links all halfedges of triangles whose vertices are below `vertex_count`, and records the edges and
/// triangles that are irregular.
///
/// The links do not depend on the thread count; the order of `boundary` does.
pub(super) fn link_halfedges(
    vertex_count: usize,
    triangles: &[[u32; 3]],
    chunks: &[FaceChunk],
    defects: &mut MeshDefects,
) -> Links {
    let slots = vec![0_u32; 3 * triangles.len()];
    let slots: Vec<AtomicU32> = slots.into_iter().map(AtomicU32::new).collect();
    let mut heads = vec![0_u32; vertex_count];
    let parts = rayon::current_num_threads().clamp(1, MOST_PARTS);
    let part_size = vertex_count.div_ceil(parts).max(1);
    let mut found: Vec<Found> = heads
        .par_chunks_mut(part_size)
        .enumerate()
        .with_max_len(1)
        .map(|(part, heads)| {
            let mut part = Part {
                triangles,
                slots: &slots,
                first_vertex: (part * part_size) as u32,
                heads,
                found: Found::default(),
            };
            part.link(chunks);
            part.settle();
            part.found
        })
        .collect();
    drop(heads);

    let mut twin: Vec<u32> = slots.into_iter().map(AtomicU32::into_inner).collect();
    for &face in chunks.iter().flat_map(|c| &c.degenerate) {
        twin[3 * face as usize..][..3].fill(DEGENERATE);
    }
    let mut irregular = Irregular {
        triangles,
        twin: &mut twin,
        boundary: Vec::new(),
        inconsistent: take_all(&mut found, |f| &mut f.inconsistent),
        nonmanifold: Vec::new(),
        duplicates: take_all(&mut found, |f| &mut f.duplicates),
    };
    let set_aside = take_all(&mut found, |f| &mut f.set_aside);
    irregular.link(set_aside);
    irregular.find_duplicates();
    let mut boundary: Vec<Vec<u32>> = found.into_iter().map(|f| f.boundary).collect();
    boundary.push(std::mem::take(&mut irregular.boundary));
    irregular.record(defects);
    Links { twin, boundary }
}

fn take_all<T>(found: &mut [Found], of: impl Fn(&mut Found) -> &mut Vec<T>) -> Vec<T> {
    found
        .iter_mut()
        .flat_map(|f| std::mem::take(of(f)))
        .collect()
}

/// A halfedge with its edge: the lower end, the higher end, the halfedge.
type EdgeHalfedge = (u32, u32, u32);

/// The irregularities that a part has found.
#[derive(Default)]
struct Found {
    boundary: Vec<u32>,
    /// Halfedges that are linked later, by sorting.
    set_aside: Vec<EdgeHalfedge>,
    /// The lower halfedge of each edge whose two triangles have it in the same direction.
    inconsistent: Vec<u32>,
    /// Triangles with the vertices of an earlier one.
    duplicates: Vec<u32>,
}

/// The number of a halfedge in a list, see the head of this file.
type Key = u32;

/// The halfedge of a key.
fn halfedge_of(key: Key) -> u32 {
    key - key / 4 - 1
}

/// The exclusive or of the ends of the halfedge of `key` in triangle `t`.
fn ends_of(t: &[u32; 3], key: Key) -> u32 {
    let [a, b, c] = *t;
    match key % 4 {
        1 => a ^ b,
        2 => b ^ c,
        _ => c ^ a,
    }
}

/// The edges whose lower end lies in a range of vertices.
struct Part<'a> {
    triangles: &'a [[u32; 3]],
    slots: &'a [AtomicU32],
    first_vertex: u32,
    heads: &'a mut [Key],
    found: Found,
}

impl Part<'_> {
    fn slot(&self, key: Key) -> u32 {
        self.slots[halfedge_of(key) as usize].load(Ordering::Relaxed)
    }

    fn set_slot(&self, key: Key, value: u32) {
        self.slots[halfedge_of(key) as usize].store(value, Ordering::Relaxed);
    }

    fn link(&mut self, chunks: &[FaceChunk]) {
        let triangles = self.triangles;
        let end = self.first_vertex + self.heads.len() as u32;
        for (i, (chunk, faces)) in chunks.iter().zip(triangles.chunks(FACE_CHUNK)).enumerate() {
            if *chunk.vertices.end() < self.first_vertex || *chunk.vertices.start() >= end {
                continue;
            }
            let all_regular = chunk.degenerate.is_empty();
            for (face, t) in (i * FACE_CHUNK..).zip(faces) {
                if all_regular || !is_degenerate(t) {
                    let [a, b, c] = *t;
                    let key = 4 * face as u32 + 1;
                    self.add([a, b, c], key);
                    self.add([b, c, a], key + 1);
                    self.add([c, a, b], key + 2);
                }
            }
        }
    }

    /// Looks a halfedge up in the list of its lower end, and joins it or adds it. `t` is its triangle, starting at its
    /// origin.
    ///
    /// It is always inlined, because a call would cost as much as the few steps through the list.
    #[inline(always)]
    fn add(&mut self, t: [u32; 3], key: Key) {
        let ends = t[0] ^ t[1];
        let place = t[0].min(t[1]).wrapping_sub(self.first_vertex) as usize;
        let Some(&head) = self.heads.get(place) else {
            return;
        };
        let mut edge = head;
        let mut length = 0;
        while edge != 0 {
            let Some(other) = self.triangles.get(edge as usize / 4) else {
                return self.set_aside(t, [key]);
            };
            let slot = self.slot(edge);
            // Both edges have the same lower end, so the exclusive or compares the other ends.
            if ends_of(other, edge) == ends {
                return self.join(t, key, other, edge, slot);
            }
            length += 1;
            edge = if slot > edge { self.slot(slot) } else { slot };
        }
        if length < LONGEST_LIST {
            self.set_slot(key, head);
            self.heads[place] = key;
        } else {
            self.take_apart(place);
            self.set_aside(t, [key]);
        }
    }

    /// Joins a halfedge to the `edge` of triangle `other`.
    #[inline(always)]
    fn join(&mut self, t: [u32; 3], key: Key, other: &[u32; 3], edge: Key, slot: u32) {
        if slot > edge {
            return self.set_aside(t, [edge, slot, key]);
        }
        self.set_slot(key, slot);
        self.set_slot(edge, key);
        let is_inconsistent = other[edge as usize % 4 - 1] == t[0];
        // The ends are equal, so the exclusive or of all vertices compares the third vertices.
        let is_duplicate = other[0] ^ other[1] ^ other[2] == t[0] ^ t[1] ^ t[2];
        if is_inconsistent | is_duplicate {
            self.note(is_inconsistent, is_duplicate, edge, key);
        }
    }

    /// Sets halfedges of the edge from `t[0]` to `t[1]` aside.
    #[cold]
    fn set_aside<const N: usize>(&mut self, t: [u32; 3], keys: [Key; N]) {
        let (low, high) = (t[0].min(t[1]), t[0].max(t[1]));
        let halfedges = keys.map(|key| (low, high, halfedge_of(key)));
        self.found.set_aside.extend(halfedges);
    }

    /// Records irregularities of two halfedges that were joined.
    #[cold]
    fn note(&mut self, is_inconsistent: bool, is_duplicate: bool, first: Key, second: Key) {
        if is_inconsistent {
            self.found.inconsistent.push(halfedge_of(first));
        }
        if is_duplicate {
            self.found.duplicates.push(second / 4);
        }
    }

    /// Calls `visit` with each edge of a list: its first halfedge, and its second one if it has one.
    fn walk(&mut self, place: usize, mut visit: impl FnMut(&mut Self, Key, Option<Key>)) {
        let mut edge = self.heads[place];
        while edge != 0 && edge != TAKEN_APART {
            let slot = self.slot(edge);
            let is_joined = slot > edge;
            let next = if is_joined { self.slot(slot) } else { slot };
            visit(self, edge, is_joined.then_some(slot));
            edge = next;
        }
    }

    /// Sets all halfedges of a list aside.
    #[cold]
    fn take_apart(&mut self, place: usize) {
        let low = self.first_vertex + place as u32;
        self.walk(place, |part, first, second| {
            let first = halfedge_of(first);
            let high = origin(part.triangles, first) ^ target(part.triangles, first) ^ low;
            let halfedges = std::iter::once(first).chain(second.map(halfedge_of));
            part.found
                .set_aside
                .extend(halfedges.map(|h| (low, high, h)));
        });
        self.heads[place] = TAKEN_APART;
    }

    /// Turns the lists into links.
    fn settle(&mut self) {
        for place in 0..self.heads.len() {
            self.walk(place, |part, first, second| match second {
                Some(second) => {
                    part.set_slot(first, halfedge_of(second));
                    part.set_slot(second, halfedge_of(first));
                }
                None => {
                    part.set_slot(first, BOUNDARY);
                    part.found.boundary.push(halfedge_of(first));
                }
            });
        }
    }
}

/// Links the halfedges that were set aside, and collects the irregularities.
struct Irregular<'a> {
    triangles: &'a [[u32; 3]],
    twin: &'a mut [u32],
    boundary: Vec<u32>,
    inconsistent: Vec<u32>,
    /// The halfedges of each edge with three or more, in ascending order.
    nonmanifold: Vec<Vec<u32>>,
    duplicates: Vec<u32>,
}

impl Irregular<'_> {
    fn link(&mut self, mut set_aside: Vec<EdgeHalfedge>) {
        set_aside.par_sort_unstable();
        set_aside.dedup();
        for edge in set_aside.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            match *edge {
                [(_, _, h)] => {
                    self.twin[h as usize] = BOUNDARY;
                    self.boundary.push(h);
                }
                [(_, _, h), (_, _, g)] => self.join(h, g),
                _ => {
                    for &(_, _, h) in edge {
                        self.twin[h as usize] = NON_MANIFOLD;
                    }
                    self.nonmanifold.push(edge.iter().map(|e| e.2).collect());
                }
            }
        }
    }

    fn join(&mut self, first: u32, second: u32) {
        self.twin[first as usize] = second;
        self.twin[second as usize] = first;
        let triangles = self.triangles;
        if origin(triangles, first) == origin(triangles, second) {
            self.inconsistent.push(first);
        }
        if origin(triangles, previous(first)) == origin(triangles, previous(second)) {
            self.duplicates.push(second / 3);
        }
    }

    /// Finds the duplicates among the triangles at edges with three or more. Other duplicates were found when their
    /// edges were linked.
    fn find_duplicates(&mut self) {
        let mut faces: Vec<([u32; 3], u32)> = self
            .nonmanifold
            .iter()
            .flatten()
            .map(|h| {
                let mut key = self.triangles[*h as usize / 3];
                key.sort_unstable();
                (key, h / 3)
            })
            .collect();
        faces.par_sort_unstable();
        faces.dedup();
        let repeated = faces.windows(2).filter(|w| w[0].0 == w[1].0);
        self.duplicates.extend(repeated.map(|w| w[1].1));
    }

    fn record(mut self, defects: &mut MeshDefects) {
        let edge = |h: u32| [origin(self.triangles, h), target(self.triangles, h)];
        // A third halfedge may have been found later, or the edge may have been linked twice.
        let twin = &*self.twin;
        self.inconsistent.retain(|&h| twin[h as usize] < DEGENERATE);
        self.inconsistent.par_sort_unstable();
        self.inconsistent.dedup();
        for &h in &self.inconsistent {
            defects.inconsistent_edges.record(edge(h));
        }
        let mut lowest: Vec<u32> = self.nonmanifold.iter().map(|edge| edge[0]).collect();
        lowest.par_sort_unstable();
        for &h in &lowest {
            defects.nonmanifold_edges.record(edge(h));
        }
        self.duplicates.par_sort_unstable();
        self.duplicates.dedup();
        for &face in &self.duplicates {
            defects.duplicate_faces.record(face);
        }
    }
}
