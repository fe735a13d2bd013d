//! Writes a mesh as PLY.

use super::super::mesh_data::{MeshData, check_single_precision};
use super::details::{PlyDetails, PlyEncoding};
use super::header::type_name;
use super::number::{Encoded, encode_count, largest};
use crate::error::{Error, Result};
use crate::mesh::attributes::{
    Attribute, AttributeValues, Attributes, ListValues, ScalarType, ScalarValues, with_scalars,
};
use std::io::{self, Write};

/// Refuses a mesh whose PLY file could not be read again.
pub(crate) fn check(mesh: &MeshData) -> Result<()> {
    if mesh.position_type == ScalarType::F32 {
        check_single_precision(mesh)?;
    }
    let details = &mesh.ply;
    for remark in &details.remarks {
        let is_remark = matches!(
            remark.split_whitespace().next(),
            Some("comment" | "obj_info")
        );
        if !is_remark || remark.contains(['\n', '\r']) {
            return Err(Error::invalid(format!(
                "not a comment or obj_info line: {remark:?}"
            )));
        }
    }
    check_rows("vertex", &mesh.vertex_attributes, &["x", "y", "z"])?;
    check_rows("face", &mesh.face_attributes, &[details.corner_list.name])?;
    for (k, element) in details.elements.iter().enumerate() {
        let name = &element.name;
        let is_repeated = details.elements[..k]
            .iter()
            .any(|other| other.name == *name);
        if !is_word(name) || is_repeated || ["vertex", "face"].contains(&name.as_str()) {
            return Err(Error::invalid(format!(
                "a PLY file cannot have one more element {name:?}"
            )));
        }
        check_rows(name, &element.rows, &[])?;
    }
    Ok(())
}

fn check_rows(element: &str, rows: &Attributes, taken: &[&str]) -> Result<()> {
    for Attribute { name, values } in rows {
        if !is_word(name) || taken.contains(&name.as_str()) {
            return Err(Error::invalid(format!(
                "a PLY file cannot have a {element} property {name:?}"
            )));
        }
        if let AttributeValues::Lists(lists) = values {
            let longest = (0..lists.len())
                .filter_map(|k| lists.range(k))
                .map(|r| r.len())
                .max();
            if longest > largest(lists.count_type()) {
                return Err(Error::invalid(format!(
                    "{element} property {name} has too long a list"
                )));
            }
        }
    }
    Ok(())
}

/// Whether `name` is one token of a header line.
fn is_word(name: &str) -> bool {
    !name.is_empty() && !name.contains(|c: char| c.is_ascii_whitespace())
}

/// Writes `mesh`, which has passed [`check`].
pub(crate) fn write(mesh: &MeshData, out: &mut impl Write) -> io::Result<()> {
    let details = &mesh.ply;
    let encoding = details.encoding;
    let is_single = mesh.position_type == ScalarType::F32;
    let (before_position, after_position) =
        split(&mesh.vertex_attributes, details.vertex_attributes_before);
    let (before_corners, after_corners) =
        split(&mesh.face_attributes, details.face_attributes_before);
    let index_type = index_type(details, mesh.positions.len());

    writeln!(out, "ply\nformat {} 1.0", encoding.name())?;
    for remark in &details.remarks {
        writeln!(out, "{remark}")?;
    }
    writeln!(out, "element vertex {}", mesh.positions.len())?;
    declare(before_position, out)?;
    let position_type = type_name(if is_single {
        ScalarType::F32
    } else {
        ScalarType::F64
    });
    for axis in ["x", "y", "z"] {
        writeln!(out, "property {position_type} {axis}")?;
    }
    declare(after_position, out)?;
    writeln!(out, "element face {}", mesh.triangles.len())?;
    declare(before_corners, out)?;
    let corner_list = &details.corner_list;
    let (count_name, index_name) = (type_name(corner_list.count_type), type_name(index_type));
    writeln!(
        out,
        "property list {count_name} {index_name} {}",
        corner_list.name
    )?;
    declare(after_corners, out)?;
    for element in &details.elements {
        writeln!(out, "element {} {}", element.name, element.rows.len())?;
        declare(element.rows.columns(), out)?;
    }
    writeln!(out, "end_header")?;

    for (k, position) in mesh.positions.iter().enumerate() {
        write_entries(before_position, k, encoding, out)?;
        for &coordinate in position {
            if is_single {
                (coordinate as f32).encode(encoding, out)?;
            } else {
                coordinate.encode(encoding, out)?;
            }
        }
        write_entries(after_position, k, encoding, out)?;
        end_row(encoding, out)?;
    }
    for (k, triangle) in mesh.triangles.iter().enumerate() {
        write_entries(before_corners, k, encoding, out)?;
        encode_count(triangle.len(), corner_list.count_type, encoding, out)?;
        for &corner in triangle {
            encode_count(corner as usize, index_type, encoding, out)?;
        }
        write_entries(after_corners, k, encoding, out)?;
        end_row(encoding, out)?;
    }
    for element in details
        .elements
        .iter()
        .filter(|e| !e.rows.columns().is_empty())
    {
        for k in 0..element.rows.len() {
            write_entries(element.rows.columns(), k, encoding, out)?;
            end_row(encoding, out)?;
        }
    }
    Ok(())
}

/// The columns before and after the position or the list of corners.
fn split(attributes: &Attributes, before: usize) -> (&[Attribute], &[Attribute]) {
    let columns = attributes.columns();
    columns.split_at(before.min(columns.len()))
}

/// The type for vertex indices: that of the file that was read, or the next wider type that can number all vertices.
fn index_type(details: &PlyDetails, vertex_count: usize) -> ScalarType {
    [details.corner_list.index_type, ScalarType::I32]
        .into_iter()
        .find(|&t| largest(t).is_some_and(|largest| vertex_count.saturating_sub(1) <= largest))
        .unwrap_or(ScalarType::U32)
}

fn declare(columns: &[Attribute], out: &mut impl Write) -> io::Result<()> {
    for Attribute { name, values } in columns {
        let item = type_name(values.scalar_type());
        match values {
            AttributeValues::Scalars(_) => writeln!(out, "property {item} {name}")?,
            AttributeValues::Lists(lists) => {
                let count = type_name(lists.count_type());
                writeln!(out, "property list {count} {item} {name}")?;
            }
        }
    }
    Ok(())
}

fn write_entries(
    columns: &[Attribute],
    k: usize,
    encoding: PlyEncoding,
    out: &mut impl Write,
) -> io::Result<()> {
    for column in columns {
        match &column.values {
            AttributeValues::Scalars(values) => {
                with_scalars!(values, v => v[k].encode(encoding, out))?;
            }
            AttributeValues::Lists(lists) => write_list(lists, k, encoding, out)?,
        }
    }
    Ok(())
}

fn write_list(
    lists: &ListValues,
    k: usize,
    encoding: PlyEncoding,
    out: &mut impl Write,
) -> io::Result<()> {
    let range = lists.range(k).unwrap_or_default();
    encode_count(range.len(), lists.count_type(), encoding, out)?;
    with_scalars!(lists.items(), v => v[range].iter().try_for_each(|x| x.encode(encoding, out)))
}

fn end_row(encoding: PlyEncoding, out: &mut impl Write) -> io::Result<()> {
    if encoding == PlyEncoding::Ascii {
        out.write_all(b"\n")
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;
    use crate::mesh::attributes::ScalarValues;

    #[test]
    fn a_mesh_whose_file_could_not_be_read_again_is_refused() {
        let with = |change: fn(&mut MeshData)| {
            let mut mesh = MeshData::new(vec![[1e300, 0.0, 0.0]], Vec::new());
            change(&mut mesh);
            check(&mesh).map_err(|error| error.kind())
        };
        fn add(mesh: &mut MeshData, name: &str) {
            let values = AttributeValues::Scalars(ScalarValues::U8(vec![1]));
            mesh.vertex_attributes.push(name, values).unwrap();
        }
        assert_eq!(with(|_| ()), Ok(()));
        assert_eq!(with(|mesh| add(mesh, "w")), Ok(()));
        let refused: [fn(&mut MeshData); 7] = [
            |mesh| add(mesh, "x"),
            |mesh| add(mesh, "two words"),
            |mesh| add(mesh, ""),
            |mesh| mesh.position_type = ScalarType::F32,
            |mesh| mesh.ply.remarks.push("element".into()),
            |mesh| mesh.ply.remarks.push("comment a\nelement b 5".into()),
            |mesh| {
                let rows = Attributes::new(0);
                mesh.ply.elements.push(super::super::PlyElement {
                    name: "face".into(),
                    rows,
                });
            },
        ];
        for (k, change) in refused.into_iter().enumerate() {
            assert_eq!(with(change), Err(ErrorKind::InvalidInput), "case {k}");
        }
    }

    #[test]
    fn indices_get_a_wider_type_when_they_need_it() {
        let mut details = PlyDetails::default();
        assert_eq!(index_type(&details, 5), ScalarType::I32);
        details.corner_list.index_type = ScalarType::U8;
        assert_eq!(index_type(&details, 0), ScalarType::U8);
        assert_eq!(index_type(&details, 256), ScalarType::U8);
        assert_eq!(index_type(&details, 257), ScalarType::I32);
        assert_eq!(index_type(&details, 3_000_000_000), ScalarType::U32);
    }
}
