//! Changes of a patch's triangulation: flip, split, collapse, and new numbers.
//!
//! Rim edges stay edges of one triangle each through all of them, and so does the Euler characteristic. Each change
//! takes time proportional to the valence of the vertices that it touches; only [`PatchMesh::renumber`] is linear.

use super::mesh::{Halfedge, NONE, PatchMesh, RIM, next, prev};

impl PatchMesh {
    fn link(&mut self, h: Halfedge, other: u32) {
        self.opposite[h as usize] = other;
        if other & RIM == 0 {
            self.opposite[other as usize] = h;
        } else {
            self.rim_edges[(other ^ RIM) as usize] = h;
        }
    }

    fn set_start(&mut self, v: u32, h: Halfedge) {
        let start = &mut self.start[v as usize];
        if *start != NONE {
            *start = h;
        }
    }

    /// Replaces the edge of `h` by the other diagonal of its two triangles.
    ///
    /// ```text
    ///       c              c
    ///     /   \          / | \
    ///    a --h-> b  =>  a  |  b
    ///     \   /          \ | /
    ///       d              d
    /// ```
    /// Requires an interior edge, and that no edge `c d` exists. Afterwards `h` runs from `a` to `d`
    /// and its former opposite from `b` to `c`; the edges `c a` and `d b` keep their half-edges.
    /// Returns one half-edge of each of the four outer edges.
    pub(crate) fn flip(&mut self, h: Halfedge, g: Halfedge) -> [Halfedge; 4] {
        debug_assert_eq!(self.opposite[h as usize], g);
        let (a, b, c, d) = (self.origin(h), self.origin(g), self.apex(h), self.apex(g));
        let (b_to_c, a_to_d) = (next(h), next(g));
        let (outside_bc, outside_ad) = (
            self.opposite[b_to_c as usize],
            self.opposite[a_to_d as usize],
        );
        self.origins[b_to_c as usize] = d;
        self.origins[a_to_d as usize] = c;
        self.link(h, outside_ad);
        self.link(g, outside_bc);
        self.link(b_to_c, a_to_d);
        self.set_start(a, h);
        self.set_start(b, g);
        [h, prev(h), g, prev(g)]
    }

    /// Puts a new vertex, numbered after all others, on the edge of `h` and connects it to the two
    /// apexes.
    ///
    /// ```text
    ///       c                c
    ///     /   \            / | \
    ///    a --h-> b  =>    a--v--b
    ///     \   /            \ | /
    ///       d                d
    /// ```
    /// Requires an interior edge. The half-edge `h` becomes `a v`, its opposite `v a`, two triangles
    /// are appended; the outer edges `c a` and `a d` keep their half-edges.
    /// Returns one half-edge of each of the four outer edges.
    pub(crate) fn split(&mut self, h: Halfedge, g: Halfedge) -> [Halfedge; 4] {
        debug_assert_eq!(self.opposite[h as usize], g);
        let (b, c, d) = (self.origin(g), self.apex(h), self.apex(g));
        let (v_to_c, d_to_v) = (next(h), prev(g));
        let (outside_bc, outside_db) = (
            self.opposite[v_to_c as usize],
            self.opposite[d_to_v as usize],
        );
        let v = self.start.len() as u32;
        let (vb, bv) = (self.halfedge_count(), self.halfedge_count() + 3);
        self.origins[v_to_c as usize] = v;
        self.origins[g as usize] = v;
        self.origins.extend([v, b, c, b, v, d]);
        self.opposite.extend([NONE; 6]);
        self.link(vb, bv);
        self.link(vb + 1, outside_bc);
        self.link(vb + 2, v_to_c);
        self.link(bv + 1, d_to_v);
        self.link(bv + 2, outside_db);
        self.start.push(vb);
        self.set_start(b, bv);
        [prev(h), vb + 1, bv + 2, next(g)]
    }

    /// Gives vertex `v` the number `renamed[v]`, a permutation that keeps the rim in place, and sorts
    /// the triangles by their largest vertex.
    pub(crate) fn renumber(&mut self, renamed: &[u32]) {
        let name = |v: u32| renamed[v as usize];
        let largest = |t: &[u32; 3]| name(t[0]).max(name(t[1])).max(name(t[2])) as usize;
        let mut place = vec![0u32; self.start.len() + 1];
        for t in self.triangles() {
            place[largest(t) + 1] += 1;
        }
        for v in 1..place.len() {
            place[v] += place[v - 1];
        }
        let mut moved = Vec::with_capacity(self.triangles().len());
        for t in self.triangles() {
            let slot = &mut place[largest(t)];
            moved.push(*slot);
            *slot += 1;
        }
        let carry = |h: Halfedge| 3 * moved[h as usize / 3] + h % 3;
        let mut triangles = vec![[0; 3]; self.triangles().len()];
        let mut opposite = vec![NONE; self.opposite.len()];
        for (t, corners) in self.triangles().iter().enumerate() {
            triangles[moved[t] as usize] = corners.map(name);
        }
        for (h, &o) in self.opposite.iter().enumerate() {
            opposite[carry(h as u32) as usize] = if o & RIM == 0 { carry(o) } else { o };
        }
        let mut start = vec![NONE; self.start.len()];
        for (v, &h) in self.start.iter().enumerate().filter(|(_, h)| **h != NONE) {
            start[renamed[v] as usize] = carry(h);
        }
        for h in &mut self.rim_edges {
            *h = carry(*h);
        }
        (self.origins, self.opposite, self.start) = (triangles.into_flattened(), opposite, start);
    }

    /// Merges the vertex that `h` runs from with the one that it runs to, which keeps its number.
    ///
    /// ```text
    ///        c               c
    ///      / | \           / |
    ///    x  |  \          x  |
    ///      \ |   \    =>    \ |
    ///    - gone -h-> kept  - kept
    ///      / |   /          / |
    ///    y  |  /           y  |
    ///      \ | /            \ |
    ///        d               d
    /// ```
    /// Returns false, and changes nothing, unless `h` has two triangles, the vertex that goes is inside, the two have no
    /// more than `c` and `d` as common neighbors (the link condition), and `c` and `d` keep three triangles where they are
    /// inside. The two triangles of the edge are then gone, see [`PatchMesh::triangles`], and the vertex is in none.
    pub(crate) fn collapse(&mut self, h: Halfedge) -> bool {
        let Some(g) = self.opposite(h) else {
            return false;
        };
        let (gone, kept, c, d) = (self.origin(h), self.origin(g), self.apex(h), self.apex(g));
        let of_kept = self.neighbors(kept);
        let common = |w: &u32| of_kept.binary_search(w).is_ok();
        let is_thin = |v| self.closed_start(v).is_some() && self.corners(v).count() <= 3;
        if (gone as usize) < self.rim_count
            || self.neighbors(gone).into_iter().filter(common).count() != 2
            || is_thin(c)
            || is_thin(d)
        {
            return false;
        }
        let ring: Vec<Halfedge> = self.corners(gone).collect();
        let outside = |h: Halfedge| self.opposite[h as usize];
        let (kept_to_c, d_to_kept) = (outside(next(h)), outside(prev(g)));
        let (gone_to_c, d_to_gone) = (outside(prev(h)), outside(next(g)));
        for h in ring {
            self.origins[h as usize] = kept;
        }
        self.link(gone_to_c, kept_to_c);
        self.link(d_to_gone, d_to_kept);
        for dead in [h, next(h), prev(h), g, next(g), prev(g)] {
            self.origins[dead as usize] = NONE;
            self.opposite[dead as usize] = NONE;
        }
        self.start[gone as usize] = NONE;
        self.set_start(kept, gone_to_c);
        self.set_start(c, next(gone_to_c));
        self.set_start(d, d_to_gone);
        true
    }

    /// Gives the triangle of `h` the number `t` and makes `h` its first half-edge; the triangle `t` gets the number that
    /// becomes free. The numbers decide in which order the patch is listed, and the first corner how normals are rounded.
    pub(crate) fn place(&mut self, h: Halfedge, t: u32) {
        let free = h / 3;
        let turned = [h, next(h), prev(h)];
        let mut moves: Vec<(Halfedge, Halfedge)> = turned.into_iter().zip(3 * t..).collect();
        if free != t {
            moves.extend((3 * t..3 * t + 3).zip(3 * free..));
        }
        let carry = |h: u32| moves.iter().find(|m| m.0 == h).map_or(h, |m| m.1);
        let read = |&(from, to): &(u32, u32)| {
            let other = self.opposite[from as usize];
            (to, self.origin(from), carry(other))
        };
        let carried: Vec<(Halfedge, u32, u32)> = moves.iter().map(read).collect();
        for (to, v, other) in carried {
            self.origins[to as usize] = v;
            self.link(to, other);
            self.set_start(v, to);
        }
    }
}
