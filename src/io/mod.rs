//! Mesh files as plain arrays: PLY, OBJ, OFF and STL; points also from XYZ.
//!
//! [`read`] and [`write()`] choose the format by the extension of the file. Reading keeps all vertices and triangles
//! in the order of the file, and their other data as [`Attributes`]. Notes tell what was lost. The contents are not
//! checked beyond the format: coordinates may be NaN and triangles may be degenerate, but every index has its vertex.
//!
//! The parsers are our own, because `ply-rs`, `tobj` and `stl_io` lose vertices, precision or the line of an error,
//! or are slow. Cost: linear in the size of a file; STL takes O(n log n).

mod atomic;
mod mesh_data;
mod obj;
mod off;
mod ply;
mod polygons;
mod stl;
mod text;
mod xyz;

pub use atomic::{check_destination, is_same_destination, replace};
pub use mesh_data::MeshData;
pub use ply::details::{PlyDetails, PlyElement, PlyEncoding};

use crate::error::{Error, ErrorKind, Result};
use crate::mesh::attributes::Attributes;
use std::path::Path;
use text::parse_error;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Ply,
    Obj,
    Off,
    Stl,
}

impl Format {
    fn of(path: &Path) -> Result<Self> {
        let extension = path
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        match extension.as_str() {
            "ply" => Ok(Self::Ply),
            "obj" => Ok(Self::Obj),
            "off" => Ok(Self::Off),
            "stl" => Ok(Self::Stl),
            _ => Err(Error::invalid(format!(
                "{}: unknown file type; the known extensions are .ply, .obj, .off and .stl",
                path.display()
            ))),
        }
    }

    fn parse(self, bytes: &[u8]) -> Result<MeshData> {
        if bytes.is_empty() {
            return Err(parse_error("the file is empty"));
        }
        match self {
            Self::Ply => ply::parse(bytes),
            Self::Obj => obj::parse(bytes),
            Self::Off => off::parse(bytes),
            Self::Stl => stl::parse(bytes),
        }
    }
}

/// Checks that [`read`] and [`write()`] know the extension of `path`.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] with the known extensions.
pub fn check_extension(path: impl AsRef<Path>) -> Result<()> {
    Format::of(path.as_ref()).map(|_| ())
}

/// Whether `path` ends in `.xyz` or `.txt`, the extensions of files of points.
fn is_xyz(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["xyz", "txt"]
        .iter()
        .any(|known| extension.eq_ignore_ascii_case(known))
}

/// Reads the mesh file at `path`.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] for an unknown extension, [`ErrorKind::Io`] when the file cannot be
/// read, [`ErrorKind::Parse`] with the line, byte or face when its contents are not a mesh in that
/// format, [`ErrorKind::Limit`] for more vertices than `u32` can number.
///
/// # Complexity
/// Linear in the size of the file, which is held in memory; for STL, O(n log n) in the number of triangles. Counts in
/// the file are checked against its size before memory is allocated.
pub fn read(path: impl AsRef<Path>) -> Result<MeshData> {
    let path = path.as_ref();
    let format = Format::of(path)?;
    read_as(path, |bytes| format.parse(bytes))
}

/// Reads the points of the file at `path`. A mesh file gives its vertices with their attributes. A text file of
/// points (`.xyz` or `.txt`) has 3, 6 or 9 numbers on a line: position, normal, color. Normals become the attributes
/// `nx`, `ny`, `nz`; colors become `red`, `green`, `blue`. The result has no triangles; a note tells how many were
/// left out.
///
/// # Errors
/// As [`read`].
///
/// # Complexity
/// As [`read`].
pub fn read_points(path: impl AsRef<Path>) -> Result<MeshData> {
    let path = path.as_ref();
    if is_xyz(path) {
        return read_as(path, xyz::parse);
    }
    let format = Format::of(path).map_err(|_| {
        Error::invalid(format!(
            "{}: unknown file type; points are read from .ply, .xyz, .txt, .obj, .off and .stl",
            path.display()
        ))
    })?;
    let mut data = read_as(path, |bytes| format.parse(bytes))?;
    if !data.triangles.is_empty() {
        data.notes.push(format!(
            "{} triangles left out: only the points are used",
            data.triangles.len()
        ));
        data.triangles = Vec::new();
        data.face_attributes = Attributes::new(0);
    }
    Ok(data)
}

fn read_as(path: &Path, parse: impl FnOnce(&[u8]) -> Result<MeshData>) -> Result<MeshData> {
    let bytes = std::fs::read(path).map_err(|error| {
        Error::new(
            ErrorKind::Io,
            format!("cannot read {}: {error}", path.display()),
        )
    })?;
    parse(&bytes).map_err(|error| {
        Error::new(
            error.kind(),
            format!("{}: {}", path.display(), error.message()),
        )
    })
}

/// Writes `mesh` to `path`, completely or not at all. An existing file is replaced.
///
/// Returns what the format could not store, one sentence for each. PLY stores everything. OBJ and OFF store
/// positions, triangles and the vertex colors `red`, `green`, `blue` (OFF also `alpha`). STL stores positions in
/// single precision and triangles. If a file is read and written in the same format, reading the result gives the
/// same bits, except for the order of vertices of STL.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] for an unknown extension, attributes of a wrong length or with names that the format
/// does not allow, an index without a vertex, or a finite coordinate beyond single precision in a format that has
/// only that; [`ErrorKind::Io`] when the file cannot be written.
pub fn write(path: impl AsRef<Path>, mesh: &MeshData) -> Result<Vec<String>> {
    let path = path.as_ref();
    let format = Format::of(path)?;
    mesh.check()?;
    match format {
        Format::Ply => {
            ply::check(mesh)?;
            atomic::replace(path, |out| ply::write(mesh, out))?;
            Ok(Vec::new())
        }
        Format::Obj => {
            atomic::replace(path, |out| obj::write(mesh, out))?;
            Ok(lost_attributes(mesh, &["red", "green", "blue"]))
        }
        Format::Off => {
            atomic::replace(path, |out| off::write(mesh, out))?;
            Ok(lost_attributes(mesh, &["red", "green", "blue", "alpha"]))
        }
        Format::Stl => {
            stl::check(mesh)?;
            atomic::replace(path, |out| stl::write(mesh, out))?;
            let mut notes = lost_attributes(mesh, &[]);
            notes.extend(stl::rounding_note(mesh));
            Ok(notes)
        }
    }
}

/// Notes on the attributes that are lost in a format without attributes but the vertex colors `kept_colors`.
fn lost_attributes(mesh: &MeshData, kept_colors: &[&str]) -> Vec<String> {
    let kept = if mesh.vertex_colors().is_some() {
        kept_colors
    } else {
        &[]
    };
    let vertex = mesh
        .vertex_attributes
        .iter()
        .map(|column| column.name.as_str());
    let face = mesh
        .face_attributes
        .iter()
        .map(|column| column.name.as_str());
    let lost_vertex: Vec<_> = vertex.filter(|name| !kept.contains(name)).collect();
    let lost_face: Vec<_> = face.collect();
    let elements: Vec<_> = mesh.ply.elements.iter().map(|e| e.name.as_str()).collect();
    [
        ("vertex attributes", lost_vertex),
        ("face attributes", lost_face),
        ("elements", elements),
    ]
    .into_iter()
    .filter(|(_, names)| !names.is_empty())
    .map(|(what, names)| format!("{what} not written: {}", names.join(", ")))
    .collect()
}

#[cfg(test)]
mod tests;
