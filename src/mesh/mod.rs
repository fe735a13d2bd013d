//! Triangle meshes: positions, triangles, attributes, connectivity, and the rings round a rim.

#[cfg_attr(
    not(feature = "io"),
    allow(dead_code, reason = "only reading files needs all of it")
)]
pub(crate) mod attributes;
pub(crate) mod connectivity;
#[cfg(test)]
mod connectivity_oracle;
pub(crate) mod defects;
pub(crate) mod halfedge;
mod linking;
pub(crate) mod pairing;
mod rim_table;
pub(crate) mod rings;
mod survey;
pub(crate) mod trimesh;

#[cfg(test)]
mod connectivity_tests;
#[cfg(test)]
mod rings_tests;
