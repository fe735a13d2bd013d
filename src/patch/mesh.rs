//! The triangulation of a patch while it is changed: half-edges in flat arrays, without coordinates.
//!
//! Half-edge `h = 3t + e` runs from corner `e` of triangle `t` to the next corner; triangles are
//! counter-clockwise. `opposite[h]` is the half-edge on the other side, or names the rim edge that
//! `h` lies on. Rim edges are listed by the vertex they start from, and each knows its half-edge:
//! every open fan of triangles round a vertex starts at one of them, so a vertex that the rim
//! passes several times (a pinch) needs no special case.
//!
//! Building takes `O(n log n)` at worst; splits and flips are `O(1)`; the edge test walks
//! round an interior end, `O(valence)`, or else round both ends in step, `O(smaller valence)`.

use crate::error::{Error, Result};
use crate::mesh::halfedge::{BOUNDARY, NON_MANIFOLD};
use crate::mesh::pairing::pair_halfedges;

/// A half-edge: three times its triangle plus its corner.
pub(crate) type Halfedge = u32;

/// Set in `opposite` for a half-edge on the rim; the other bits are the rim edge's index.
pub(super) const RIM: u32 = 1 << 31;

/// Stands for "no half-edge" at vertices without a closed fan.
pub(super) const NONE: u32 = u32::MAX;

/// Triangles with their adjacency; see the module documentation.
#[derive(Clone, Debug)]
pub(crate) struct PatchMesh {
    /// The vertex at the start of each half-edge.
    pub(super) origins: Vec<u32>,
    pub(super) opposite: Vec<u32>,
    /// A half-edge out of each vertex with a closed fan, `NONE` at all others.
    pub(super) start: Vec<Halfedge>,
    pub(super) rim_count: usize,
    /// The half-edge of each rim edge, sorted by the vertex it starts from.
    pub(super) rim_edges: Vec<Halfedge>,
    /// Rim edges out of rim vertex `v`: `rim_edges[rim_start[v]..rim_start[v + 1]]`.
    rim_start: Vec<u32>,
}

/// The half-edge after `h` in its triangle.
pub(crate) fn next(h: Halfedge) -> Halfedge {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its triangle.
pub(crate) fn prev(h: Halfedge) -> Halfedge {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

impl PatchMesh {
    /// Links `triangles` over `vertex_count` vertices, of which the first `rim_count` are the rim.
    ///
    /// # Errors
    /// `InvalidInput` for an index out of range or more triangles than half-edges can be numbered;
    /// `Topology` when a triangle repeats a vertex, a directed edge occurs twice, two triangles
    /// share all their vertices, an edge with one triangle has an end outside the rim, or the
    /// triangles round a vertex form more fans than the rim explains.
    pub(crate) fn new(
        triangles: Vec<[u32; 3]>,
        vertex_count: usize,
        rim_count: usize,
    ) -> Result<Self> {
        if rim_count > vertex_count || vertex_count.max(3 * triangles.len()) >= RIM as usize {
            return Err(Error::invalid("patch counts are out of range"));
        }
        if triangles
            .iter()
            .flatten()
            .any(|&v| v as usize >= vertex_count)
        {
            return Err(Error::invalid("patch triangle names no vertex"));
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

    /// All triangles; those that a collapse took have no corner that is a vertex, see [`Self::living`].
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        self.origins.as_chunks().0
    }

    /// The triangles that are left, in order.
    pub(crate) fn living(&self) -> impl Iterator<Item = [u32; 3]> {
        let all = self.triangles().iter().copied();
        all.filter(|t| t[0] != NONE)
    }

    /// The triangles with the half-edges on the other sides of their edges.
    pub(crate) fn triangles_and_opposites(
        &self,
    ) -> impl Iterator<Item = (&[u32; 3], [Option<Halfedge>; 3])> {
        let opposites = self.opposite.as_chunks().0.iter();
        let inside = |o: u32| (o & RIM == 0).then_some(o);
        self.triangles()
            .iter()
            .zip(opposites.map(move |o: &[u32; 3]| o.map(inside)))
    }

    pub(crate) fn vertex_count(&self) -> usize {
        self.start.len()
    }

    pub(crate) fn rim_count(&self) -> usize {
        self.rim_count
    }

    pub(crate) fn halfedge_count(&self) -> u32 {
        self.opposite.len() as u32
    }

    /// The half-edges along the rim, each with its triangle to the left.
    pub(crate) fn rim_halfedges(&self) -> &[Halfedge] {
        &self.rim_edges
    }

    /// The vertex that `h` runs from.
    pub(crate) fn origin(&self, h: Halfedge) -> u32 {
        self.origins[h as usize]
    }

    /// The vertex that `h` runs to.
    pub(crate) fn target(&self, h: Halfedge) -> u32 {
        self.origin(next(h))
    }

    /// The vertex of the triangle of `h` that `h` does not touch.
    pub(crate) fn apex(&self, h: Halfedge) -> u32 {
        self.origin(prev(h))
    }

    /// The half-edge on the other side of the edge, `None` on the rim.
    pub(crate) fn opposite(&self, h: Halfedge) -> Option<Halfedge> {
        let o = self.opposite[h as usize];
        (o & RIM == 0).then_some(o)
    }

    /// Any half-edge out of `v` when triangles surround it completely; the others follow by
    /// `opposite(prev(h))`, counter-clockwise. `None` at the rim and at unused vertices.
    pub(crate) fn closed_start(&self, v: u32) -> Option<Halfedge> {
        let h = self.start[v as usize];
        (h != NONE).then_some(h)
    }

    /// The half-edges out of `v`, one per incident triangle, fan after fan.
    pub(crate) fn corners(&self, v: u32) -> Corners<'_> {
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
    pub(crate) fn has_edge(&self, a: u32, b: u32) -> bool {
        self.edge_between(a, b).is_some()
    }

    /// A half-edge between `a` and `b`, in either direction.
    pub(crate) fn edge_between(&self, a: u32, b: u32) -> Option<Halfedge> {
        // One turn round an interior vertex passes all its neighbors.
        for (v, other) in [(a, b), (b, a)] {
            if let Some(start) = self.closed_start(v) {
                let mut h = start;
                loop {
                    let back = prev(h);
                    if self.origin(back) == other {
                        return Some(back);
                    }
                    match self.opposite(back) {
                        Some(turned) if turned != start => h = turned,
                        _ => return None,
                    }
                }
            }
        }
        // Both one-rings in step: whichever ends first has seen every edge of its vertex.
        let (mut round_a, mut round_b) = (self.corners(a), self.corners(b));
        let touching = |h, v| {
            let ends = [(h, self.target(h)), (prev(h), self.apex(h))];
            ends.into_iter().find(|end| end.1 == v).map(|end| end.0)
        };
        loop {
            let (at_a, at_b) = (round_a.next(), round_b.next());
            let found = at_a.and_then(|h| touching(h, b));
            let found = found.or_else(|| at_b.and_then(|h| touching(h, a)));
            if found.is_some() || at_a.is_none() || at_b.is_none() {
                return found;
            }
        }
    }

    /// The vertices that share an edge with `v`, sorted.
    pub(crate) fn neighbors(&self, v: u32) -> Vec<u32> {
        let ends = |h| [self.target(h), self.apex(h)];
        let mut around: Vec<u32> = self.corners(v).flat_map(ends).collect();
        around.sort_unstable();
        around.dedup();
        around
    }

    /// One half-edge of each edge with two triangles: the one with the smaller number, in order.
    pub(crate) fn interior_edges(&self) -> impl Iterator<Item = Halfedge> {
        let has_two = |&h: &Halfedge| self.opposite(h).is_some_and(|g| h < g);
        (0..self.halfedge_count()).filter(has_two)
    }
}

/// Iterator over the half-edges out of a vertex.
pub(crate) struct Corners<'a> {
    mesh: &'a PatchMesh,
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
