//! Fairing: moves the interior vertices of a patch so that it meets the mesh round the hole smoothly.
//!
//! `laplacian` computes the discrete Laplacian of the patch and the triangles round it. `kharmonic` minimizes energies
//! that are made from it.

pub(crate) mod kharmonic;
pub(crate) mod laplacian;

#[cfg(test)]
mod tests;
