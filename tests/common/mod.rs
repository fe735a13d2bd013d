//! What the integration tests share.

pub(crate) mod edges;
pub(crate) mod meshes;
