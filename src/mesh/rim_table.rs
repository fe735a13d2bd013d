//! A table of the halfedges that leave boundary vertices.
//!
//! One bit for each vertex says whether it is on the boundary. The number of set bits before it is its index in compact
//! arrays. So the table is small if the boundary is short.

use super::halfedge::{BOUNDARY, Outgoing, is_degenerate, origin, target};
use super::survey::FACE_CHUNK;
use rayon::prelude::*;

/// Vertices per word of the bit set.
const WORD: usize = u64::BITS as usize;

/// Outgoing halfedges of the vertices on the boundary.
#[derive(Clone, Debug, Default)]
pub(super) struct RimTable {
    /// One bit per vertex: whether it is on the boundary.
    words: Vec<u64>,
    /// Number of vertices on the boundary before each word.
    ranks: Vec<u32>,
    /// The start of each boundary vertex's halfedges, and at the end their number.
    first: Vec<u32>,
    outgoing: Vec<Outgoing>,
}

impl RimTable {
    /// Makes the table from the boundary halfedges, in any order. Also returns them in ascending order.
    ///
    /// One pass over the triangles, unless there is no boundary.
    pub(super) fn build(
        vertex_count: usize,
        triangles: &[[u32; 3]],
        twin: &[u32],
        boundary: &[Vec<u32>],
    ) -> (Self, Vec<u32>) {
        if boundary.iter().all(Vec::is_empty) {
            return (Self::default(), Vec::new());
        }
        let mut words = vec![0_u64; vertex_count.div_ceil(WORD)];
        for &h in boundary.iter().flatten() {
            for v in [origin(triangles, h), target(triangles, h)] {
                words[v as usize / WORD] |= 1 << (v as usize % WORD);
            }
        }
        let is_marked = |v: u32| words[v as usize / WORD] >> (v as usize % WORD) & 1 == 1;
        let corners: Vec<Vec<u32>> = triangles
            .par_chunks(FACE_CHUNK)
            .enumerate()
            .map(|(chunk, faces)| {
                let first = (3 * chunk * FACE_CHUNK) as u32;
                let corners = (first..).zip(faces.as_flattened());
                corners
                    .filter(|&(_, &v)| is_marked(v))
                    .map(|(h, _)| h)
                    .collect()
            })
            .collect();
        let corners = || corners.iter().flatten().copied();
        let boundary = corners()
            .filter(|&h| twin[h as usize] == BOUNDARY)
            .collect();

        let mut count = 0;
        let ranks = words
            .iter()
            .map(|word| {
                let before = count;
                count += word.count_ones();
                before
            })
            .collect();
        let mut table = Self {
            words,
            ranks,
            first: vec![0; count as usize + 2],
            outgoing: vec![Outgoing::default(); corners().count()],
        };
        table.fill(triangles, corners);
        (table, boundary)
    }

    /// Sorts the halfedges by the vertices that they leave, by counting.
    fn fill<I: Iterator<Item = u32>>(&mut self, triangles: &[[u32; 3]], corners: impl Fn() -> I) {
        // Counts are stored two places ahead, because placing the halfedges moves each start to the next one.
        for h in corners() {
            if let Some(rank) = self.rank(origin(triangles, h)) {
                self.first[rank + 2] += 1;
            }
        }
        for i in 2..self.first.len() {
            self.first[i] += self.first[i - 1];
        }
        for h in corners() {
            let Some(rank) = self.rank(origin(triangles, h)) else {
                continue;
            };
            let is_degenerate = is_degenerate(&triangles[h as usize / 3]);
            let slot = &mut self.first[rank + 1];
            self.outgoing[*slot as usize] = Outgoing {
                target: if is_degenerate {
                    u32::MAX
                } else {
                    target(triangles, h)
                },
                halfedge: h,
            };
            *slot += 1;
        }
        self.first.pop();
    }

    /// Index of `vertex` among the boundary vertices.
    fn rank(&self, vertex: u32) -> Option<usize> {
        let (word, bit) = (vertex as usize / WORD, vertex as usize % WORD);
        let bits = *self.words.get(word)?;
        let before = (bits & ((1 << bit) - 1)).count_ones();
        (bits >> bit & 1 == 1).then(|| (self.ranks[word] + before) as usize)
    }

    /// The halfedges that leave `vertex`, in ascending order; none when it is not on the boundary.
    pub(super) fn outgoing(&self, vertex: u32) -> &[Outgoing] {
        match self.rank(vertex) {
            Some(rank) => &self.outgoing[self.first[rank] as usize..self.first[rank + 1] as usize],
            None => &[],
        }
    }
}
