//! Predicts the surface that was there before the hole.

pub(crate) mod hpde;
mod jet;
pub(crate) mod mls;
// The pieces are put in place one after the other; the pipeline will use them all.
#[allow(dead_code)]
pub(crate) mod surface;
