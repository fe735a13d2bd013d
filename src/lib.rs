//! Fills holes in triangle meshes, loop by loop, without touching the rest of the mesh.
//!
//! ```
//! use holefill::{BoundaryLoops, FillOptions, HoleStatus, Selection, TriMesh, fill_holes};
//!
//! // A tetrahedron without its bottom.
//! let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let triangles = vec![[0, 1, 3], [1, 2, 3], [2, 0, 3]];
//! let mut mesh = TriMesh::new(positions, triangles)?;
//!
//! let boundary = BoundaryLoops::find(&mesh);
//! assert_eq!(boundary.loops.len(), 1);
//!
//! let report =
//!     fill_holes(&mut mesh, &boundary, &Selection::default(), &FillOptions::default(), None)?;
//! assert_eq!(report.count(HoleStatus::Filled), 1);
//! assert_eq!(mesh.triangles().len(), 4);
//! # Ok::<(), holefill::Error>(())
//! ```
#![deny(rustdoc::broken_intra_doc_links)]

mod boundary;
mod error;
mod fair;
pub mod ffi;
mod fill;
#[cfg(test)]
#[path = "../tests/common/meshes.rs"]
mod fixtures;
mod hole;
#[cfg(feature = "io")]
pub mod io;
mod job;
mod math;
mod mesh;
mod methods;
mod options;
mod patch;
mod quality;
mod reconstruct;
mod refine;
mod surroundings;
mod triangulate;

pub use boundary::boundary_loop::{BoundaryLoop, LoopClass};
pub use boundary::loops::BoundaryLoops;
pub use boundary::select::Selection;
pub use error::{Error, ErrorKind, Result};
pub use fill::progress::{Progress, ProgressCallback};
pub use fill::report::{Attempt, FillReport, HoleReport, HoleStatus};
pub use fill::session::at_once::fill_holes;
pub use fill::session::{FillPlan, FillSession, PlannedPatch, Target};
pub use mesh::attributes::{
    Attribute, AttributeValues, Attributes, ListValues, ScalarType, ScalarValues,
};
pub use mesh::defects::{Defect, MeshDefects};
pub use mesh::trimesh::TriMesh;
pub use methods::{
    AutoOptions, Candidate, DeCrossover, DeMutation, DeVariant, FairWeights, FairingOptions,
    FlatOptions, GreyOptions, HpdeOptions, HpdeSolver, Method, MethodOptions, MlsDomain,
    MlsOptions, MlsUnit, NurbsOptions, Prediction, SectionCurve, SectionOptions, SectionProjection,
    SectionTangents, UnfoldOptions, UnfoldSolver, Unfolding, evolve_section, unfold_curve,
};
pub use options::{
    AttributeOptions, FillOptions, FilledAttributes, Interpolator, Parameter, RefinementOptions,
};
pub use quality::deviation;
pub use reconstruct::{PointCloud, PointOptions, PointReport, mesh_from_points};
