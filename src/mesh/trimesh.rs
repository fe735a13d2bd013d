//! [`TriMesh`], a triangle mesh with attributes and connectivity. It is validated when it is built, and only grows.

use super::attributes::{AttributeValues, Attributes};
use super::connectivity::{Connectivity, ROOM};
use super::defects::MeshDefects;
use crate::error::{Error, Result};
use crate::math::Vec3;
use rayon::prelude::*;

/// Upper bound on the triangles. Keys of halfedges are about four times the triangle's number and must fit 32 bits, and
/// the highest numbers are marks.
const MOST_TRIANGLES: usize = (1 << 30) - 2;
/// Number of vertices that one task checks.
const VERTEX_CHUNK: usize = 1 << 14;

/// A triangle mesh with attributes, built and validated once.
///
/// Non-manifold edges, isolated vertices, duplicate and degenerate triangles, inconsistent orientation and several
/// components are allowed. They are not repaired; [`TriMesh::defects`] lists the defects. Vertices and triangles are
/// never changed, moved or reordered. Filling a hole only appends.
#[derive(Clone, Debug, Default)]
pub struct TriMesh {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    vertex_attributes: Attributes,
    face_attributes: Attributes,
    connectivity: Connectivity,
    defects: MeshDefects,
}

impl TriMesh {
    /// Builds a mesh without attributes.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when a coordinate is not finite, a triangle names a vertex that does
    /// not exist, or there are more vertices or halfedges than 32-bit indices can name
    /// (about 1 billion triangles).
    ///
    /// # Complexity
    /// Linear in the number of vertices and triangles; no hashing.
    pub fn new(positions: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self> {
        let vertex_attributes = Attributes::new(positions.len());
        let face_attributes = Attributes::new(triangles.len());
        Self::with_attributes(positions, triangles, vertex_attributes, face_attributes)
    }

    /// Builds a mesh that carries attributes per vertex and per triangle.
    ///
    /// # Errors
    /// As [`TriMesh::new`], and [`crate::ErrorKind::InvalidInput`] when the attributes are not as long as
    /// what they belong to.
    pub fn with_attributes(
        mut positions: Vec<[f64; 3]>,
        mut triangles: Vec<[u32; 3]>,
        vertex_attributes: Attributes,
        face_attributes: Attributes,
    ) -> Result<Self> {
        check_sizes(&positions, &triangles, &vertex_attributes, &face_attributes)?;
        check_finite(&positions)?;
        let (connectivity, defects) = Connectivity::build(positions.len(), &triangles)?;
        positions.reserve_exact(positions.len() / ROOM);
        triangles.reserve_exact(triangles.len() / ROOM);
        Ok(Self {
            positions,
            triangles,
            vertex_attributes,
            face_attributes,
            connectivity,
            defects,
        })
    }

    /// Vertex positions.
    #[must_use]
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Vertex indices of every triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Attributes of the vertices.
    #[must_use]
    pub fn vertex_attributes(&self) -> &Attributes {
        &self.vertex_attributes
    }

    /// Attributes of the triangles.
    #[must_use]
    pub fn face_attributes(&self) -> &Attributes {
        &self.face_attributes
    }

    /// Adds a column to the attributes of the vertices.
    ///
    /// # Errors
    /// [`InvalidInput`](crate::ErrorKind::InvalidInput) as [`Attributes::push`]; nothing changes then.
    pub fn add_vertex_attribute(&mut self, name: &str, values: AttributeValues) -> Result<()> {
        self.vertex_attributes.push(name, values)
    }

    /// Adds a column to the attributes of the triangles.
    ///
    /// # Errors
    /// [`InvalidInput`](crate::ErrorKind::InvalidInput) as [`Attributes::push`]; nothing changes then.
    pub fn add_face_attribute(&mut self, name: &str, values: AttributeValues) -> Result<()> {
        self.face_attributes.push(name, values)
    }

    /// What was irregular when the mesh was built.
    #[must_use]
    pub fn defects(&self) -> &MeshDefects {
        &self.defects
    }

    /// Gives the arrays back: positions, triangles, vertex and face attributes.
    #[must_use]
    pub fn into_parts(self) -> (Vec<[f64; 3]>, Vec<[u32; 3]>, Attributes, Attributes) {
        (
            self.positions,
            self.triangles,
            self.vertex_attributes,
            self.face_attributes,
        )
    }

    pub(crate) fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    /// The positions as vectors.
    pub(crate) fn points(&self) -> &[Vec3] {
        bytemuck::cast_slice(&self.positions)
    }

    pub(crate) fn point(&self, vertex: u32) -> Vec3 {
        Vec3::from(self.positions[vertex as usize])
    }

    pub(crate) fn corners(&self, face: u32) -> [Vec3; 3] {
        self.triangles[face as usize].map(|v| self.point(v))
    }

    /// Appends vertices and triangles; the caller extends the attributes by as many entries.
    ///
    /// `twins` pairs the halfedges of the triangles. See [`Connectivity::append`] for the requirements. The cost is
    /// proportional to the number of appended elements.
    pub(crate) fn append(
        &mut self,
        points: &[[f64; 3]],
        triangles: &[[u32; 3]],
        twins: &[u32],
        extend_attributes: impl FnOnce(&mut Attributes, &mut Attributes) -> Result<()>,
    ) -> Result<()> {
        extend_attributes(&mut self.vertex_attributes, &mut self.face_attributes)?;
        let first_face = self.triangles.len();
        self.positions.extend_from_slice(points);
        self.triangles.extend_from_slice(triangles);
        debug_assert_eq!(self.vertex_attributes.len(), self.positions.len());
        debug_assert_eq!(self.face_attributes.len(), self.triangles.len());
        self.connectivity.append(&self.triangles, first_face, twins);
        Ok(())
    }

    /// Removes the vertices and triangles that were appended after the mesh had these numbers of them. The edges that
    /// they closed are open again.
    ///
    /// The mesh must have had these numbers at one time after it was built. The cost is proportional to the number of
    /// removed elements.
    pub(crate) fn truncate(&mut self, vertices: usize, triangles: usize) {
        self.connectivity.truncate(&self.triangles, triangles);
        self.positions.truncate(vertices);
        self.triangles.truncate(triangles);
        self.vertex_attributes.truncate(vertices);
        self.face_attributes.truncate(triangles);
    }
}

fn check_sizes(
    positions: &[[f64; 3]],
    triangles: &[[u32; 3]],
    vertex_attributes: &Attributes,
    face_attributes: &Attributes,
) -> Result<()> {
    if positions.len() >= u32::MAX as usize || triangles.len() > MOST_TRIANGLES {
        return Err(Error::invalid(format!(
            "{} vertices and {} triangles are more than 32-bit indices can name",
            positions.len(),
            triangles.len()
        )));
    }
    for (what, attributes, expected) in [
        ("vertex", vertex_attributes, positions.len()),
        ("face", face_attributes, triangles.len()),
    ] {
        if attributes.len() != expected {
            return Err(Error::invalid(format!(
                "the {what} attributes have {} entries where {expected} are needed",
                attributes.len()
            )));
        }
    }
    Ok(())
}

fn check_finite(positions: &[[f64; 3]]) -> Result<()> {
    let not_finite = |p: &[f64; 3]| !p.iter().all(|c| c.is_finite());
    let first = positions
        .par_chunks(VERTEX_CHUNK)
        .enumerate()
        .find_map_first(|(chunk, points)| {
            let offset = points.iter().position(not_finite)?;
            Some(chunk * VERTEX_CHUNK + offset)
        });
    match first {
        Some(v) => {
            let [x, y, z] = positions[v];
            Err(Error::invalid(format!(
                "vertex {v} is not finite: ({x}, {y}, {z})"
            )))
        }
        None => Ok(()),
    }
}
