//! Predicts the surface that was there before the hole.

pub(crate) mod surface;
