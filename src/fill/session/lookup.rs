//! Finds loops of a session by what callers know them by.

use super::{FillSession, Target};
use crate::boundary::boundary_loop::BoundaryLoop;
use crate::boundary::opening::{Opening, openings};
use crate::error::{Error, Result};
use crate::fill::report::HoleReport;
use crate::mesh::halfedge::BOUNDARY;
use crate::options::FillOptions;

impl FillSession {
    /// Whether the loop `id` has not been closed.
    #[must_use]
    pub fn is_open(&self, id: usize) -> bool {
        if self.polyline.is_some() {
            return id == 0 && self.history.undo_count() == 0;
        }
        let connectivity = self.mesh.connectivity();
        let is_open = |l: &BoundaryLoop| {
            l.halfedges
                .iter()
                .all(|&h| connectivity.twin(h) == BOUNDARY)
        };
        self.boundary().loops.get(id).is_some_and(is_open)
    }

    /// The loop through the directed boundary edge `[from, to]`, as it runs in its triangle; open or closed since.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when there is none.
    ///
    /// # Complexity
    /// O(log b) in the boundary edges once the loops are found.
    pub fn loop_with_edge(&self, [from, to]: [u32; 2]) -> Result<usize> {
        if let Some(id) = self.find_edge(from, to) {
            return Ok(id);
        }
        let hint = match self.find_edge(to, from) {
            Some(_) => format!("; the boundary edge runs from {to} to {from}"),
            None => String::new(),
        };
        Err(Error::invalid(format!(
            "no boundary edge runs from vertex {from} to vertex {to}{hint}"
        )))
    }

    /// The loops that together consist of the boundary edges of the closed chain `vertices`, ascending. The
    /// chain may start anywhere and run either way; where it visits a vertex twice it passes through more than one
    /// loop.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when two vertices in succession are not joined by a boundary edge, an edge comes
    /// twice, or the edges are not all those of the loops that they are on.
    pub fn loops_with_vertices(&self, vertices: &[u32]) -> Result<Vec<usize>> {
        if vertices.len() < 2 {
            return Err(Error::invalid(format!(
                "{} vertices are no loop",
                vertices.len()
            )));
        }
        let mut edges = Vec::with_capacity(vertices.len());
        for (i, &from) in vertices.iter().enumerate() {
            let to = vertices[(i + 1) % vertices.len()];
            let id = self
                .find_edge(from, to)
                .or_else(|| self.find_edge(to, from))
                .ok_or_else(|| {
                    Error::invalid(format!("no boundary edge joins vertices {from} and {to}"))
                })?;
            edges.push((id, from.min(to), from.max(to)));
        }
        edges.sort_unstable();
        if let Some(w) = edges.windows(2).find(|w| w[0] == w[1]) {
            let (_, a, b) = w[0];
            return Err(Error::invalid(format!(
                "the edge between vertices {a} and {b} comes twice"
            )));
        }
        let mut ids = Vec::new();
        for same in edges.chunk_by(|e, f| e.0 == f.0) {
            let id = same[0].0;
            let whole = self.boundary().loops[id].edge_count();
            if same.len() != whole {
                return Err(Error::invalid(format!(
                    "the vertices pass {} of the {whole} edges of loop {id}",
                    same.len()
                )));
            }
            ids.push(id);
        }
        Ok(ids)
    }

    fn find_edge(&self, from: u32, to: u32) -> Option<usize> {
        if self.polyline.is_some() {
            let n = self.boundary().loops[0].edge_count();
            let is_edge = (from as usize) < n && (from as usize + 1) % n == to as usize;
            return is_edge.then_some(0);
        }
        let places = self.found_loops().places();
        self.mesh
            .connectivity()
            .outgoing(from)
            .filter(|o| o.target == to)
            .find_map(|o| {
                let place = places.binary_search_by_key(&o.halfedge, |p| p.0);
                Some(places[place.ok()?].1)
            })
    }

    /// Empty reports for the loops of the target, and the openings to close.
    pub(super) fn openings(
        &self,
        target: Target<'_>,
        options: &FillOptions,
    ) -> Result<(Vec<HoleReport>, Vec<Opening>)> {
        let boundary = self.boundary();
        match target {
            Target::Selected(selection) => {
                let mut kept = selection.reasons_to_keep(boundary)?;
                for (id, kept) in kept.iter_mut().enumerate() {
                    if kept.is_none() && !self.is_open(id) {
                        *kept = Some("closed by an earlier fill".to_owned());
                    }
                }
                let ids: Vec<usize> = (0..boundary.loops.len())
                    .filter(|&id| kept[id].is_none())
                    .collect();
                let loops = boundary.loops.iter().zip(kept);
                let blank = loops.map(|(l, k)| HoleReport::of_open(l, k)).collect();
                Ok((blank, openings(boundary, &ids, options.join_islands)))
            }
            Target::Loops(ids) => {
                let mut ids = ids.to_vec();
                ids.sort_unstable();
                ids.dedup();
                for &id in &ids {
                    self.check_loop(id)?;
                }
                let blank = ids
                    .iter()
                    .map(|&id| HoleReport::of_open(&boundary.loops[id], None));
                let openings = openings(boundary, &ids, options.join_islands);
                Ok((blank.collect(), openings))
            }
        }
    }

    fn check_loop(&self, id: usize) -> Result<()> {
        let loops = &self.boundary().loops;
        let Some(l) = loops.get(id) else {
            return Err(Error::invalid(format!(
                "there is no loop {id} among {}",
                loops.len()
            )));
        };
        if !self.is_open(id) {
            return Err(Error::invalid(format!(
                "loop {id} was closed by an earlier fill"
            )));
        }
        match l.class.unfillable_reason() {
            Some(reason) => Err(Error::topology(format!(
                "loop {id} cannot be filled: {reason}"
            ))),
            None => Ok(()),
        }
    }
}
