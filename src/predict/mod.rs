//! Predicts the surface that was there before the hole.

pub(crate) mod creases;
pub(crate) mod grey;
pub(crate) mod hpde;
pub(crate) mod mls;
pub(crate) mod nurbs;
pub(crate) mod surface;
