//! The C interface: what `include/holefill.h` declares.
//!
//! The header is generated from the files here, and its comments are theirs. This is the only module with `unsafe`.
//!
//! What C hands over is checked before it is used. Handles are looked up in a table, so that no order of calls reaches
//! freed memory. Pointers may be null or unaligned. Counts and strides may be anything. One thing cannot be checked, and
//! is the caller's promise for every function: a pointer that is not null points to as much memory as the other
//! arguments say, and nobody else writes to it during the call.
//!
//! Every function runs in a guard that turns panics into a status and failures into error objects.
//!
//! The files lie in layers. Each uses only files that are named before it:
//! `status`, `types`, `failure`; `sync`, `handles`, `shared`, `objects`, `guard`; `rows`, `input`, `output`, `text`, `structs`;
//! `version`, `error`, `callbacks`, `options`, `attributes`, `mesh`, `points`, `loops`, `fill`, `plan`, `report`.
#![allow(unsafe_code)]
// The promise is the same for all functions and stands above and at the head of the header.
#![allow(clippy::missing_safety_doc)]

mod attributes;
mod callbacks;
mod error;
mod failure;
mod fill;
mod guard;
mod handles;
mod input;
mod loops;
mod mesh;
mod objects;
mod options;
mod output;
mod plan;
mod points;
mod report;
mod rows;
mod shared;
mod status;
mod structs;
mod sync;
#[cfg(test)]
mod tests;
mod text;
mod types;
mod version;

pub use attributes::*;
pub use error::*;
pub use fill::*;
pub use loops::*;
pub use mesh::*;
pub use options::*;
pub use plan::*;
pub use points::*;
pub use report::*;
pub use status::*;
pub use types::*;
pub use version::*;
