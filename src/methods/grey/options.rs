//! The options of the method `grey`.

use crate::options::entry::options;

options! {
    /// How curves are predicted; `docs/methods/grey.md` explains the option.
    pub struct GreyOptions {
        /// Known angles on each side of the hole to which the grey model is fitted
        series: usize = 5, in 4..=8;
    }
}
