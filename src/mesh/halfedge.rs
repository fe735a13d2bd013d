//! The numbering of halfedges: `3 * f + k` runs from corner `k` of triangle `f` to corner `(k + 1) % 3`.

/// Link of a halfedge whose edge has one triangle.
pub(crate) const BOUNDARY: u32 = u32::MAX;
/// Link of a halfedge whose edge has three or more triangles.
pub(crate) const NON_MANIFOLD: u32 = u32::MAX - 1;
/// Link of the halfedges of a triangle that names a vertex twice; such a triangle has no neighbors.
pub(crate) const DEGENERATE: u32 = u32::MAX - 2;

/// A halfedge as seen from the vertex where it starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Outgoing {
    /// Vertex where the halfedge ends; `u32::MAX` in a triangle that names a vertex twice.
    pub(crate) target: u32,
    /// The halfedge.
    pub(crate) halfedge: u32,
}

/// The next halfedge in the same triangle.
pub(crate) fn next(halfedge: u32) -> u32 {
    if halfedge % 3 == 2 {
        halfedge - 2
    } else {
        halfedge + 1
    }
}

/// The previous halfedge in the same triangle.
pub(crate) fn previous(halfedge: u32) -> u32 {
    if halfedge.is_multiple_of(3) {
        halfedge + 2
    } else {
        halfedge - 1
    }
}

/// Vertex where `halfedge` starts.
pub(crate) fn origin(triangles: &[[u32; 3]], halfedge: u32) -> u32 {
    triangles[halfedge as usize / 3][halfedge as usize % 3]
}

/// Vertex where `halfedge` ends.
pub(crate) fn target(triangles: &[[u32; 3]], halfedge: u32) -> u32 {
    origin(triangles, next(halfedge))
}

/// Whether a triangle names a vertex twice.
pub(super) fn is_degenerate(t: &[u32; 3]) -> bool {
    t[0] == t[1] || t[1] == t[2] || t[2] == t[0]
}
