//! Fills holes in triangle meshes.
#![deny(rustdoc::broken_intra_doc_links)]
#![allow(dead_code)] // until the pipeline uses every module

mod error;
pub mod io;
mod math;
mod mesh;
mod patch;

pub use error::{Error, ErrorKind, Result};
pub use mesh::attributes::{
    Attribute, AttributeValues, Attributes, ListValues, ScalarType, ScalarValues,
};
