//! Lists of different lengths in one array: compressed rows.
//!
//! ```text
//!    starts   0     2           6  7
//!             |     |           |  |
//!    items    a  b  c  d  e  f  g
//!             row 0    row 1    row 2
//! ```
//!
//! CompressedRows are counted, then filled: two passes over what they hold, no sorting and no allocation for each row. Where items
//! come row after row, they are simply appended.

/// Items by rows.
#[derive(Clone, Debug)]
pub(crate) struct CompressedRows<T> {
    /// Where each row starts; once more, where the last one ends.
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T> CompressedRows<T> {
    /// No row yet, with memory for `rows` of them and as many items.
    pub(crate) fn with_capacity(rows: usize, items: usize) -> Self {
        let mut starts = Vec::with_capacity(rows + 1);
        starts.push(0);
        Self {
            starts,
            items: Vec::with_capacity(items),
        }
    }

    /// Appends a row.
    pub(crate) fn append(&mut self, row: impl Iterator<Item = T>) {
        self.items.extend(row);
        self.starts.push(self.items.len() as u32);
    }

    /// The items of a row, in the order in which they came.
    pub(crate) fn of(&self, row: u32) -> &[T] {
        let [start, end] = [row, row + 1].map(|r| self.starts[r as usize] as usize);
        &self.items[start..end]
    }
}

impl<T: Copy> CompressedRows<T> {
    /// `count` rows with room for as many items as `rows` names them. All places must be filled by
    /// [`push`](Self::push) before a row is read; until then they hold `blank`.
    pub(crate) fn with_room(count: usize, rows: impl Iterator<Item = u32>, blank: T) -> Self {
        // While the rows are filled, the start of each stands one place further on and moves to its end.
        let mut starts = vec![0_u32; count + 2];
        rows.for_each(|row| starts[row as usize + 2] += 1);
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let length = starts.pop().unwrap_or(0);
        Self {
            starts,
            items: vec![blank; length as usize],
        }
    }

    /// CompressedRows as long as these when they are full, to be filled in the same way.
    pub(crate) fn with_same_room<U: Copy>(&self, blank: U) -> CompressedRows<U> {
        let count = self.starts.len() - 1;
        CompressedRows {
            starts: std::iter::once(0)
                .chain(self.starts[..count].iter().copied())
                .collect(),
            items: vec![blank; self.items.len()],
        }
    }

    /// Puts an item at the end of what the row has so far.
    pub(crate) fn push(&mut self, row: u32, item: T) {
        let end = &mut self.starts[row as usize + 1];
        self.items[*end as usize] = item;
        *end += 1;
    }
}

impl CompressedRows<u32> {
    /// The two other corners of each triangle at each of `count` vertices, triangle after triangle: vertices on a common
    /// edge of two triangles occur twice.
    pub(crate) fn corners(triangles: &[[u32; 3]], count: usize) -> Self {
        let corners = triangles.iter().flatten();
        let mut rows = Self::with_room(count, corners.flat_map(|&v| [v, v]), 0);
        for t in triangles {
            for k in 0..3 {
                rows.push(t[k], t[(k + 1) % 3]);
                rows.push(t[k], t[(k + 2) % 3]);
            }
        }
        rows
    }

    /// The vertices that an edge joins to each of `count` vertices, ascending.
    pub(crate) fn neighbors(edges: impl Iterator<Item = [u32; 2]> + Clone, count: usize) -> Self {
        let mut rows = Self::with_room(count, edges.clone().flatten(), 0);
        for [a, b] in edges {
            rows.push(a, b);
            rows.push(b, a);
        }
        rows.sorted()
    }

    /// The same rows, each of them ascending and without repetitions.
    pub(crate) fn sorted(mut self) -> Self {
        let mut kept = 0;
        for row in 0..self.starts.len() - 1 {
            let (from, to) = (self.starts[row] as usize, self.starts[row + 1] as usize);
            self.items[from..to].sort_unstable();
            self.starts[row] = kept as u32;
            for i in from..to {
                let item = self.items[i];
                if i == from || item != self.items[kept - 1] {
                    self.items[kept] = item;
                    kept += 1;
                }
            }
        }
        if let Some(end) = self.starts.last_mut() {
            *end = kept as u32;
        }
        self.items.truncate(kept);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn corners_come_triangle_after_triangle() {
        let rows = CompressedRows::corners(&[[0, 1, 2], [2, 1, 4]], 5);
        let all: Vec<&[u32]> = (0..5).map(|v| rows.of(v)).collect();
        let expected: [&[u32]; 5] = [&[1, 2], &[2, 0, 4, 2], &[0, 1, 1, 4], &[], &[2, 1]];
        assert_eq!(all, expected);
    }

    proptest! {
        #[test]
        fn rows_hold_what_was_put_in(pairs in proptest::collection::vec((0..9_u32, 0..5_u32), 0..60)) {
            let mut rows = CompressedRows::with_room(9, pairs.iter().map(|p| p.0), 0);
            pairs.iter().for_each(|&(row, item)| rows.push(row, item));
            let mut again = rows.with_same_room(0);
            pairs.iter().for_each(|&(row, item)| again.push(row, item));
            let of = |row: u32| {
                let own = pairs.iter().filter(|p| p.0 == row);
                own.map(|p| p.1).collect::<Vec<u32>>()
            };
            for row in 0..9 {
                prop_assert_eq!(rows.of(row), of(row));
                prop_assert_eq!(again.of(row), of(row));
            }
            let sorted = rows.sorted();
            for row in 0..9 {
                let mut expected = of(row);
                expected.sort_unstable();
                expected.dedup();
                prop_assert_eq!(sorted.of(row), expected);
            }
        }
    }
}
