//! The surfaces that may continue the mesh into a hole, each as the zero set of a function, and the choice among them.

pub(crate) mod algebraic;
pub(crate) mod candidates;
pub(crate) mod choice;
#[cfg(test)]
mod fixtures;
pub(crate) mod flat_rim;
pub(crate) mod frame;
pub(crate) mod hermite_rbf;
pub(crate) mod primitives;
pub(crate) mod project;
pub(crate) mod samples;
pub(crate) mod tip;

use crate::math::Vec3;

/// Rings of triangles round the hole that are read.
pub(crate) const RINGS: u32 = 9;
/// Rings of triangles that a surface is fitted to. They have one more ring of vertices.
pub(crate) const FITTED_RINGS: u32 = 3;

/// A point of the known surface with its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    /// Position, in the hole's coordinates.
    pub(crate) point: Vec3,
    /// Unit normal, oriented like the mesh.
    pub(crate) normal: Vec3,
}

/// A surface as the zero set of a function.
pub(crate) trait Implicit: Send + Sync {
    /// The value at `p`, zero on the surface, and the gradient, which points along the normals.
    fn value_and_gradient(&self, p: &Vec3) -> (f64, Vec3);
}
