//! Creases of the known surface that run into a hole.

// The pipeline will use all of it.
#![allow(dead_code)]

pub(crate) mod detect;
mod facets;
