//! Creases of the known surface that run into a hole.

pub(crate) mod detect;
mod facets;
