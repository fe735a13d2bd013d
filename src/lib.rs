//! Fills holes in triangle meshes.
#![deny(rustdoc::broken_intra_doc_links)]
#![allow(dead_code)] // until the pipeline uses every module

mod error;
mod math;
mod patch;
mod quality;

pub use error::{Error, ErrorKind, Result};
