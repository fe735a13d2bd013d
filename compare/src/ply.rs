//! Binary little endian PLY with triangles: only the form that the cases and both programs use.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::{Error, Result};

/// Points and triangles, in file order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mesh {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

#[derive(Clone, Copy)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(name: &str) -> Result<Self> {
        Ok(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return Err(format!("unknown PLY type {name}").into()),
        })
    }
}

struct Property {
    name: String,
    count: Option<Scalar>,
    scalar: Scalar,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

struct Bytes<'a> {
    rest: &'a [u8],
}

impl<'a> Bytes<'a> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        let (head, rest) = self
            .rest
            .split_first_chunk()
            .ok_or("the PLY file is cut short")?;
        self.rest = rest;
        Ok(*head)
    }

    fn line(&mut self) -> Result<&'a str> {
        let end = self
            .rest
            .iter()
            .position(|&b| b == b'\n')
            .ok_or("the PLY header has no end")?;
        let line = std::str::from_utf8(&self.rest[..end])?.trim();
        self.rest = &self.rest[end + 1..];
        Ok(line)
    }

    fn scalar(&mut self, scalar: Scalar) -> Result<f64> {
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            Scalar::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Scalar::F64 => f64::from_le_bytes(self.take()?),
        })
    }
}

fn header(bytes: &mut Bytes<'_>) -> Result<Vec<Element>> {
    if bytes.line()? != "ply" {
        return Err("not a PLY file".into());
    }
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let words: Vec<&str> = bytes.line()?.split_whitespace().collect();
        match words.as_slice() {
            ["end_header"] => return Ok(elements),
            ["format", "binary_little_endian", _] | ["comment" | "obj_info", ..] => {}
            ["element", name, count] => elements.push(Element {
                name: (*name).to_owned(),
                count: count.parse()?,
                properties: Vec::new(),
            }),
            ["property", middle @ .., name] => {
                let (count, scalar) = match middle {
                    ["list", count, scalar] => (Some(Scalar::parse(count)?), scalar),
                    [scalar] => (None, scalar),
                    _ => return Err("a PLY property that is not understood".into()),
                };
                let element = elements
                    .last_mut()
                    .ok_or("a PLY property before any element")?;
                element.properties.push(Property {
                    name: (*name).to_owned(),
                    count,
                    scalar: Scalar::parse(scalar)?,
                });
            }
            other => return Err(format!("PLY header line not understood: {other:?}").into()),
        }
    }
}

fn row(bytes: &mut Bytes<'_>, element: &Element, mesh: &mut Mesh) -> Result<()> {
    let mut point = [0.0; 3];
    for property in &element.properties {
        let Some(count) = property.count else {
            let value = bytes.scalar(property.scalar)?;
            if let Some(axis) = ["x", "y", "z"]
                .iter()
                .position(|name| *name == property.name)
            {
                point[axis] = value;
            }
            continue;
        };
        let count = bytes.scalar(count)? as usize;
        let values = (0..count)
            .map(|_| bytes.scalar(property.scalar))
            .collect::<Result<Vec<_>>>()?;
        if element.name == "face" && property.name.starts_with("vertex_ind") {
            let [a, b, c] = values[..] else {
                return Err("a face that is not a triangle".into());
            };
            if [a, b, c]
                .iter()
                .any(|&v| v < 0.0 || v >= mesh.points.len() as f64)
            {
                return Err("a face names a vertex that does not exist".into());
            }
            mesh.triangles.push([a as u32, b as u32, c as u32]);
        }
    }
    if element.name == "vertex" {
        mesh.points.push(point);
    }
    Ok(())
}

fn parse(data: &[u8]) -> Result<Mesh> {
    let mut bytes = Bytes { rest: data };
    let mut mesh = Mesh::default();
    for element in header(&mut bytes)? {
        for _ in 0..element.count {
            row(&mut bytes, &element, &mut mesh)?;
        }
    }
    Ok(mesh)
}

fn bytes_of(mesh: &Mesh) -> Vec<u8> {
    let mut head = String::from("ply\nformat binary_little_endian 1.0\n");
    let (vertices, faces) = (mesh.points.len(), mesh.triangles.len());
    let _ = write!(
        head,
        "element vertex {vertices}\nproperty double x\nproperty double y\n"
    );
    let _ = write!(head, "property double z\nelement face {faces}\n");
    head.push_str("property list uchar int vertex_indices\nend_header\n");
    let mut out = head.into_bytes();
    out.reserve(24 * vertices + 13 * faces);
    for x in mesh.points.iter().flatten() {
        out.extend_from_slice(&x.to_le_bytes());
    }
    for triangle in &mesh.triangles {
        out.push(3);
        for v in triangle {
            out.extend_from_slice(&v.to_le_bytes());
        }
    }
    out
}

/// Reads the points and triangles of a file; every other property is skipped.
pub(crate) fn read(path: &Path) -> Result<Mesh> {
    let data = fs::read(path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
    parse(&data).map_err(|e| Error::from(format!("{}: {e}", path.display())))
}

/// Writes a file with double coordinates.
pub(crate) fn write(path: &Path, mesh: &Mesh) -> Result<()> {
    fs::write(path, bytes_of(mesh))
        .map_err(|e| format!("cannot write {}: {e}", path.display()).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        Mesh {
            points: vec![
                [0.0, 0.1, -3.5],
                [1e300, 0.0, 0.0],
                [0.0, 1.0, f64::MIN_POSITIVE],
            ],
            triangles: vec![[0, 1, 2], [2, 1, 0]],
        }
    }

    #[test]
    fn a_written_mesh_is_read_back_bit_for_bit() {
        assert_eq!(parse(&bytes_of(&triangle())).unwrap(), triangle());
    }

    #[test]
    fn other_properties_are_skipped() {
        let mut data = b"ply\nformat binary_little_endian 1.0\ncomment c\nelement vertex 1\n\
            property float x\nproperty uchar red\nproperty float y\nproperty float z\n\
            element face 1\nproperty list uchar float extra\nproperty list uchar uint vertex_indices\n\
            property short tag\nend_header\n"
            .to_vec();
        data.extend_from_slice(&1.5f32.to_le_bytes());
        data.push(9);
        data.extend_from_slice(&2.5f32.to_le_bytes());
        data.extend_from_slice(&3.5f32.to_le_bytes());
        data.push(1);
        data.extend_from_slice(&7.0f32.to_le_bytes());
        data.push(3);
        data.extend_from_slice(&[0; 12]);
        data.extend_from_slice(&[1, 0]);
        let mesh = parse(&data).unwrap();
        assert_eq!(mesh.points, [[1.5, 2.5, 3.5]]);
        assert_eq!(mesh.triangles, [[0, 0, 0]]);
    }

    #[test]
    fn a_file_cut_short_is_refused_at_every_length() {
        let data = bytes_of(&triangle());
        for end in 0..data.len() {
            assert!(parse(&data[..end]).is_err(), "{end} bytes");
        }
    }

    #[test]
    fn a_face_that_names_a_missing_vertex_is_refused() {
        let mut mesh = triangle();
        mesh.triangles.push([0, 1, 3]);
        assert!(parse(&bytes_of(&mesh)).is_err());
    }
}
