//! Predicts the surface that was there before the hole.

pub(crate) mod hpde;
mod jet;
pub(crate) mod surface;
