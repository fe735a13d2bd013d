//! Gives a patch the density of the mesh round its hole.
//!
//! [`rim_sizes`] and [`grading`] give the target edge lengths. [`refine`] inserts vertices until the edges have them.
//! All that is known of the mesh is a callback, which says whether the mesh has an edge between two rim vertices.

mod density;
#[cfg(test)]
mod fixtures;
mod flip;
mod isotropic;
mod locality;
mod relax;
#[cfg(test)]
mod robustness;

pub(crate) use density::{grading, rim_sizes};
pub(crate) use isotropic::{RefineOptions, RefineReport, refine};
