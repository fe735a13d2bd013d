//! The piece of surface that closes a hole: what every method returns.

#[cfg(test)]
mod check;
pub(crate) mod chords;
mod edit;
pub(crate) mod mesh;
#[cfg(test)]
mod tests;

use crate::math::Vec3;

/// A triangulated surface over the rim of a hole: what triangulation returns and refinement and
/// fairing work on.
///
/// Vertices `0..rim_count` are the rim: they are fixed, and so are the boundary edges between
/// them. All further vertices are interior. Triangles are oriented like the mesh round the hole.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PatchSurface {
    /// Number of rim vertices, which come first.
    pub(crate) rim_count: usize,
    /// Positions of the rim and then of the interior vertices.
    pub(crate) points: Vec<Vec3>,
    /// Indices into `points`.
    pub(crate) triangles: Vec<[u32; 3]>,
}
