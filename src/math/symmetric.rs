//! The storage of sparse symmetric matrices for the solvers.

/// The lower triangle of a symmetric matrix, column by column, with ascending rows.
///
/// The diagonal entry comes first in each column and must be present.
#[derive(Clone, Debug, Default)]
pub(crate) struct SymmetricMatrix {
    /// Start of each column in `rows` and `values`; one more entry than columns.
    pub(crate) column_starts: Vec<u32>,
    /// Row of each entry.
    pub(crate) rows: Vec<u32>,
    /// Value of each entry.
    pub(crate) values: Vec<f64>,
}

impl SymmetricMatrix {
    /// Number of rows and columns.
    pub(crate) fn size(&self) -> usize {
        self.column_starts.len().saturating_sub(1)
    }
}
