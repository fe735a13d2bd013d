//! Reads and writes OFF, the Geomview object file format, as text: `OFF`, `COFF`, `NOFF` and `CNOFF`.

use super::mesh_data::{MeshData, check_vertex_count};
use super::obj::unit_channel;
use super::polygons::Polygons;
use super::text::{Lines, parse_number, quoted, tokens};
use crate::error::Result;
use crate::mesh::attributes::{AttributeValues, Attributes, ScalarType, ScalarValues};
use std::io::{self, Write};

const COMMENT: Option<u8> = Some(b'#');
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];
const COLOR: [&str; 4] = ["red", "green", "blue", "alpha"];

struct OffHeader {
    has_normals: bool,
    vertices: usize,
    faces: usize,
}

pub(super) fn parse(bytes: &[u8]) -> Result<MeshData> {
    let mut lines = Lines::new(bytes);
    let header = read_header(&mut lines)?;
    check_vertex_count(header.vertices)?;
    let mut mesh = read_vertices(&mut lines, &header)?;
    let (polygons, colored) = read_faces(&mut lines, header.faces, header.vertices)?;
    if lines.next_filled(COMMENT).is_some() {
        return Err(lines.error("more lines than the header promises"));
    }
    let notes: Vec<_> = polygons.notes().collect();
    mesh.notes.extend(notes);
    if colored > 0 {
        mesh.notes
            .push(format!("the colors of {colored} faces left out"));
    }
    Ok(MeshData {
        face_attributes: Attributes::new(polygons.triangles.len()),
        triangles: polygons.triangles,
        ..mesh
    })
}

/// Reads the keyword and the counts. The counts may be on the line of the keyword, even without a space between.
fn read_header(lines: &mut Lines) -> Result<OffHeader> {
    let line = lines
        .next_filled(COMMENT)
        .ok_or_else(|| lines.end_error("there is no header"))?;
    let line = line.trim_ascii();
    let keywords: [(&[u8], bool); 4] = [
        (b"OFF", false),
        (b"COFF", false),
        (b"NOFF", true),
        (b"CNOFF", true),
    ];
    let found = keywords
        .into_iter()
        .find_map(|(keyword, has_normals)| Some((line.strip_prefix(keyword)?, has_normals)));
    let Some((rest, has_normals)) = found else {
        return Err(lines.error(format!(
            "an OFF file begins with OFF, COFF, NOFF or CNOFF, not {}",
            quoted(line)
        )));
    };
    let counts = if rest.is_empty() {
        lines
            .next_filled(COMMENT)
            .ok_or_else(|| lines.end_error("there are no counts"))?
    } else {
        rest
    };
    let mut words = tokens(counts);
    let vertices = lines.number_from(&mut words, "the number of vertices")?;
    let faces = lines.number_from(&mut words, "the number of faces")?;
    // The number of edges is not needed, and is often wrong or missing.
    if words.clone().count() > 1 || !words.all(|word| parse_number::<i64>(word).is_some()) {
        return Err(lines.error("the counts are those of vertices, faces and edges"));
    }
    // The shortest vertex is "0 0 0" and the shortest face is "0", each with a line break except the last.
    let available = lines.rest().len() as u128 + 1;
    if vertices as u128 * 6 + faces as u128 * 2 > available {
        return Err(lines.error(format!(
            "{vertices} vertices and {faces} faces are too many for the {} bytes left",
            lines.rest().len()
        )));
    }
    Ok(OffHeader {
        has_normals,
        vertices,
        faces,
    })
}

fn read_vertices(lines: &mut Lines, header: &OffHeader) -> Result<MeshData> {
    let mut positions = Vec::with_capacity(header.vertices);
    let normal_count = if header.has_normals { NORMAL.len() } else { 0 };
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); normal_count];
    let mut are_bytes = true;
    for k in 0..header.vertices {
        let line = lines.next_filled(COMMENT).ok_or_else(|| {
            lines.end_error(format!("vertex {k} of {} is missing", header.vertices))
        })?;
        let mut words = tokens(line);
        positions.push(lines.position_from(&mut words)?);
        let others = words.clone().count();
        if k == 0 {
            if others < normal_count || ![0, 3, 4].contains(&(others - normal_count)) {
                return Err(lines.error(format!("a vertex cannot have {} values", 3 + others)));
            }
            columns.resize(others, Vec::new());
        }
        if others != columns.len() {
            return Err(lines.error(format!(
                "vertex {k} has {} values, but the first vertex {}",
                3 + others,
                3 + columns.len()
            )));
        }
        for (c, (word, column)) in words.zip(&mut columns).enumerate() {
            column.push(lines.number_from(&mut std::iter::once(word), "a color or normal")?);
            are_bytes &= c < normal_count || parse_number::<u8>(word).is_some();
        }
    }
    let mut mesh = MeshData::new(positions, Vec::new());
    let names = NORMAL[..normal_count].iter().chain(&COLOR);
    for (k, (name, column)) in names.zip(columns).enumerate() {
        let is_color = k >= normal_count;
        let mut values = ScalarValues::new(match (is_color, are_bytes) {
            (false, _) => ScalarType::F64,
            (true, true) => ScalarType::U8,
            (true, false) => ScalarType::F32,
        });
        column.into_iter().for_each(|value| values.push(value));
        mesh.vertex_attributes
            .push(*name, AttributeValues::Scalars(values))?;
    }
    Ok(mesh)
}

/// Reads the faces. Also returns the number of faces with a color.
fn read_faces(lines: &mut Lines, count: usize, vertex_count: usize) -> Result<(Polygons, usize)> {
    let mut polygons = Polygons::with_capacity(count);
    let mut colored = 0;
    let mut corners = Vec::new();
    while polygons.faces() < count {
        let face = polygons.faces();
        let line = lines
            .next_filled(COMMENT)
            .ok_or_else(|| lines.end_error(format!("face {face} of {count} is missing")))?;
        let mut words = tokens(line);
        let corner_count: u32 = lines.number_from(&mut words, "the number of corners")?;
        corners.clear();
        for _ in 0..corner_count {
            let index: u32 = lines.number_from(&mut words, "a corner")?;
            if index as usize >= vertex_count {
                return Err(lines.error(format!(
                    "a face has the vertex index {index}, but there are {vertex_count} vertices"
                )));
            }
            corners.push(index);
        }
        polygons.push(&corners);
        // A single number is an index into a color map.
        let color_count = words.clone().count();
        if color_count > COLOR.len() || !words.all(|word| parse_number::<f64>(word).is_some()) {
            return Err(lines.error("after the corners of a face there may be a color only"));
        }
        colored += usize::from(color_count > 0);
    }
    Ok((polygons, colored))
}

/// Writes a mesh. Positions have double precision, which represents single precision exactly. Colors in bytes are
/// written as bytes. Others are written as fractions, always with a decimal point.
pub(super) fn write(mesh: &MeshData, out: &mut impl Write) -> io::Result<()> {
    let colors = mesh.vertex_colors().unwrap_or_default();
    let are_bytes = colors
        .iter()
        .all(|channel| channel.scalar_type() == ScalarType::U8);
    writeln!(out, "{}", if colors.is_empty() { "OFF" } else { "COFF" })?;
    writeln!(out, "{} {} 0", mesh.positions.len(), mesh.triangles.len())?;
    for (k, [x, y, z]) in mesh.positions.iter().enumerate() {
        write!(out, "{x:?} {y:?} {z:?}")?;
        for channel in &colors {
            match channel.number(k) {
                Some(value) if are_bytes => write!(out, " {value}")?,
                _ => write!(out, " {:?}", unit_channel(channel, k))?,
            }
        }
        out.write_all(b"\n")?;
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(out, "3 {a} {b} {c}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    const BODY: &str = "0 0 0\n1 0 0 # corner\n\n# comment\n0 1 0\n3 0 1 2\n";

    #[test]
    fn the_counts_may_be_on_the_line_of_the_keyword_or_the_next() {
        for header in [
            "OFF\n3 1 0\n",
            "OFF 3 1 0\n",
            "OFF3 1 3\n",
            "# c\n\nOFF # c\n# c\n3 1\n",
        ] {
            let mesh = parse(format!("{header}{BODY}").as_bytes()).unwrap();
            assert_eq!(mesh.triangles, [[0, 1, 2]], "{header:?}");
            assert_eq!(mesh.positions[2], [0.0, 1.0, 0.0]);
            assert!(mesh.notes.is_empty());
        }
    }

    #[test]
    fn colors_are_bytes_or_fractions() {
        let mesh = parse(b"COFF 2 0 0\n0 0 0 255 0 1 9\n0 0 0 1 1 0 8\n").unwrap();
        let alpha = mesh.vertex_attributes.get("alpha").unwrap();
        assert_eq!(
            *alpha,
            AttributeValues::Scalars(ScalarValues::U8(vec![9, 8]))
        );
        let mesh = parse(b"OFF 2 0 0\n0 0 0 1 0 1\n0 0 0 0.5 1 0\n").unwrap();
        let red = mesh.vertex_attributes.get("red").unwrap();
        assert_eq!(
            *red,
            AttributeValues::Scalars(ScalarValues::F32(vec![1.0, 0.5]))
        );
        let mesh = parse(b"CNOFF 1 0 0\n0 0 0 0 0 1 7 8 9\n").unwrap();
        let names: Vec<_> = mesh
            .vertex_attributes
            .iter()
            .map(|a| a.name.as_str())
            .collect();
        assert_eq!(names, ["nx", "ny", "nz", "red", "green", "blue"]);
    }

    #[test]
    fn polygons_are_cut_and_face_colors_left_out() {
        let text = "OFF 4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 1 2 0.5\n";
        let mesh = parse(text.as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
        assert_eq!(mesh.notes.len(), 2);
        assert_eq!(mesh.face_attributes.len(), 3);
    }

    #[test]
    fn a_broken_file_is_an_error_at_its_line() {
        let cases = [
            ("", "the file ends after line 0"),
            ("PLY\n", "line 1: an OFF file begins"),
            (
                "OFF BINARY\n",
                "line 1: the number of vertices cannot be \"BINARY\"",
            ),
            ("OFF\n3\n", "line 2: the number of faces is missing"),
            ("OFF\n3 1 0 7\n", "line 2: the counts are"),
            ("OFF\n-3 1 0\n", "line 2: the number of vertices cannot be"),
            (
                "OFF\n99999999999999999 1 0\n0 0 0\n",
                "line 2: 99999999999999999 vertices and",
            ),
            ("OFF 1 0 0\n0 0\n0 0 0", "line 2: z is missing"),
            ("OFF 1 0 0\n0 0 0 1\n", "line 2: a vertex cannot have 4"),
            ("OFF 2 0 0\n0 0 0\n0 0 0 1 1 1\n", "line 3: vertex 1 has 6"),
            (
                "OFF 2 0 0\n0 0 000000000\n",
                "the file ends after line 2: vertex 1",
            ),
            ("OFF 1 1 0\n0 0 0\n", "line 1: 1 vertices and"),
            (
                "OFF 1 2 0\n0 0 0\n3 0 0 0\n",
                "the file ends after line 3: face 1",
            ),
            (
                "OFF 1 1 0\n0 0 0\n3 0 0 1\n",
                "line 3: a face has the vertex index 1",
            ),
            ("OFF 1 1 0\n0 0 0\n3 0 0 -1\n", "line 3: a corner cannot be"),
            ("OFF 1 1 0\n0 0 0\n3 0 0\n", "line 3: a corner is missing"),
            (
                "OFF 1 1 0\n0 0 0\n3 0 0 0 red\n",
                "line 3: after the corners",
            ),
            ("OFF 1 1 0\n0 0 0\n3 0 0 0\n3 0 0 0\n", "line 4: more lines"),
        ];
        for (text, start) in cases {
            let error = parse(text.as_bytes()).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Parse);
            assert!(error.message().starts_with(start), "{text:?} gives {error}");
        }
    }
}
