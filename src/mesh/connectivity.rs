//! Which triangle lies on the other side of which edge: connectivity without coordinates.
//!
//! Halfedge `3 * f + k` runs from corner `k` of triangle `f` to corner `(k + 1) % 3`. Every halfedge has
//! its link, made by [`super::linking`]; the halfedges that leave a vertex are kept for the vertices of
//! the boundary only, which are the ones that a patch is joined to.

use super::defects::MeshDefects;
use super::halfedge::{BOUNDARY, NON_MANIFOLD, Outgoing, origin, target};
use super::linking::link_halfedges;
use super::rim_table::RimTable;
use super::survey::survey;
use crate::error::Result;
use std::collections::BTreeMap;

/// One part in so many is free behind the arrays of a new mesh, so that the first fills do not move them: without it
/// closing one hole of a large mesh costs as much as moving its pages.
pub(super) const ROOM: usize = 16;

/// Halfedge links, and the outgoing halfedges of the vertices on the boundary.
#[derive(Clone, Debug, Default)]
pub(crate) struct Connectivity {
    twin: Vec<u32>,
    /// Boundary halfedges of the mesh as it was built, ascending.
    boundary: Vec<u32>,
    /// Number of halfedges of the mesh as it was built.
    built: usize,
    rim: RimTable,
    /// Outgoing halfedges of triangles that were appended after the mesh was built, at the vertices that were
    /// on the rim of what was appended with them.
    appended: BTreeMap<u32, Vec<Outgoing>>,
}

impl Connectivity {
    /// Matches the halfedges of `triangles`.
    ///
    /// Runs on the current thread pool with the same result for any number of threads.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`](crate::ErrorKind::InvalidInput) when a triangle names a vertex that is
    /// not below `vertex_count`.
    ///
    /// # Complexity
    /// Linear time and memory; O(n log n) in the edges of vertices of very high valence, and in the
    /// triangles of edges with more than two.
    pub(crate) fn build(
        vertex_count: usize,
        triangles: &[[u32; 3]],
    ) -> Result<(Self, MeshDefects)> {
        let mut defects = MeshDefects::default();
        let chunks = survey(vertex_count, triangles, &mut defects)?;
        let links = link_halfedges(vertex_count, triangles, &chunks, &mut defects);
        let (rim, boundary) =
            RimTable::build(vertex_count, triangles, &links.twin, &links.boundary);
        let mut twin = links.twin;
        twin.reserve_exact(twin.len() / ROOM);
        let connectivity = Self {
            built: twin.len(),
            twin,
            boundary,
            rim,
            appended: BTreeMap::new(),
        };
        Ok((connectivity, defects))
    }

    /// All halfedges that start at `vertex`, in ascending order.
    ///
    /// Of the triangles that the mesh was built with, or that were appended together, only those at vertices
    /// on the boundary of these triangles are known: for any other vertex they are left out.
    pub(crate) fn outgoing(&self, vertex: u32) -> impl Iterator<Item = Outgoing> + '_ {
        let appended = self.appended.get(&vertex).map_or(&[][..], Vec::as_slice);
        self.rim.outgoing(vertex).iter().chain(appended).copied()
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
    ///
    /// Linear in the boundary of the mesh as it was built and in what was appended.
    pub(crate) fn boundary_halfedges(&self) -> Vec<u32> {
        let appended = self.built as u32..self.twin.len() as u32;
        let is_open = |&h: &u32| self.twin(h) == BOUNDARY;
        self.boundary
            .iter()
            .copied()
            .chain(appended)
            .filter(is_open)
            .collect()
    }

    /// Whether some triangle has the edge `{a, b}`.
    ///
    /// As [`outgoing`](Self::outgoing), this knows the triangles at vertices on the boundary only.
    pub(crate) fn has_edge(&self, a: u32, b: u32) -> bool {
        self.outgoing(a).any(|o| o.target == b) || self.outgoing(b).any(|o| o.target == a)
    }

    /// Whether some triangle has exactly these three vertices, of which the first must be one that
    /// [`outgoing`](Self::outgoing) knows.
    pub(crate) fn has_face(&self, triangles: &[[u32; 3]], t: [u32; 3]) -> bool {
        self.outgoing(t[0]).any(|o| {
            let other = &triangles[o.halfedge as usize / 3];
            t.iter().all(|v| other.contains(v))
        })
    }

    /// Links the triangles from `first_face` on, which were appended to `triangles`, with each other, as `twins`
    /// says ([`pair_halfedges`](super::pairing::pair_halfedges) of them alone), and with the boundary. Cost follows the
    /// number of appended triangles.
    ///
    /// Requires that the appended triangles close boundary edges with opposite halfedges and share no
    /// edge with any other triangle; the pipeline verifies that before it appends.
    pub(crate) fn append(&mut self, triangles: &[[u32; 3]], first_face: usize, twins: &[u32]) {
        let halfedges = 3 * first_face as u32..3 * triangles.len() as u32;
        debug_assert_eq!(halfedges.len(), twins.len());
        let ends = |h: u32| (origin(triangles, h), target(triangles, h));
        self.twin.resize(3 * triangles.len(), BOUNDARY);
        let first_halfedge = halfedges.start;
        let mut rim = Vec::new();
        for (h, twin) in halfedges.clone().zip(twins) {
            match *twin {
                BOUNDARY | NON_MANIFOLD => rim.push(h),
                twin => self.twin[h as usize] = first_halfedge + twin,
            }
        }
        for &h in &rim {
            let (a, b) = ends(h);
            let known = self.outgoing(b).find(|o| o.target == a);
            if let Some(Outgoing { halfedge, .. }) = known {
                self.link(h, halfedge);
            }
        }
        let mut rim_vertices: Vec<u32> = rim
            .iter()
            .flat_map(|&h| <[u32; 2]>::from(ends(h)))
            .collect();
        rim_vertices.sort_unstable();
        rim_vertices.dedup();
        // New vertices, which are most, come behind those of the rim.
        let last = rim_vertices.last().copied().unwrap_or(0);
        for halfedge in halfedges {
            let (start, target) = ends(halfedge);
            if start <= last && rim_vertices.binary_search(&start).is_ok() {
                let outgoing = Outgoing { target, halfedge };
                self.appended.entry(start).or_default().push(outgoing);
            }
        }
    }

    fn link(&mut self, g: u32, h: u32) {
        self.twin[g as usize] = h;
        self.twin[h as usize] = g;
    }

    /// Takes back what [`append`](Self::append) did for the triangles from `first_face` on, which are still in
    /// `triangles`. Cost follows their number.
    pub(crate) fn truncate(&mut self, triangles: &[[u32; 3]], first_face: usize) {
        let first_halfedge = 3 * first_face as u32;
        for h in first_halfedge..self.twin.len() as u32 {
            let opposite = self.twin[h as usize];
            if opposite < first_halfedge {
                self.twin[opposite as usize] = BOUNDARY;
            }
            let start = origin(triangles, h);
            if let Some(outgoing) = self.appended.get_mut(&start) {
                outgoing.retain(|o| o.halfedge < first_halfedge);
                if outgoing.is_empty() {
                    self.appended.remove(&start);
                }
            }
        }
        self.twin.truncate(first_halfedge as usize);
    }
}
