//! Reads and writes Wavefront OBJ: vertices with optional colors, and faces. Other statements are left out, with a
//! note.

use super::mesh_data::{MeshData, check_vertex_count};
use super::polygons::Polygons;
use super::text::{Lines, parse_error, parse_number, quoted, tokens};
use crate::error::Result;
use crate::mesh::attributes::{AttributeValues, Attributes, ScalarType, ScalarValues};
use std::borrow::Cow;
use std::io::{self, Write};

/// The color of a vertex without a color, in a file with colors.
const NO_COLOR: [f32; 3] = [1.0; 3];

/// The known statements that are left out. All others but `v` and `f` are errors.
const LEFT_OUT: [&str; 43] = [
    "vt",
    "vn",
    "vp",
    "g",
    "s",
    "o",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "l",
    "p",
    "fo",
    "cstype",
    "deg",
    "bmat",
    "step",
    "curv",
    "curv2",
    "surf",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "call",
    "csh",
    "bsp",
    "bzp",
    "cdc",
    "cdp",
    "res",
];

#[derive(Default)]
struct Reader {
    positions: Vec<[f64; 3]>,
    /// Empty before the first vertex with a color; after it, one color for each vertex.
    colors: Vec<[f32; 3]>,
    uncolored: usize,
    /// Vertices with a fourth coordinate.
    weights: usize,
    polygons: Polygons,
    /// The largest vertex index in faces so far, from 0, and its line. It is checked at the end, because faces may come
    /// before vertices.
    largest: Option<(usize, usize)>,
    /// How often each statement of `LEFT_OUT` occurred.
    left_out: Vec<usize>,
}

pub(super) fn parse(bytes: &[u8]) -> Result<MeshData> {
    let mut lines = Lines::new(bytes);
    let mut reader = Reader {
        left_out: vec![0; LEFT_OUT.len()],
        ..Reader::default()
    };
    let mut corners = Vec::new();
    while let Some(line) = next_statement(&mut lines) {
        let mut words = tokens(&line);
        match words.next() {
            None => {}
            Some(b"v") => reader.vertex(&lines, words)?,
            Some(b"f") => reader.face(&lines, words, &mut corners)?,
            Some(keyword) => {
                let known = LEFT_OUT.iter().position(|name| name.as_bytes() == keyword);
                let Some(k) = known else {
                    return Err(lines.error(format!("unknown statement {}", quoted(keyword))));
                };
                reader.left_out[k] += 1;
            }
        }
    }
    reader.finish()
}

/// The next line, without its comment. A line that ends with `\` is joined with the next one.
fn next_statement<'a>(lines: &mut Lines<'a>) -> Option<Cow<'a, [u8]>> {
    let mut statement = Cow::Borrowed(without_comment(lines.next_line()?));
    while statement.last() == Some(&b'\\') {
        let mut joined = statement.into_owned();
        joined.pop();
        joined.push(b' ');
        joined.extend_from_slice(lines.next_line().map_or(b"", without_comment));
        statement = Cow::Owned(joined);
    }
    Some(statement)
}

fn without_comment(line: &[u8]) -> &[u8] {
    let end = line.iter().position(|&b| b == b'#').unwrap_or(line.len());
    &line[..end]
}

impl Reader {
    fn vertex<'t>(
        &mut self,
        lines: &Lines,
        mut words: impl Iterator<Item = &'t [u8]> + Clone,
    ) -> Result<()> {
        let position = lines.position_from(&mut words)?;
        let color = match words.clone().count() {
            0 => None,
            1 => {
                lines.number_from::<f64>(&mut words, "w")?;
                self.weights += 1;
                None
            }
            3 => {
                let mut color = NO_COLOR;
                for (channel, name) in color.iter_mut().zip(["red", "green", "blue"]) {
                    *channel = lines.number_from(&mut words, name)?;
                }
                Some(color)
            }
            more => return Err(lines.error(format!("a vertex cannot have {} values", 3 + more))),
        };
        if color.is_some() && self.colors.is_empty() {
            self.colors.resize(self.positions.len(), NO_COLOR);
            self.uncolored = self.positions.len();
        }
        self.positions.push(position);
        if color.is_some() || !self.colors.is_empty() {
            self.uncolored += usize::from(color.is_none());
            self.colors.push(color.unwrap_or(NO_COLOR));
        }
        Ok(())
    }

    fn face<'t>(
        &mut self,
        lines: &Lines,
        words: impl Iterator<Item = &'t [u8]>,
        corners: &mut Vec<u32>,
    ) -> Result<()> {
        corners.clear();
        for word in words {
            let index = corner_index(word, self.positions.len())
                .ok_or_else(|| lines.error(format!("a face corner cannot be {}", quoted(word))))?;
            if self
                .largest
                .is_none_or(|(largest, _)| index as usize > largest)
            {
                self.largest = Some((index as usize, lines.number()));
            }
            corners.push(index);
        }
        self.polygons.push(corners);
        Ok(())
    }

    fn finish(self) -> Result<MeshData> {
        let count = self.positions.len();
        if count == 0 {
            return Err(parse_error("the file has no vertices"));
        }
        check_vertex_count(count)?;
        if let Some((index, line)) = self.largest.filter(|&(index, _)| index >= count) {
            return Err(super::text::line_error(
                line,
                format!("a face has the vertex {}, but there are {count}", index + 1),
            ));
        }
        let mut notes: Vec<String> = self.polygons.notes().collect();
        if self.weights > 0 {
            notes.push(format!(
                "the fourth coordinate of {} vertices left out",
                self.weights
            ));
        }
        if self.uncolored > 0 {
            notes.push(format!(
                "{} vertices without a color made white",
                self.uncolored
            ));
        }
        let left_out: Vec<_> = LEFT_OUT
            .iter()
            .zip(self.left_out)
            .filter(|&(_, times)| times > 0)
            .map(|(name, times)| format!("{name} ({times})"))
            .collect();
        if !left_out.is_empty() {
            notes.push(format!("statements left out: {}", left_out.join(", ")));
        }
        let mut vertex_attributes = Attributes::new(count);
        if !self.colors.is_empty() {
            for (k, name) in ["red", "green", "blue"].into_iter().enumerate() {
                let channel = self.colors.iter().map(|color| color[k]).collect();
                let values = AttributeValues::Scalars(ScalarValues::F32(channel));
                vertex_attributes.push(name, values)?;
            }
        }
        let mesh = MeshData::new(self.positions, self.polygons.triangles);
        Ok(MeshData {
            vertex_attributes,
            notes,
            ..mesh
        })
    }
}

/// The vertex index, from 0, of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`. A negative `v` counts back from the last of
/// the `count` vertices so far.
fn corner_index(word: &[u8], count: usize) -> Option<u32> {
    let mut parts = word.split(|&b| b == b'/');
    let index: i64 = parts.next().and_then(parse_number)?;
    let mut others = 0;
    for part in parts {
        others += 1;
        let is_texture = others == 1;
        if others > 2 || !(is_texture && part.is_empty() || parse_number::<i64>(part).is_some()) {
            return None;
        }
    }
    let from_zero = match index {
        1.. => index - 1,
        0 => return None,
        _ => i64::try_from(count).ok()?.checked_add(index)?,
    };
    u32::try_from(from_zero).ok()
}

/// Writes a mesh. Positions have double precision, which represents single precision exactly.
pub(super) fn write(mesh: &MeshData, out: &mut impl Write) -> io::Result<()> {
    let colors = mesh.vertex_colors();
    for (k, [x, y, z]) in mesh.positions.iter().enumerate() {
        write!(out, "v {x:?} {y:?} {z:?}")?;
        for channel in colors.iter().flatten().take(3) {
            write!(out, " {:?}", unit_channel(channel, k))?;
        }
        out.write_all(b"\n")?;
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| u64::from(v) + 1);
        writeln!(out, "f {a} {b} {c}")?;
    }
    Ok(())
}

/// Entry `k` of a color channel, scaled from 0 to 1. Floating-point channels already have this scale.
pub(super) fn unit_channel(channel: &AttributeValues, k: usize) -> f32 {
    let value = channel.number(k).unwrap_or(f64::from(NO_COLOR[0]));
    let full = match channel.scalar_type() {
        ScalarType::F32 | ScalarType::F64 => 1.0,
        ScalarType::U16 => f64::from(u16::MAX),
        _ => f64::from(u8::MAX),
    };
    (value / full) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    #[test]
    fn every_form_of_a_corner_is_read() {
        let text = "# a comment\nmtllib a.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0 # more\nvt 0 0\n\
                    vn 0 0 1\nf 1/1/1 2//1 3/1\nusemtl m\nf -3 -2\\\n -1\nv 9 9 9\nf 1 2 4\n";
        let mesh = parse(text.as_bytes()).unwrap();
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, 2], [0, 1, 3]]);
        assert_eq!(mesh.notes.len(), 2);
        assert!(
            mesh.notes[1].contains("vt (1), vn (1), usemtl (1), mtllib (1)"),
            "{:?}",
            mesh.notes
        );
    }

    #[test]
    fn polygons_are_cut_and_faces_may_precede_their_vertices() {
        let text = "f 1 2 3 4 5\nf 1 2\nv 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 2 0\n";
        let mesh = parse(text.as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        assert_eq!(mesh.notes.len(), 2);
    }

    #[test]
    fn a_backslash_joins_lines_but_not_in_a_comment() {
        let text =
            "# C:\\\nv 0 0 0\nv 1 \\\r\n 2\\\r\n\\\r\n3\nf 1 \\\n 2 1 # \\\nv 4 5 6\nf 1 1 \\";
        let mesh = parse(text.as_bytes()).unwrap();
        assert_eq!(mesh.positions, [[0.0; 3], [1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!(mesh.triangles, [[0, 1, 0]]);
        let many = format!("v 0 0 0 {}", "\\\n".repeat(300_000));
        assert_eq!(parse(many.as_bytes()).unwrap().positions.len(), 1);
    }

    #[test]
    fn a_vertex_without_color_among_colored_ones_is_white() {
        let mesh = parse(b"v 0 0 0\nv 1 0 0 0.5 0.25 0\nv 2 0 0\n").unwrap();
        let green = mesh.vertex_attributes.get("green").unwrap();
        let values: Vec<_> = (0..3).filter_map(|k| green.number(k)).collect();
        assert_eq!(values, [1.0, 0.25, 1.0]);
        assert_eq!(mesh.notes.len(), 1);
    }

    #[test]
    fn a_broken_statement_is_an_error_at_its_line() {
        let cases = [
            ("v 0 0\n", "line 1: z is missing"),
            ("\nv 0 a 0\n", "line 2: y cannot be \"a\""),
            ("v 0 0 0 0 0\n", "line 1: a vertex cannot have 5"),
            (
                "v 0 0 0\nf 1 1 0\n",
                "line 2: a face corner cannot be \"0\"",
            ),
            (
                "v 0 0 0\nf 1 1 -2\n",
                "line 2: a face corner cannot be \"-2\"",
            ),
            (
                "v 0 0 0\nf 1 1 2\nf 1 1 1\n",
                "line 2: a face has the vertex 2",
            ),
            ("v 0 0 0\nf 1 1 1.5\n", "line 2:"),
            ("v 0 0 0\nf 1 1 1/1/1/1\n", "line 2:"),
            ("v 0 0 0\nf 1 1 1/x\n", "line 2:"),
            ("v 0 0 0\nf 1 1 1//\n", "line 2:"),
            ("v 0 0 0\nf 1 1 99999999999\n", "line 2:"),
            ("solid x\n", "line 1: unknown statement \"solid\""),
            ("# nothing\n", "the file has no vertices"),
        ];
        for (text, start) in cases {
            let error = parse(text.as_bytes()).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Parse);
            assert!(error.message().starts_with(start), "{text:?} gives {error}");
        }
    }

    #[test]
    fn byte_colors_are_written_on_the_scale_to_one() {
        let mut mesh = MeshData::new(vec![[0.1, 1.0, -2e-9]], Vec::new());
        for (name, value) in [("red", 255), ("green", 51), ("blue", 0)] {
            let values = AttributeValues::Scalars(ScalarValues::U8(vec![value]));
            mesh.vertex_attributes.push(name, values).unwrap();
        }
        let mut text = Vec::new();
        write(&mesh, &mut text).unwrap();
        assert_eq!(text, b"v 0.1 1.0 -2e-9 1.0 0.2 0.0\n");
    }
}
