//! The options of the method `nurbs`.

use crate::options::entry::options;

options! {
    /// How curves are predicted; `docs/methods/nurbs.md` explains the option.
    pub struct NurbsOptions {
        /// Layers of known points on each side of the hole, besides the rim
        layers: usize = 3, in 0..=6;
    }
}
