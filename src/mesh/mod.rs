//! The triangle mesh and what is attached to it.

pub(crate) mod attributes;
