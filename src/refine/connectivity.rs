//! Half-edges of a patch in flat arrays: who is next to whom, without coordinates.
//!
//! Half-edge `h = 3t + e` runs from corner `e` of triangle `t` to the next corner; triangles are
//! counter-clockwise. `opposite[h]` is the half-edge on the other side, or names the rim edge that
//! `h` lies on. Rim edges are listed by the vertex they start from, and each knows its half-edge:
//! every open fan of triangles round a vertex starts at one of them, so a vertex that the rim
//! passes several times (a pinch) needs no special case.
//!
//! Building takes `O(n log n)` at worst; splits and flips are `O(1)`; the edge test walks
//! round an interior end, `O(valence)`, or else round both ends in step, `O(smaller valence)`.

use crate::error::{Error, ErrorKind, Result};
use crate::mesh::connectivity::{BOUNDARY, NON_MANIFOLD};
use crate::mesh::pairing::pair_halfedges;

/// A half-edge: three times its triangle plus its corner.
pub(super) type Halfedge = u32;

/// Set in `opposite` for a half-edge on the rim; the other bits are the rim edge's index.
const RIM: u32 = 1 << 31;

/// Stands for "no half-edge" at vertices without a closed fan.
const NONE: u32 = u32::MAX;

/// Triangles with their adjacency; see the module documentation.
#[derive(Clone, Debug)]
pub(super) struct Connectivity {
    /// The vertex at the start of each half-edge.
    origins: Vec<u32>,
    opposite: Vec<u32>,
    /// A half-edge out of each vertex with a closed fan, `NONE` at all others.
    start: Vec<Halfedge>,
    rim_count: usize,
    /// The half-edge of each rim edge, sorted by the vertex it starts from.
    rim_edges: Vec<Halfedge>,
    /// Rim edges out of rim vertex `v`: `rim_edges[rim_start[v]..rim_start[v + 1]]`.
    rim_start: Vec<u32>,
}

/// The half-edge after `h` in its triangle.
pub(super) fn next(h: Halfedge) -> Halfedge {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its triangle.
pub(super) fn prev(h: Halfedge) -> Halfedge {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

impl Connectivity {
    /// Links `triangles` over `vertex_count` vertices, of which the first `rim_count` are the rim.
    ///
    /// # Errors
    /// `InvalidInput` for an index out of range or more triangles than half-edges can be numbered;
    /// `Topology` when a triangle repeats a vertex, a directed edge occurs twice, two triangles
    /// share all their vertices, an edge with one triangle has an end outside the rim, or the
    /// triangles round a vertex form more fans than the rim explains.
    pub(super) fn build(
        triangles: Vec<[u32; 3]>,
        vertex_count: usize,
        rim_count: usize,
    ) -> Result<Self> {
        if rim_count > vertex_count || vertex_count.max(3 * triangles.len()) >= RIM as usize {
            return Err(Error::new(
                ErrorKind::InvalidInput,
                "patch counts are out of range",
            ));
        }
        if triangles
            .iter()
            .flatten()
            .any(|&v| v as usize >= vertex_count)
        {
            return Err(Error::new(
                ErrorKind::InvalidInput,
                "patch triangle names no vertex",
            ));
        }
        if let Some(t) = triangles
            .iter()
            .find(|t| t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
        {
            return Err(Error::topology(format!(
                "patch triangle {t:?} repeats a vertex"
            )));
        }
        let mut mesh = Self {
            opposite: Vec::new(),
            start: vec![NONE; vertex_count],
            rim_count,
            rim_edges: Vec::new(),
            rim_start: vec![0; rim_count + 1],
            origins: triangles.into_flattened(),
        };
        mesh.find_opposites()?;
        mesh.list_rim_edges()?;
        mesh.find_starts()?;
        Ok(mesh)
    }

    /// Finds the two half-edges of every edge.
    fn find_opposites(&mut self) -> Result<()> {
        self.opposite = pair_halfedges(self.triangles(), self.start.len());
        for (h, &opposite) in (0_u32..).zip(&self.opposite) {
            let is_paired = match opposite {
                BOUNDARY => continue,
                NON_MANIFOLD => false,
                g => self.origin(g) == self.target(h),
            };
            if !is_paired {
                let (a, b) = (self.origin(h), self.target(h));
                return Err(Error::topology(format!(
                    "patch edge {a} {b} is not manifold"
                )));
            }
            if self.apex(opposite) == self.apex(h) {
                let t = self.triangles()[h as usize / 3];
                return Err(Error::topology(format!(
                    "patch triangle {t:?} occurs twice"
                )));
            }
        }
        Ok(())
    }

    fn list_rim_edges(&mut self) -> Result<()> {
        let mut edges: Vec<(u32, u32, Halfedge)> = (0..self.opposite.len() as u32)
            .filter(|&h| self.opposite[h as usize] == BOUNDARY)
            .map(|h| (self.origin(h), self.target(h), h))
            .collect();
        edges.sort_unstable();
        for (index, &(a, b, h)) in edges.iter().enumerate() {
            if a.max(b) as usize >= self.rim_count {
                return Err(Error::topology(format!(
                    "patch edge {a} {b} is open inside the rim"
                )));
            }
            self.opposite[h as usize] = RIM | index as u32;
            self.rim_edges.push(h);
            self.rim_start[a as usize + 1] += 1;
        }
        for v in 0..self.rim_count {
            self.rim_start[v + 1] += self.rim_start[v];
        }
        Ok(())
    }

    fn find_starts(&mut self) -> Result<()> {
        let mut corners = vec![0u32; self.start.len()];
        for (h, &v) in self.origins.iter().enumerate() {
            corners[v as usize] += 1;
            self.start[v as usize] = h as u32;
        }
        for &h in &self.rim_edges {
            self.start[self.origins[h as usize] as usize] = NONE;
        }
        match (0..corners.len()).find(|&v| self.corners(v as u32).count() != corners[v] as usize) {
            Some(v) => Err(Error::topology(format!(
                "patch triangles round vertex {v} form several fans"
            ))),
            None => Ok(()),
        }
    }

    fn rim_edges_of(&self, v: u32) -> &[Halfedge] {
        match v as usize {
            v if v < self.rim_count => {
                &self.rim_edges[self.rim_start[v] as usize..self.rim_start[v + 1] as usize]
            }
            _ => &[],
        }
    }

    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        self.origins.as_chunks().0
    }

    /// The triangles with the half-edges on the other sides of their edges.
    pub(super) fn triangles_and_opposites(
        &self,
    ) -> impl Iterator<Item = (&[u32; 3], [Option<Halfedge>; 3])> {
        let opposites = self.opposite.as_chunks().0.iter();
        let inside = |o: u32| (o & RIM == 0).then_some(o);
        self.triangles()
            .iter()
            .zip(opposites.map(move |o: &[u32; 3]| o.map(inside)))
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.start.len()
    }

    pub(super) fn rim_count(&self) -> usize {
        self.rim_count
    }

    pub(super) fn halfedge_count(&self) -> u32 {
        self.opposite.len() as u32
    }

    /// The half-edges along the rim, each with its triangle to the left.
    pub(super) fn rim_halfedges(&self) -> &[Halfedge] {
        &self.rim_edges
    }

    /// The vertex that `h` runs from.
    pub(super) fn origin(&self, h: Halfedge) -> u32 {
        self.origins[h as usize]
    }

    /// The vertex that `h` runs to.
    pub(super) fn target(&self, h: Halfedge) -> u32 {
        self.origin(next(h))
    }

    /// The vertex of the triangle of `h` that `h` does not touch.
    pub(super) fn apex(&self, h: Halfedge) -> u32 {
        self.origin(prev(h))
    }

    /// The half-edge on the other side of the edge, `None` on the rim.
    pub(super) fn opposite(&self, h: Halfedge) -> Option<Halfedge> {
        let o = self.opposite[h as usize];
        (o & RIM == 0).then_some(o)
    }

    /// Any half-edge out of `v` when triangles surround it completely; the others follow by
    /// `opposite(prev(h))`, counter-clockwise. `None` at the rim and at unused vertices.
    pub(super) fn closed_start(&self, v: u32) -> Option<Halfedge> {
        let h = self.start[v as usize];
        (h != NONE).then_some(h)
    }

    /// The half-edges out of `v`, one per incident triangle, fan after fan.
    pub(super) fn corners(&self, v: u32) -> Corners<'_> {
        let mut fans = self.rim_edges_of(v).iter();
        let current = self.closed_start(v).or_else(|| fans.next().copied());
        Corners {
            mesh: self,
            fans,
            current,
            first: self.start[v as usize],
        }
    }

    /// Whether the patch has an edge between `a` and `b`.
    pub(super) fn has_edge(&self, a: u32, b: u32) -> bool {
        // One turn round an interior vertex passes all its neighbours.
        for (v, other) in [(a, b), (b, a)] {
            if let Some(start) = self.closed_start(v) {
                let mut h = start;
                loop {
                    let back = prev(h);
                    if self.origin(back) == other {
                        return true;
                    }
                    match self.opposite(back) {
                        Some(turned) if turned != start => h = turned,
                        _ => return false,
                    }
                }
            }
        }
        // Both one-rings in step: whichever ends first has seen every edge of its vertex.
        let (mut round_a, mut round_b) = (self.corners(a), self.corners(b));
        let touches = |h, v| self.target(h) == v || self.apex(h) == v;
        loop {
            match (round_a.next(), round_b.next()) {
                (Some(h), _) if touches(h, b) => return true,
                (_, Some(h)) if touches(h, a) => return true,
                (Some(_), Some(_)) => {}
                _ => return false,
            }
        }
    }

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
    pub(super) fn flip(&mut self, h: Halfedge, g: Halfedge) -> [Halfedge; 4] {
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
    pub(super) fn split(&mut self, h: Halfedge, g: Halfedge) -> [Halfedge; 4] {
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
    pub(super) fn renumber(&mut self, renamed: &[u32]) {
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
}

/// Iterator over the half-edges out of a vertex.
pub(super) struct Corners<'a> {
    mesh: &'a Connectivity,
    fans: std::slice::Iter<'a, Halfedge>,
    current: Option<Halfedge>,
    first: Halfedge,
}

impl Iterator for Corners<'_> {
    type Item = Halfedge;

    fn next(&mut self) -> Option<Halfedge> {
        let h = self.current?;
        self.current = match self.mesh.opposite(prev(h)) {
            Some(turned) => (turned != self.first).then_some(turned),
            None => self.fans.next().copied(),
        };
        Some(h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fan(n: u32) -> Connectivity {
        let triangles = (1..n - 1).map(|i| [0, i, i + 1]).collect();
        Connectivity::build(triangles, n as usize, n as usize).unwrap()
    }

    fn has_edge_slowly(mesh: &Connectivity, a: u32, b: u32) -> bool {
        mesh.triangles()
            .iter()
            .any(|t| a != b && t.contains(&a) && t.contains(&b))
    }

    fn check_edges_against_all_pairs(mesh: &Connectivity) {
        for a in 0..mesh.vertex_count() as u32 {
            for b in (0..mesh.vertex_count() as u32).filter(|&b| b != a) {
                assert_eq!(
                    mesh.has_edge(a, b),
                    has_edge_slowly(mesh, a, b),
                    "edge {a} {b}"
                );
            }
        }
    }

    fn kind(triangles: &[[u32; 3]], vertices: usize, rim: usize) -> ErrorKind {
        Connectivity::build(triangles.to_vec(), vertices, rim)
            .unwrap_err()
            .kind()
    }

    #[test]
    fn broken_patches_are_refused_by_cause() {
        assert_eq!(kind(&[[0, 1, 3]], 3, 3), ErrorKind::InvalidInput);
        assert_eq!(kind(&[[0, 1, 2]], 3, 4), ErrorKind::InvalidInput);
        assert_eq!(kind(&[[0, 1, 1]], 3, 3), ErrorKind::Topology);
        assert_eq!(
            kind(&[[0, 1, 2], [0, 1, 3]], 4, 4),
            ErrorKind::Topology,
            "flipped neighbour"
        );
        assert_eq!(
            kind(&[[0, 1, 2], [1, 0, 2]], 3, 3),
            ErrorKind::Topology,
            "doubled triangle"
        );
        assert_eq!(
            kind(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5, 5),
            ErrorKind::Topology
        );
        assert_eq!(
            kind(&[[0, 1, 2]], 3, 2),
            ErrorKind::Topology,
            "interior vertex on an open edge"
        );
    }

    #[test]
    fn an_empty_patch_and_unused_vertices_are_fine() {
        let mesh = Connectivity::build(Vec::new(), 4, 4).unwrap();
        assert!(!mesh.has_edge(0, 1));
        mesh.validate();
    }

    #[test]
    fn a_vertex_that_closes_two_fans_is_refused() {
        // Two tetrahedra without bottom, tip to tip at vertex 0.
        let cone = |a, b, c| [[0, a, b], [0, b, c], [0, c, a]];
        let both = [cone(1, 2, 3), cone(4, 5, 6)].concat();
        assert_eq!(kind(&both, 7, 7), ErrorKind::Topology);
        Connectivity::build(cone(1, 2, 3).to_vec(), 4, 4)
            .unwrap()
            .validate();
    }

    #[test]
    fn edges_at_a_pinched_rim_vertex_are_found_in_all_its_fans() {
        let mesh = Connectivity::build(
            vec![[0, 1, 2], [0, 2, 3], [0, 4, 5], [0, 5, 6], [0, 7, 8]],
            9,
            9,
        )
        .unwrap();
        mesh.validate();
        check_edges_against_all_pairs(&mesh);
    }

    #[test]
    fn an_annulus_keeps_its_euler_characteristic_through_splits() {
        // Outer square 0..4, inner square 4..8, a ring of eight triangles.
        let ring = (0..4u32).flat_map(|i| {
            let j = (i + 1) % 4;
            [[i, j, 4 + i], [j, 4 + j, 4 + i]]
        });
        let mut mesh = Connectivity::build(ring.collect(), 8, 8).unwrap();
        assert_eq!(mesh.euler(), 0);
        for h in 0..24 {
            if let Some(g) = mesh.opposite(h) {
                mesh.split(h, g);
                mesh.validate();
            }
        }
        assert_eq!(mesh.euler(), 0);
        assert_eq!(mesh.rim_pairs().len(), 8);
    }

    proptest! {
        #[test]
        fn random_splits_and_flips_keep_every_invariant(
            n in 3u32..12,
            steps in prop::collection::vec((any::<bool>(), any::<u32>()), 0..60),
        ) {
            let mut mesh = fan(n);
            let (rim, euler) = (mesh.rim_pairs(), mesh.euler());
            for (split, pick) in steps {
                let h = pick % mesh.halfedge_count();
                let Some(g) = mesh.opposite(h) else { continue };
                let (a, b, c, d) = (mesh.origin(h), mesh.target(h), mesh.apex(h), mesh.apex(g));
                let outer = if split {
                    mesh.split(h, g)
                } else if mesh.has_edge(c, d) {
                    continue;
                } else {
                    mesh.flip(h, g)
                };
                let mut ends: Vec<_> = outer
                    .iter()
                    .map(|&h| (mesh.origin(h).min(mesh.target(h)), mesh.origin(h).max(mesh.target(h))))
                    .collect();
                let mut expected: Vec<_> =
                    [(a, c), (c, b), (b, d), (d, a)].map(|(x, y)| (x.min(y), x.max(y))).to_vec();
                ends.sort_unstable();
                expected.sort_unstable();
                prop_assert_eq!(ends, expected);
                prop_assert_eq!(has_edge_slowly(&mesh, a, b), false);
                mesh.validate();
            }
            check_edges_against_all_pairs(&mesh);
            prop_assert_eq!(mesh.rim_pairs(), rim);
            prop_assert_eq!(mesh.euler(), euler);
        }
    }
}
