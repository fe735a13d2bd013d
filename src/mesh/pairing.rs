//! Pairs the halfedges of a small set of triangles: those of a patch, or of the surroundings of a hole. Their vertices
//! are numbered from zero. For whole meshes, [`linking`](super::linking) does this.

use super::halfedge::{BOUNDARY, NON_MANIFOLD, origin, target};

/// For each halfedge the other one of its edge, [`BOUNDARY`] where the edge has one triangle, or [`NON_MANIFOLD`]
/// where it has three or more. All vertices are below `vertex_count`.
///
/// Halfedge `3 * f + k` runs from corner `k` of triangle `f` to corner `(k + 1) % 3`. The two halfedges of a pair may
/// have the same direction. In a triangle that names a vertex twice, both halfedges of a pair may belong to it.
///
/// # Complexity
/// Linear.
pub(crate) fn pair_halfedges(triangles: &[[u32; 3]], vertex_count: usize) -> Vec<u32> {
    let ends: Vec<(u32, u32)> = (0..3 * triangles.len() as u32)
        .map(|h| (origin(triangles, h), target(triangles, h)))
        .map(|(a, b)| (a.min(b), a.max(b)))
        .collect();
    let by_smaller = sorted_by(vertex_count, 0..ends.len() as u32, |h| ends[h as usize].0);
    let by_both = sorted_by(vertex_count, by_smaller.into_iter(), |h| ends[h as usize].1);
    let mut twins = vec![BOUNDARY; ends.len()];
    for same in by_both.chunk_by(|&g, &h| ends[g as usize] == ends[h as usize]) {
        match *same {
            [_] => {}
            [g, h] => {
                twins[g as usize] = h;
                twins[h as usize] = g;
            }
            _ => same.iter().for_each(|&h| twins[h as usize] = NON_MANIFOLD),
        }
    }
    twins
}

/// Sorts the items by a key below `key_count`. Items with one key keep their order.
fn sorted_by(
    key_count: usize,
    items: impl Iterator<Item = u32> + Clone,
    key: impl Fn(u32) -> u32,
) -> Vec<u32> {
    let mut places = vec![0_u32; key_count + 1];
    for item in items.clone() {
        places[key(item) as usize + 1] += 1;
    }
    for k in 0..key_count {
        places[k + 1] += places[k];
    }
    let mut sorted = vec![0; places[key_count] as usize];
    for item in items {
        let place = &mut places[key(item) as usize];
        sorted[*place as usize] = item;
        *place += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// By comparing all pairs.
    fn oracle(triangles: &[[u32; 3]]) -> Vec<u32> {
        let ends = |h: u32| {
            let mut ends = [origin(triangles, h), target(triangles, h)];
            ends.sort_unstable();
            ends
        };
        let all = 0..3 * triangles.len() as u32;
        let others = |h: u32| {
            let of_edge = all.clone().filter(move |&g| g != h && ends(g) == ends(h));
            of_edge.collect::<Vec<u32>>()
        };
        all.clone()
            .map(|h| match others(h)[..] {
                [] => BOUNDARY,
                [g] => g,
                _ => NON_MANIFOLD,
            })
            .collect()
    }

    proptest! {
        #[test]
        fn agrees_with_all_pairs(
            corners in prop::collection::vec([0_u32..12, 0..12, 0..12], 0..40),
        ) {
            prop_assert_eq!(pair_halfedges(&corners, 12), oracle(&corners));
        }
    }
}
