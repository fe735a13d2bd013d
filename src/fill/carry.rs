//! Values of the mesh's attributes on the new vertices and triangles.
//!
//! Numbers that vary over a surface (floating-point attributes, and colours of any type) are extended from
//! the rim harmonically; normals are those of the patch; everything else (labels, flags, lists) is copied
//! from the nearest rim vertex. A new triangle takes the attributes of the nearest triangle along the rim.

use super::hole::Hole;
use crate::error::Result;
use crate::fair::kharmonic::extend_from_rim;
use crate::math::sparse::SpdSolver;
use crate::math::{Vec3, cross_normal, unit};
use crate::mesh::attributes::{Attribute, AttributeValues, Attributes};
use crate::mesh::trimesh::TriMesh;
use crate::patch::PatchSurface;

/// Names of attributes that are colours, whatever their type.
const COLORS: [&str; 8] = ["red", "green", "blue", "alpha", "r", "g", "b", "a"];
/// Names of the components of a vertex normal.
const NORMALS: [&str; 3] = ["nx", "ny", "nz"];

/// Attribute values of a patch.
#[derive(Clone, Debug, Default)]
pub(crate) struct CarriedAttributes {
    /// For each new vertex the mesh vertex whose attributes it copies where nothing better is known.
    pub(crate) vertex_sources: Vec<u32>,
    /// Values of the new vertices in those vertex columns, by position, that are not copied.
    pub(crate) vertex_values: Vec<(usize, Vec<f64>)>,
    /// For each new triangle the mesh triangle whose attributes it copies.
    pub(crate) face_sources: Vec<u32>,
}

impl CarriedAttributes {
    /// Appends the values for all new vertices and triangles.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when a source is not an element.
    pub(crate) fn append_to(
        &self,
        vertices: &mut Attributes,
        faces: &mut Attributes,
    ) -> Result<()> {
        let computed: Vec<(String, &[f64])> = self
            .vertex_values
            .iter()
            .map(|(c, values)| (vertices.columns()[*c].name.clone(), &values[..]))
            .collect();
        let sources: Vec<usize> = self.vertex_sources.iter().map(|&v| v as usize).collect();
        vertices.append_with(&sources, |column, j| {
            match computed.iter().find(|(name, _)| *name == column.name) {
                Some((_, values)) => values[j],
                None => column.values.number(sources[j]).unwrap_or(0.0),
            }
        })?;
        if faces.is_empty() {
            // A polyline has no triangle to copy from.
            faces.append_blank(self.face_sources.len());
            return Ok(());
        }
        let sources: Vec<usize> = self.face_sources.iter().map(|&f| f as usize).collect();
        faces.append_copies(&sources)
    }
}

/// Computes the attribute values of a patch. Does nothing for a mesh without attributes.
pub(crate) fn carry(mesh: &TriMesh, hole: &Hole, surface: &PatchSurface) -> CarriedAttributes {
    let mut carried = CarriedAttributes::default();
    let vertex_columns = mesh.vertex_attributes().columns();
    carried.vertex_sources = if vertex_columns.is_empty() {
        vec![0; surface.points.len() - surface.rim_count]
    } else {
        nearest_rim_vertices(hole, surface)
    };
    carried.face_sources = if mesh.face_attributes().columns().is_empty() {
        vec![0; surface.triangles.len()]
    } else {
        nearest_rim_faces(hole, surface)
    };
    if vertex_columns.is_empty() || surface.points.len() == surface.rim_count {
        return carried;
    }
    let normals: Vec<Option<usize>> = NORMALS
        .iter()
        .map(|name| {
            vertex_columns
                .iter()
                .position(|c| c.name == *name && is_float(c))
        })
        .collect();
    if let [Some(x), Some(y), Some(z)] = normals[..] {
        let values = vertex_normals(surface);
        for (k, column) in [x, y, z].into_iter().enumerate() {
            carried
                .vertex_values
                .push((column, values.iter().map(|n| n[k]).collect()));
        }
    }
    let smooth: Vec<usize> = (0..vertex_columns.len())
        .filter(|&c| varies_smoothly(&vertex_columns[c]))
        .filter(|&c| !carried.vertex_values.iter().any(|&(known, _)| known == c))
        .collect();
    let mut solver = SpdSolver::default();
    let at_rim = |c: usize| -> Vec<f64> {
        let value = |&v: &u32| vertex_columns[c].values.number(v as usize);
        hole.rim.iter().map(|v| value(v).unwrap_or(0.0)).collect()
    };
    // A value that is not a number would spread over the whole patch: such a column is copied.
    let known: Vec<(usize, Vec<f64>)> = smooth
        .into_iter()
        .map(|c| (c, at_rim(c)))
        .filter(|(_, values)| values.iter().all(|v| v.is_finite()))
        .collect();
    let largest = |values: &[f64]| values.iter().fold(f64::MIN_POSITIVE, |a, v| a.max(v.abs()));
    for columns in known.chunks(3) {
        // In units of the largest value, so that no sum overflows.
        let mut rim_values = vec![Vec3::zeros(); hole.rim.len()];
        for (k, (_, values)) in columns.iter().enumerate() {
            for (row, &value) in rim_values.iter_mut().zip(values) {
                row[k] = value / largest(values);
            }
        }
        let Ok(inside) = extend_from_rim(surface, &rim_values, &mut solver) else {
            continue;
        };
        for (k, (c, values)) in columns.iter().enumerate() {
            // Rounding may leave the rim's range, which the harmonic function itself does not.
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let inside = inside
                .iter()
                .map(|v| (v[k] * largest(values)).clamp(low, high))
                .collect();
            carried.vertex_values.push((*c, inside));
        }
    }
    carried
}

fn is_float(column: &Attribute) -> bool {
    matches!(column.values, AttributeValues::Scalars(_))
        && !column.values.scalar_type().is_integer()
}

fn varies_smoothly(column: &Attribute) -> bool {
    let is_color = COLORS.contains(&column.name.as_str());
    is_float(column) || (is_color && matches!(column.values, AttributeValues::Scalars(_)))
}

/// For each interior vertex the mesh index of a rim vertex that is reached over the fewest edges.
fn nearest_rim_vertices(hole: &Hole, surface: &PatchSurface) -> Vec<u32> {
    let count = surface.points.len();
    let mut starts = vec![0_u32; count + 1];
    for v in surface.triangles.iter().flatten() {
        starts[*v as usize + 1] += 2;
    }
    for v in 0..count {
        starts[v + 1] += starts[v];
    }
    let mut slots = starts.clone();
    let mut neighbours = vec![0_u32; 6 * surface.triangles.len()];
    for t in &surface.triangles {
        for k in 0..3 {
            for other in [t[(k + 1) % 3], t[(k + 2) % 3]] {
                let slot = &mut slots[t[k] as usize];
                neighbours[*slot as usize] = other;
                *slot += 1;
            }
        }
    }
    let mut source: Vec<Option<u32>> = hole.rim.iter().map(|&v| Some(v)).collect();
    source.resize(count, None);
    let mut queue: Vec<u32> = (0..surface.rim_count as u32).collect();
    let mut head = 0;
    while let Some(&v) = queue.get(head) {
        head += 1;
        for &w in &neighbours[starts[v as usize] as usize..starts[v as usize + 1] as usize] {
            if source[w as usize].is_none() {
                source[w as usize] = source[v as usize];
                queue.push(w);
            }
        }
    }
    source[surface.rim_count..]
        .iter()
        .map(|s| s.unwrap_or(hole.rim[0]))
        .collect()
}

/// For each triangle the triangle along the rim that is reached over the fewest edges.
fn nearest_rim_faces(hole: &Hole, surface: &PatchSurface) -> Vec<u32> {
    let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * surface.triangles.len());
    for (f, t) in surface.triangles.iter().enumerate() {
        edges.extend((0..3).map(|k| (t[k], t[(k + 1) % 3], f as u32)));
    }
    edges.sort_unstable();
    let face_at = |a: u32, b: u32| {
        let i = edges.partition_point(|&(x, y, _)| (x, y) < (a, b));
        edges.get(i).filter(|e| (e.0, e.1) == (a, b)).map(|e| e.2)
    };
    let mut source = vec![None; surface.triangles.len()];
    let mut queue = Vec::with_capacity(surface.triangles.len());
    let m = hole.shape.polygon.len();
    for i in 0..m {
        let face = face_at(hole.shape.polygon[i], hole.shape.polygon[(i + 1) % m]);
        if let (Some(face), Some(outside)) = (face, hole.outside_faces[i])
            && source[face as usize].is_none()
        {
            source[face as usize] = Some(outside);
            queue.push(face);
        }
    }
    let mut head = 0;
    while let Some(&f) = queue.get(head) {
        head += 1;
        let t = surface.triangles[f as usize];
        for k in 0..3 {
            if let Some(g) = face_at(t[(k + 1) % 3], t[k])
                && source[g as usize].is_none()
            {
                source[g as usize] = source[f as usize];
                queue.push(g);
            }
        }
    }
    source.into_iter().map(|s| s.unwrap_or(0)).collect()
}

/// Area-weighted unit normals of the interior vertices.
fn vertex_normals(surface: &PatchSurface) -> Vec<Vec3> {
    let mut sums = vec![Vec3::zeros(); surface.points.len()];
    for t in &surface.triangles {
        let [a, b, c] = t.map(|v| &surface.points[v as usize]);
        let normal = cross_normal(a, b, c);
        for &v in t {
            sums[v as usize] += normal;
        }
    }
    sums[surface.rim_count..].iter().map(|&n| unit(n)).collect()
}
