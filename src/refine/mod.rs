//! Gives a patch the density of the mesh round its hole.
//!
//! [`rim_sizes`] and [`grading`] say how long the edges should be, [`refine`] inserts vertices until
//! they are. Nothing here knows the mesh outside the patch but for one question, asked through a
//! callback: does the mesh already own an edge between these two rim vertices?

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
