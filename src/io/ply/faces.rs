//! Reads the triangles of the face or tristrips element of a PLY file.

use super::super::polygons::Polygons;
use super::number::Encoded;
use crate::mesh::attributes::{ListValues, ScalarValues, with_scalars};

/// The first list that has an item which is not the index of a vertex.
#[derive(Debug)]
pub(super) struct BadIndex {
    pub(super) row: usize,
    pub(super) index: f64,
}

/// The faces whose corners are the lists of `lists`.
pub(super) fn polygons(lists: &ListValues, vertex_count: usize) -> Result<Polygons, BadIndex> {
    let mut polygons = Polygons::with_capacity(lists.len());
    let mut corners = Vec::new();
    for row in 0..lists.len() {
        corners.clear();
        let range = lists.range(row).unwrap_or_default();
        let range_start = range.start;
        let valid = with_scalars!(lists.items(), v => extend_indices(&v[range], vertex_count, &mut corners));
        if !valid {
            let index = lists
                .items()
                .get(range_start + corners.len())
                .unwrap_or(f64::NAN);
            return Err(BadIndex { row, index });
        }
        polygons.push(&corners);
    }
    Ok(polygons)
}

/// Appends `items` to `corners` up to the first one that is not the index of a vertex.
fn extend_indices<T: Encoded>(items: &[T], vertex_count: usize, corners: &mut Vec<u32>) -> bool {
    for item in items {
        match item
            .to_index()
            .filter(|&index| (index as usize) < vertex_count)
        {
            Some(index) => corners.push(index),
            None => return false,
        }
    }
    true
}

/// The triangles of strips; -1 begins a new strip. Every second triangle of a strip is reversed. Triangles with a
/// repeated corner only connect strips and are left out.
pub(super) fn strips(lists: &ListValues, vertex_count: usize) -> Result<Vec<[u32; 3]>, BadIndex> {
    let mut triangles = Vec::new();
    let items: &ScalarValues = lists.items();
    for row in 0..lists.len() {
        let mut strip: Vec<u32> = Vec::new();
        for k in lists.range(row).unwrap_or_default() {
            let index = items.get(k).unwrap_or(f64::NAN);
            if index == -1.0 {
                strip.clear();
                continue;
            }
            if !(0.0..vertex_count as f64).contains(&index) {
                return Err(BadIndex { row, index });
            }
            strip.push(index as u32);
            if let [.., a, b, c] = strip[..]
                && a != b
                && b != c
                && c != a
            {
                triangles.push(if strip.len() % 2 == 1 {
                    [a, b, c]
                } else {
                    [b, a, c]
                });
            }
        }
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::attributes::ScalarType;

    fn lists(items: Vec<i32>, ends: Vec<usize>) -> ListValues {
        ListValues::from_parts(ScalarType::U8, ScalarValues::I32(items), ends).unwrap()
    }

    #[test]
    fn strips_alternate_their_orientation_and_restart() {
        let strip = lists(vec![0, 1, 2, 3, 4, -1, 4, 5, 5, 6, 3, -1], vec![12]);
        let expected = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [5, 6, 3]];
        assert_eq!(strips(&strip, 7).unwrap(), expected);
        assert_eq!(strips(&strip, 6).unwrap_err().index, 6.0);
    }

    #[test]
    fn the_first_bad_index_is_found() {
        let faces = lists(vec![0, 1, 2, 1, 2, 0, 2, -5, 9], vec![3, 6, 9]);
        let bad = polygons(&faces, 3).unwrap_err();
        assert_eq!((bad.row, bad.index), (2, -5.0));
        let faces = lists(vec![0, 1, 2, 1, 2, 3], vec![3, 6]);
        let bad = polygons(&faces, 3).unwrap_err();
        assert_eq!((bad.row, bad.index), (1, 3.0));
        assert_eq!(
            polygons(&faces, 4).unwrap().triangles,
            [[0, 1, 2], [1, 2, 3]]
        );
    }
}
