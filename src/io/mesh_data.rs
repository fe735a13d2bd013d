//! [`MeshData`], the contents of a mesh file of any format, and checks that several formats share.

use super::ply::details::PlyDetails;
use crate::error::{Error, ErrorKind, Result};
use crate::mesh::attributes::{AttributeValues, Attributes, ScalarType};

/// The contents of a mesh file.
#[derive(Clone, Debug)]
pub struct MeshData {
    /// One position for each vertex. Single precision is converted exactly.
    pub positions: Vec<[f64; 3]>,
    /// Three indices of vertices per triangle; polygons are cut into triangles by [`read`](crate::io::read).
    pub triangles: Vec<[u32; 3]>,
    /// Other data of vertices: colors, normals, ...
    pub vertex_attributes: Attributes,
    /// Other data of triangles.
    pub face_attributes: Attributes,
    /// The precision of the positions in the file, [`ScalarType::F32`] or [`ScalarType::F64`]. Any other type counts as
    /// the latter.
    pub position_type: ScalarType,
    /// Details that only PLY files have. Other formats leave the default.
    pub ply: PlyDetails,
    /// What was left out or changed while reading, one sentence for each.
    pub notes: Vec<String>,
}

impl MeshData {
    /// A mesh in double precision without attributes.
    #[must_use]
    pub fn new(positions: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            vertex_attributes: Attributes::new(positions.len()),
            face_attributes: Attributes::new(triangles.len()),
            positions,
            triangles,
            position_type: ScalarType::F64,
            ply: PlyDetails::default(),
            notes: Vec::new(),
        }
    }

    pub(super) fn check(&self) -> Result<()> {
        let counts = [
            ("vertex", self.vertex_attributes.len(), self.positions.len()),
            ("face", self.face_attributes.len(), self.triangles.len()),
        ];
        for (element, entries, expected) in counts {
            if entries != expected {
                return Err(Error::invalid(format!(
                    "the {element} attributes have {entries} entries instead of {expected}"
                )));
            }
        }
        let n = self.positions.len();
        match self
            .triangles
            .iter()
            .position(|t| t.iter().any(|&v| v as usize >= n))
        {
            Some(k) => Err(Error::invalid(format!(
                "triangle {k} has a corner that is not a vertex"
            ))),
            None => Ok(()),
        }
    }

    /// The red, green and blue (and alpha) columns, if they are numbers.
    pub(super) fn vertex_colors(&self) -> Option<Vec<&AttributeValues>> {
        let numbers = |name| {
            self.vertex_attributes
                .get(name)
                .filter(|values| matches!(values, AttributeValues::Scalars(_)))
        };
        let mut channels = vec![numbers("red")?, numbers("green")?, numbers("blue")?];
        channels.extend(numbers("alpha"));
        Some(channels)
    }
}

/// Refuses finite positions that are not finite in single precision.
pub(super) fn check_single_precision(mesh: &MeshData) -> Result<()> {
    let overflows = |&x: &f64| x.is_finite() && !(x as f32).is_finite();
    match mesh.positions.iter().position(|p| p.iter().any(overflows)) {
        Some(k) => Err(Error::invalid(format!(
            "vertex {k} lies beyond the range of single precision"
        ))),
        None => Ok(()),
    }
}

/// The number of vertices as `u32`. An error if it does not fit.
pub(super) fn check_vertex_count(count: usize) -> Result<()> {
    if count > u32::MAX as usize {
        return Err(Error::new(
            ErrorKind::Limit,
            format!("{count} vertices are too many"),
        ));
    }
    Ok(())
}
