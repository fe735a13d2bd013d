//! Triangle meshes: indices, positions and attributes, and who is whose neighbour.

pub(crate) mod attributes;
pub(crate) mod connectivity;
pub(crate) mod defects;
pub(crate) mod rings;
pub(crate) mod trimesh;

#[cfg(test)]
mod connectivity_tests;
#[cfg(test)]
mod rings_tests;
