//! Openings of the surface, each of which is closed by one patch.

use super::boundary_loop::BoundaryLoop;
use super::loops::BoundaryLoops;

/// The loops that bound one opening, by their ids: the rim of a hole with those of the islands in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Opening {
    rims: Vec<usize>,
}

impl Opening {
    /// The loop that reports and plans name the opening by: the first of its rims.
    pub(crate) fn id(&self) -> usize {
        self.rims[0]
    }

    /// The loops that bound it.
    pub(crate) fn rims(&self) -> &[usize] {
        &self.rims
    }

    /// The same, looked up in all loops of the mesh.
    pub(crate) fn rims_among<'a>(&self, loops: &'a [BoundaryLoop]) -> Vec<&'a BoundaryLoop> {
        self.rims.iter().map(|&id| &loops[id]).collect()
    }
}

/// The openings that the loops of the ascending ids `chosen` bound, in the order of these, without loops that cannot be
/// filled. With `join_islands` an island belongs to the opening that it lies in, if that is chosen.
///
/// Cost follows the chosen loops.
pub(crate) fn openings(
    boundary: &BoundaryLoops,
    chosen: &[usize],
    join_islands: bool,
) -> Vec<Opening> {
    let loops = &boundary.loops;
    let is_chosen = |id: usize| {
        chosen.binary_search(&id).is_ok() && loops[id].class.unfillable_reason().is_none()
    };
    let host_of = |id: usize| {
        let host = loops[id].host.filter(|_| join_islands)?;
        (is_chosen(host) && loops[host].host.is_none()).then_some(host)
    };
    let fillable = || chosen.iter().copied().filter(|&id| is_chosen(id));
    let mut openings: Vec<Opening> = fillable()
        .filter(|&id| host_of(id).is_none())
        .map(|id| Opening { rims: vec![id] })
        .collect();
    for island in fillable() {
        if let Some(host) = host_of(island)
            && let Ok(i) = openings.binary_search_by_key(&host, Opening::id)
        {
            openings[i].rims.push(island);
        }
    }
    openings
}

#[cfg(test)]
impl Opening {
    /// An opening with one rim.
    pub(crate) fn of_loop(id: usize) -> Self {
        Self { rims: vec![id] }
    }
}
