//! The options of the method `flat`.

use crate::options::entry::options;

options! {
    /// How the rim is triangulated without new vertices.
    pub struct FlatOptions {
        /// Largest rim, in edges, searched exhaustively; the cost grows with its cube
        exact_limit: usize = 150, in 3..=2048;
    }
}
