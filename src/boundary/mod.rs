//! Boundary loops: finding, measuring, classifying and choosing them.

pub(crate) mod classify;
pub(crate) mod loops;
pub(crate) mod select;
