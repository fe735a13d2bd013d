//! Solves sparse symmetric positive definite systems: small ones by Cholesky factorization within the envelope, large
//! ones by the supernodal Cholesky factorization of `faer`.

use super::Vec3;
use super::background::run_in_background;
use super::envelope::Envelope;
use super::symmetric::SymmetricMatrix;
use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, Side};

/// Upper bound on the unknowns of a system for which the envelope is computed.
const ENVELOPE_UNKNOWNS: usize = 4096;

/// Upper bound on the multiplications of a factorization within the envelope. With more, the sparse factorization is
/// faster.
const ENVELOPE_WORK: u64 = 10_000_000;

/// Upper bound on the unknowns of a system that is solved on the calling thread. The steps of a factorization cannot
/// be cancelled; up to this size each takes some milliseconds. A larger system is solved on a thread of its own, so
/// that the caller can be cancelled.
const WAITED_FOR: usize = 10_000;

/// Added to the diagonal, relative to its mean, so that rounding errors do not make the matrix indefinite.
const RELATIVE_SHIFT: f64 = 1e-12;

/// A solver that keeps the symbolic factorization while the pattern of the matrix stays the same.
pub(crate) struct SpdSolver<'a> {
    job: &'a Job<'a>,
    pattern: (Vec<u32>, Vec<u32>),
    symbolic: Option<SymbolicLlt<u32>>,
}

impl<'a> SpdSolver<'a> {
    /// A solver without a symbolic factorization.
    pub(crate) fn new(job: &'a Job<'a>) -> Self {
        Self {
            job,
            pattern: (Vec::new(), Vec::new()),
            symbolic: None,
        }
    }

    /// The job of the solver, for the code that builds the system.
    pub(crate) fn job(&self) -> &'a Job<'a> {
        self.job
    }

    /// Solves `matrix * x = right_side` for three coordinates at once and returns `x`.
    ///
    /// # Errors
    /// [`ErrorKind::Solver`] when the matrix is not positive definite or the solution not finite;
    /// [`ErrorKind::Cancelled`] when the job is cancelled.
    pub(crate) fn solve(
        &mut self,
        mut matrix: SymmetricMatrix,
        right_side: &[Vec3],
    ) -> Result<Vec<Vec3>> {
        let size = matrix.size();
        debug_assert_eq!(size, right_side.len());
        let diagonal = |j: usize| matrix.column_starts[j] as usize;
        let sum: f64 = (0..size).map(|j| matrix.values[diagonal(j)]).sum();
        let shift = RELATIVE_SHIFT * sum / size.max(1) as f64;
        if size <= ENVELOPE_UNKNOWNS {
            let envelope = Envelope::new(&matrix);
            if envelope.work() <= ENVELOPE_WORK {
                let solution = envelope.solve(&matrix, shift, right_side, self.job)?;
                return finite(solution.ok_or_else(|| {
                    failed(format!(
                        "the matrix of {size} unknowns is not positive definite"
                    ))
                })?);
            }
        }
        for j in 0..size {
            matrix.values[matrix.column_starts[j] as usize] += shift;
        }
        let is_known = self.pattern.0 == matrix.column_starts && self.pattern.1 == matrix.rows;
        let known = self.symbolic.take().filter(|_| is_known);
        let right_side = right_side.to_vec();
        let work = move |job: &Job<'_>| {
            factor_and_solve(&matrix, known, &right_side, job)
                .map(|(solution, symbolic)| (solution, symbolic, matrix))
        };
        let (solution, symbolic, matrix) = if size <= WAITED_FOR {
            work(self.job)?
        } else {
            run_in_background(self.job, work)??
        };
        self.symbolic = Some(symbolic);
        self.pattern = (matrix.column_starts, matrix.rows);
        self.job.ask()?;
        finite(solution)
    }
}

/// Solves a large system. `known` is the symbolic factorization of its pattern, if there is one.
fn factor_and_solve(
    matrix: &SymmetricMatrix,
    known: Option<SymbolicLlt<u32>>,
    right_side: &[Vec3],
    job: &Job<'_>,
) -> Result<(Vec<Vec3>, SymbolicLlt<u32>)> {
    let size = matrix.size();
    let pattern =
        SymbolicSparseColMatRef::new_checked(size, size, &matrix.column_starts, None, &matrix.rows);
    job.ask()?;
    let symbolic = match known {
        Some(symbolic) => symbolic,
        None => SymbolicLlt::try_new(pattern, Side::Lower)
            .map_err(|e| failed(format!("symbolic factorization: {e:?}")))?,
    };
    job.ask()?;
    let values = SparseColMatRef::new(pattern, &matrix.values[..]);
    let factor = Llt::try_new_with_symbolic(symbolic.clone(), values, Side::Lower)
        .map_err(|e| failed(format!("factorization of {size} unknowns: {e:?}")))?;
    job.ask()?;
    let mut x = Mat::from_fn(size, 3, |i, k| right_side[i][k]);
    factor.solve_in_place_with_conj(Conj::No, x.as_mut());
    Ok((rows(&x), symbolic))
}

fn rows(x: &Mat<f64>) -> Vec<Vec3> {
    (0..x.nrows())
        .map(|i| Vec3::new(x[(i, 0)], x[(i, 1)], x[(i, 2)]))
        .collect()
}

/// The solution, if all of it is finite.
fn finite(solution: Vec<Vec3>) -> Result<Vec<Vec3>> {
    if solution.iter().flatten().all(|c| c.is_finite()) {
        Ok(solution)
    } else {
        Err(failed(format!(
            "the solution of {} unknowns is not finite",
            solution.len()
        )))
    }
}

fn failed(message: String) -> Error {
    Error::new(ErrorKind::Solver, message)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::UNLIMITED;

    /// The second-difference matrix of a path with fixed ends.
    fn path(size: usize) -> SymmetricMatrix {
        let mut m = SymmetricMatrix {
            column_starts: vec![0],
            ..SymmetricMatrix::default()
        };
        for j in 0..size as u32 {
            m.rows.push(j);
            m.values.push(2.0);
            if j + 1 < size as u32 {
                m.rows.push(j + 1);
                m.values.push(-1.0);
            }
            m.column_starts.push(m.rows.len() as u32);
        }
        m
    }

    #[test]
    fn a_linear_function_solves_the_path() {
        for size in [1, 2, 7, 300] {
            let mut right_side = vec![Vec3::zeros(); size];
            right_side[size - 1] = Vec3::new(size as f64 + 1.0, 0.0, -(size as f64) - 1.0);
            let mut solver = SpdSolver::new(&UNLIMITED);
            // The inverse has row sums of up to (size + 1)² / 8, by which the shift of the diagonal is
            // multiplied; the coordinates reach the size, and there are two of them.
            let end = size as f64 + 1.0;
            let tolerance = 1e-9 + 2.0 * RELATIVE_SHIFT * (end * end / 8.0) * end * 2.0_f64.sqrt();
            for _ in 0..2 {
                let x = solver.solve(path(size), &right_side).unwrap();
                for (i, p) in x.iter().enumerate() {
                    let expected = i as f64 + 1.0;
                    assert!(
                        (p - Vec3::new(expected, 0.0, -expected)).norm() < tolerance,
                        "{i}: {p}"
                    );
                }
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_is_an_error() {
        let mut m = path(5);
        m.values[0] = -2.0;
        let error = SpdSolver::new(&UNLIMITED)
            .solve(m, &[Vec3::zeros(); 5])
            .unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Solver);
    }

    #[test]
    fn values_that_are_not_finite_are_an_error() {
        let mut m = path(5);
        m.values[2] = f64::NAN;
        assert!(
            SpdSolver::new(&UNLIMITED)
                .solve(m, &[Vec3::zeros(); 5])
                .is_err()
        );
    }
}
