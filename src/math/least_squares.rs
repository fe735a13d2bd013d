//! Linear least squares by a QR factorization that reads the equations in blocks.
//!
//! Householder reflections reduce each block of equations, together with the triangle so far, to an upper triangle. The
//! normal equations are not used, so the error grows with the condition number and not with its square. The memory does
//! not depend on the number of equations.
//!
//! Source: G. H. Golub, C. F. Van Loan, "Matrix computations", 4th edition, 2013, sections 5.2 and 5.3. Cost: O(n²) for
//! each equation with n unknowns.

/// Number of equations in a block.
const BLOCK: usize = 32;

/// A diagonal entry of the triangle that is below this share of the largest one counts as zero. Then the equations do
/// not determine that unknown.
const SMALLEST_PIVOT: f64 = 1e-9;

/// A system of equations with one or several right-hand sides.
pub(crate) struct LeastSquares {
    unknowns: usize,
    columns: usize,
    /// The upper triangle with the right-hand sides to its right, row by row.
    triangle: Vec<f64>,
    /// The equations of the present block, column by column.
    block: Vec<[f64; BLOCK]>,
    filled: usize,
}

impl LeastSquares {
    /// A system without equations.
    pub(crate) fn new(unknowns: usize, right_sides: usize) -> Self {
        let columns = unknowns + right_sides;
        Self {
            unknowns,
            columns,
            triangle: vec![0.0; unknowns * columns],
            block: vec![[0.0; BLOCK]; columns],
            filled: 0,
        }
    }

    /// Removes all equations.
    pub(crate) fn clear(&mut self) {
        self.triangle.fill(0.0);
        self.filled = 0;
    }

    /// Adds an equation: its coefficients and then its right-hand sides, all times `factor`.
    pub(crate) fn add(&mut self, factor: f64, coefficients: &[f64], right: impl Fn(usize) -> f64) {
        let place = self.filled;
        for (column, value) in self.block.iter_mut().zip(coefficients) {
            column[place] = factor * value;
        }
        for (k, column) in self.block[self.unknowns..].iter_mut().enumerate() {
            column[place] = factor * right(k);
        }
        self.filled += 1;
        if self.filled == BLOCK {
            self.fold();
        }
    }

    fn fold(&mut self) {
        for column in &mut self.block {
            column[self.filled..].fill(0.0);
        }
        self.filled = 0;
        for k in 0..self.unknowns {
            let (pivots, later) = self.block.split_at_mut(k + 1);
            let pivot = &pivots[k];
            let row = &mut self.triangle[k * self.columns..(k + 1) * self.columns];
            let below: f64 = pivot.iter().map(|x| x * x).sum();
            if below == 0.0 {
                continue;
            }
            let diagonal = row[k];
            let length = (diagonal * diagonal + below).sqrt();
            let reflected = if diagonal > 0.0 { -length } else { length };
            let top = diagonal - reflected;
            let factor = 2.0 / (top * top + below);
            row[k] = reflected;
            for (entry, column) in row[k + 1..].iter_mut().zip(later) {
                let dot: f64 = pivot.iter().zip(column.iter()).map(|(p, c)| p * c).sum();
                let share = factor * (top * *entry + dot);
                *entry -= share * top;
                for (c, p) in column.iter_mut().zip(pivot) {
                    *c -= share * p;
                }
            }
        }
    }

    /// Writes the value of the first unknown for each right-hand side to `out`. If the equations do not determine all
    /// unknowns, only the first ones are used; the numbers in `fewer`, in descending order, are tried in turn. Returns
    /// whether there is a solution.
    pub(crate) fn first_unknown(&mut self, fewer: &[usize], out: &mut [f64]) -> bool {
        if self.filled > 0 {
            self.fold();
        }
        let diagonal = |k: usize| self.triangle[k * self.columns + k].abs();
        let counts = std::iter::once(&self.unknowns).chain(fewer);
        let is_determined = |count: &&usize| {
            let largest = (0..**count).map(diagonal).fold(0.0, f64::max);
            largest > 0.0 && (0..**count).all(|k| diagonal(k) > SMALLEST_PIVOT * largest)
        };
        let Some(&count) = counts.into_iter().find(is_determined) else {
            return false;
        };
        let mut x = vec![0.0; count];
        for (right, out) in out.iter_mut().enumerate() {
            for k in (0..count).rev() {
                let row = &self.triangle[k * self.columns..(k + 1) * self.columns];
                let known: f64 = (k + 1..count).map(|j| row[j] * x[j]).sum();
                x[k] = (row[self.unknowns + right] - known) / row[k];
            }
            *out = x[0];
        }
        out.iter().all(|v| v.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_solution_is_that_of_the_singular_value_decomposition(
            entries in proptest::collection::vec(-1.0..1.0, 4 * 70),
            equations in 8_usize..70,
        ) {
            let row = |i: usize| &entries[4 * i..4 * i + 4];
            let mut system = LeastSquares::new(3, 1);
            // Equations of a first use leave no trace.
            system.add(1.0, &[1.0, 2.0, 3.0], |_| 4.0);
            system.clear();
            for i in 0..equations {
                system.add(2.0, &row(i)[..3], |_| row(i)[3]);
            }
            let mut found = [0.0];
            prop_assert!(system.first_unknown(&[], &mut found));
            let matrix = DMatrix::from_fn(equations, 3, |i, j| row(i)[j]);
            let right = DVector::from_fn(equations, |i, _| row(i)[3]);
            let expected = matrix.svd(true, true).solve(&right, 0.0).unwrap();
            prop_assert!((found[0] - expected[0]).abs() < 1e-9 * expected[0].abs().max(1.0));
        }
    }

    #[test]
    fn what_is_not_determined_is_left_out() {
        // A constant and a slope, given at one place only.
        let mut system = LeastSquares::new(2, 1);
        system.add(1.0, &[1.0, 0.5], |_| 3.0);
        system.add(1.0, &[1.0, 0.5], |_| 5.0);
        let mut found = [0.0];
        assert!(!system.first_unknown(&[], &mut found));
        assert!(system.first_unknown(&[1], &mut found));
        assert!((found[0] - 4.0).abs() < 1e-12);
        assert!(!LeastSquares::new(2, 1).first_unknown(&[1], &mut found));
    }

    #[test]
    fn weights_that_differ_by_many_orders_do_not_spoil_the_heavy_equations() {
        let mut system = LeastSquares::new(3, 1);
        for i in 0..40 {
            let x = f64::from(i) / 40.0 - 0.5;
            let factor = if i % 2 == 0 { 1.0 } else { 1e-8 };
            let wrong = if i % 2 == 0 { 0.0 } else { 1.0 };
            system.add(factor, &[1.0, x, x * x], |_| 2.0 - x + wrong);
        }
        let mut found = [0.0];
        assert!(system.first_unknown(&[], &mut found));
        assert!((found[0] - 2.0).abs() < 1e-9, "{found:?}");
    }
}
