//! Predicts the surface that was there before the hole.

pub(crate) mod grey;
pub(crate) mod hpde;
mod jet;
pub(crate) mod nurbs;
// The pieces are put in place one after the other; the pipeline will use them all.
#[allow(dead_code)]
pub(crate) mod surface;
