//! Which loops to fill: rules as data.

use super::boundary_loop::BoundaryLoop;
use super::loops::BoundaryLoops;
use crate::error::{Error, Result};

/// Rules that choose the loops to fill. The default chooses every loop.
///
/// A loop is filled when it is named by `only` (or `only` is empty) and no other rule keeps it open.
/// Edges are directed boundary edges as in their triangle, such as [`BoundaryLoop::edge`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// If not empty, only the loops through these edges are filled.
    pub only: Vec<[u32; 2]>,
    /// The loops through these edges stay open.
    pub keep: Vec<[u32; 2]>,
    /// Loops with more edges stay open.
    pub max_edges: Option<usize>,
    /// Longer loops stay open, in units of the positions.
    pub max_perimeter: Option<f64>,
    /// This many loops of the largest perimeter stay open.
    pub keep_largest: usize,
}

impl Selection {
    /// For each loop the reason why it stays open, or `None` when it is to be filled.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when an edge of `only` or `keep` is on no loop, or `max_perimeter` is
    /// negative or not a number.
    pub fn reasons_to_keep(&self, boundary: &BoundaryLoops) -> Result<Vec<Option<String>>> {
        if let Some(limit) = self.max_perimeter.filter(|p| p.is_nan() || *p < 0.0) {
            return Err(Error::invalid(format!(
                "the largest perimeter must be a number that is not negative, not {limit}"
            )));
        }
        let only = loops_of_edges(boundary, &self.only)?;
        let keep = loops_of_edges(boundary, &self.keep)?;
        let mut by_perimeter: Vec<&BoundaryLoop> = boundary.loops.iter().collect();
        by_perimeter.sort_by(|a, b| b.perimeter.total_cmp(&a.perimeter).then(a.id.cmp(&b.id)));
        let mut largest: Vec<usize> = by_perimeter
            .iter()
            .take(self.keep_largest)
            .map(|l| l.id)
            .collect();
        largest.sort_unstable();
        let reason = |l: &BoundaryLoop| {
            if keep.binary_search(&l.id).is_ok() {
                return Some("asked to keep".to_owned());
            }
            if !self.only.is_empty() && only.binary_search(&l.id).is_err() {
                return Some("not among the chosen loops".to_owned());
            }
            if let Some(limit) = self.max_edges.filter(|&limit| l.edge_count() > limit) {
                return Some(format!("more than {limit} edges"));
            }
            if let Some(limit) = self.max_perimeter.filter(|&limit| l.perimeter > limit) {
                return Some(format!("perimeter above {limit}"));
            }
            if largest.binary_search(&l.id).is_ok() {
                return Some(format!("among the {} largest", self.keep_largest));
            }
            None
        };
        Ok(boundary.loops.iter().map(reason).collect())
    }
}

/// The sorted ids of the loops through `edges`.
fn loops_of_edges(boundary: &BoundaryLoops, edges: &[[u32; 2]]) -> Result<Vec<usize>> {
    let mut ids = Vec::with_capacity(edges.len());
    for &[from, to] in edges {
        let Some(found) = boundary.with_edge([from, to]) else {
            let hint = match boundary.with_edge([to, from]) {
                Some(_) => format!("; the boundary edge runs from {to} to {from}"),
                None => String::new(),
            };
            return Err(Error::invalid(format!(
                "no boundary edge runs from vertex {from} to vertex {to}{hint}"
            )));
        };
        ids.push(found.id);
    }
    ids.sort_unstable();
    Ok(ids)
}
