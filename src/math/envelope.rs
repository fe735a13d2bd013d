//! Cholesky factorization within the envelope of a symmetric matrix.
//!
//! Each row is stored from its first entry to the diagonal; the factor has no entries outside. The unknowns are
//! ordered so that rows are short. This is faster than a general sparse factorization up to some thousand unknowns,
//! because there is hardly any bookkeeping.
//!
//! Sources: E. Cuthill, J. McKee, "Reducing the bandwidth of sparse symmetric matrices", ACM National Conference, 1969,
//! for the order, reversed as in A. George, J. W. Liu, "Computer solution of large sparse positive definite systems",
//! Prentice-Hall, 1981, ch. 4; A. Jennings, "A compact storage scheme for the solution of symmetric linear simultaneous
//! equations", Computer Journal 9(3), 1966, for the factorization row by row.
//!
//! Complexity: O(Σ w²) for rows of width w, about n² for the n interior vertices of a round patch.

use super::Vec3;
use super::symmetric::SymmetricMatrix;
use crate::error::Result;
use crate::job::Job;

/// An order of the unknowns with short rows, and the first column of each row in this order.
pub(super) struct Envelope {
    /// The unknown at each place.
    order: Vec<u32>,
    /// The place of each unknown.
    place: Vec<u32>,
    /// First place with an entry in the row of each place.
    first: Vec<u32>,
}

impl Envelope {
    /// Orders the unknowns level by level, starting from one that is far from the others.
    pub(super) fn new(matrix: &SymmetricMatrix) -> Self {
        let neighbors = RowNeighbors::new(matrix);
        let size = matrix.size();
        let mut order = Vec::with_capacity(size);
        let mut is_placed = vec![false; size];
        for seed in 0..size as u32 {
            if is_placed[seed as usize] {
                continue;
            }
            // The first walk, from any unknown, finds a far one. The second walk starts there.
            let start = order.len();
            neighbors.walk(seed, &mut order, &mut is_placed);
            let far = order[order.len() - 1];
            for v in order.drain(start..) {
                is_placed[v as usize] = false;
            }
            neighbors.walk(far, &mut order, &mut is_placed);
        }
        order.reverse();
        let mut place = vec![0; size];
        for (at, &v) in (0..).zip(&order) {
            place[v as usize] = at;
        }
        let first = (0_u32..)
            .zip(&order)
            .map(|(at, &v)| {
                let places = neighbors.of(v).iter().map(|&u| place[u as usize]);
                places.fold(at, u32::min)
            })
            .collect();
        Self {
            order,
            place,
            first,
        }
    }

    /// Number of multiplications of the factorization, up to a factor of two.
    pub(super) fn work(&self) -> u64 {
        (0_u64..)
            .zip(&self.first)
            .map(|(at, &first)| (at + 1 - u64::from(first)).pow(2))
            .sum()
    }

    /// Solves for three coordinates at once; `None` when the matrix, to whose diagonal `shift` is added, is not
    /// positive definite.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(super) fn solve(
        &self,
        matrix: &SymmetricMatrix,
        shift: f64,
        right_side: &[Vec3],
        job: &Job<'_>,
    ) -> Result<Option<Vec<Vec3>>> {
        let mut rows = self.scatter(matrix, shift);
        if !rows.factorize(job)? {
            return Ok(None);
        }
        let mut solution = vec![Vec3::zeros(); right_side.len()];
        for k in 0..3 {
            let mut x: Vec<f64> = self
                .order
                .iter()
                .map(|&v| right_side[v as usize][k])
                .collect();
            rows.substitute(&mut x);
            for (&v, x) in self.order.iter().zip(x) {
                solution[v as usize][k] = x;
            }
        }
        Ok(Some(solution))
    }

    fn scatter(&self, matrix: &SymmetricMatrix, shift: f64) -> EnvelopeRows<'_> {
        let mut starts = Vec::with_capacity(self.first.len() + 1);
        let mut total = 0;
        for (at, &first) in self.first.iter().enumerate() {
            starts.push(total);
            total += at + 1 - first as usize;
        }
        starts.push(total);
        let mut values = vec![0.0; total];
        for (j, range) in matrix.column_starts.windows(2).enumerate() {
            for entry in range[0] as usize..range[1] as usize {
                let (a, b) = (self.place[j], self.place[matrix.rows[entry] as usize]);
                let (row, column) = (a.max(b) as usize, a.min(b) as usize);
                values[starts[row] + column - self.first[row] as usize] += matrix.values[entry];
            }
        }
        for end in &starts[1..] {
            values[end - 1] += shift;
        }
        EnvelopeRows {
            first: &self.first,
            starts,
            values,
        }
    }
}

/// The neighbors of each unknown in the graph of the matrix.
struct RowNeighbors {
    starts: Vec<u32>,
    list: Vec<u32>,
}

impl RowNeighbors {
    fn new(matrix: &SymmetricMatrix) -> Self {
        let size = matrix.size();
        let pairs = || {
            (0_u32..)
                .zip(matrix.column_starts.windows(2))
                .flat_map(|(j, range)| {
                    let rows = &matrix.rows[range[0] as usize..range[1] as usize];
                    rows.iter().map(move |&i| (i, j)).filter(|(i, j)| i != j)
                })
        };
        // Counts are stored two places ahead, because placing the entries moves each start to the next one.
        let mut starts = vec![0; size + 2];
        for (i, j) in pairs() {
            starts[i as usize + 2] += 1;
            starts[j as usize + 2] += 1;
        }
        for v in 2..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut list = vec![0; starts[size + 1] as usize];
        for (i, j) in pairs() {
            for (from, to) in [(i, j), (j, i)] {
                let slot = &mut starts[from as usize + 1];
                list[*slot as usize] = to;
                *slot += 1;
            }
        }
        starts.pop();
        Self { starts, list }
    }

    fn of(&self, v: u32) -> &[u32] {
        &self.list[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }

    /// Appends all unknowns that are reached from `start` to `order`, breadth first.
    fn walk(&self, start: u32, order: &mut Vec<u32>, is_placed: &mut [bool]) {
        let mut head = order.len();
        is_placed[start as usize] = true;
        order.push(start);
        while let Some(&v) = order.get(head) {
            head += 1;
            for &u in self.of(v) {
                if !std::mem::replace(&mut is_placed[u as usize], true) {
                    order.push(u);
                }
            }
        }
    }
}

/// The rows of the lower triangle, each from its first entry to the diagonal; then those of the factor.
struct EnvelopeRows<'a> {
    first: &'a [u32],
    starts: Vec<usize>,
    values: Vec<f64>,
}

impl EnvelopeRows<'_> {
    /// Replaces the matrix by its factor; false when it is not positive definite.
    fn factorize(&mut self, job: &Job<'_>) -> Result<bool> {
        for i in 0..self.first.len() {
            let (above, row) = self.values.split_at_mut(self.starts[i]);
            let first = self.first[i] as usize;
            let width = i - first;
            job.tick(width * width / 32)?;
            for k in 0..width {
                let j = first + k;
                let other = &above[self.starts[j]..self.starts[j + 1]];
                let other_first = self.first[j] as usize;
                let from = first.max(other_first);
                let known = &other[from - other_first..other.len() - 1];
                let sum = dot(known, &row[from - first..k]);
                row[k] = (row[k] - sum) / other[other.len() - 1];
            }
            let rest = row[width] - dot(&row[..width], &row[..width]);
            if rest.is_nan() || rest <= 0.0 {
                return Ok(false);
            }
            row[width] = rest.sqrt();
        }
        Ok(true)
    }

    /// Solves with the factor and then with its transpose.
    fn substitute(&self, x: &mut [f64]) {
        let row_of = |i: usize| &self.values[self.starts[i]..self.starts[i + 1]];
        for i in 0..x.len() {
            let (row, first) = (row_of(i), self.first[i] as usize);
            let width = i - first;
            x[i] = (x[i] - dot(&row[..width], &x[first..i])) / row[width];
        }
        for i in (0..x.len()).rev() {
            let (row, first) = (row_of(i), self.first[i] as usize);
            let width = i - first;
            x[i] /= row[width];
            let value = x[i];
            for (x, l) in x[first..i].iter_mut().zip(&row[..width]) {
                *x -= l * value;
            }
        }
    }
}

/// The scalar product, in four sums so that the compiler vectorizes it.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_lanes, a_rest) = a.as_chunks::<4>();
    let (b_lanes, b_rest) = b.as_chunks::<4>();
    let mut lanes = [0.0; 4];
    for (a, b) in a_lanes.iter().zip(b_lanes) {
        for k in 0..4 {
            lanes[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    /// A matrix with the given off-diagonal entries and a dominant diagonal.
    fn matrix(size: usize, entries: &[(usize, usize, f64)]) -> (SymmetricMatrix, DMatrix<f64>) {
        let mut full = DMatrix::zeros(size, size);
        for &(i, j, value) in entries.iter().filter(|(i, j, _)| i % size != j % size) {
            let (i, j) = (i % size, j % size);
            full[(i, j)] = value;
            full[(j, i)] = value;
        }
        for i in 0..size {
            full[(i, i)] = 0.1 + full.row(i).iter().map(|v| v.abs()).sum::<f64>();
        }
        let mut sparse = SymmetricMatrix {
            column_starts: vec![0],
            ..SymmetricMatrix::default()
        };
        for j in 0..size {
            for i in (j..size).filter(|&i| full[(i, j)] != 0.0) {
                sparse.rows.push(i as u32);
                sparse.values.push(full[(i, j)]);
            }
            sparse.column_starts.push(sparse.rows.len() as u32);
        }
        (sparse, full)
    }

    proptest! {
        #[test]
        fn the_solution_is_that_of_the_dense_factorization(
            size in 1_usize..40,
            entries in prop::collection::vec((0_usize..40, 0_usize..40, -1.0..1.0f64), 0..120),
        ) {
            let (sparse, full) = matrix(size, &entries);
            let right_side: Vec<Vec3> =
                (0..size).map(|i| Vec3::new(i as f64, 1.0, -(i as f64).sin())).collect();
            let envelope = Envelope::new(&sparse);
            let found = envelope.solve(&sparse, 0.0, &right_side, &Job::unlimited()).unwrap().unwrap();
            let dense = full.cholesky().unwrap();
            for k in 0..3 {
                let column = nalgebra::DVector::from_fn(size, |i, _| right_side[i][k]);
                let expected = dense.solve(&column);
                for i in 0..size {
                    prop_assert!((found[i][k] - expected[i]).abs() < 1e-9 * (1.0 + expected[i].abs()));
                }
            }
        }
    }

    #[test]
    fn a_path_in_any_order_has_rows_of_two_entries() {
        let place = |i: usize| i * 37 % 100;
        let entries: Vec<_> = (0..99).map(|i| (place(i), place(i + 1), -1.0)).collect();
        let (sparse, _) = matrix(100, &entries);
        assert_eq!(Envelope::new(&sparse).work(), 1 + 99 * 4);
    }

    #[test]
    fn a_stop_is_heard() {
        let entries: Vec<_> = (0..400)
            .flat_map(|i| (0..i).map(move |j| (i, j, 0.1)))
            .collect();
        let (sparse, _) = matrix(400, &entries);
        let envelope = Envelope::new(&sparse);
        let outcome = envelope.solve(&sparse, 0.0, &[Vec3::zeros(); 400], &Job::new(&|| true));
        assert_eq!(outcome.unwrap_err().kind(), crate::ErrorKind::Cancelled);
    }
}
