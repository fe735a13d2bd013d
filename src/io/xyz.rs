//! Reads XYZ: points as text, one on a line, without a header.
//!
//! Three numbers are a position. Six numbers are a position and a normal, or a position and a color. Nine numbers are
//! position, normal and color, or position, color and normal. Three columns are colors if all their numbers are
//! integers from 0 to 255 and one of them is above 1. Numbers are separated by white space, commas or semicolons.
//! Blank lines and text after a `#` are ignored.

use super::mesh_data::{MeshData, check_vertex_count};
use super::text::{Lines, parse_error, parse_number, quoted};
use crate::error::Result;
use crate::mesh::attributes::{AttributeValues, ScalarType, ScalarValues};

const COMMENT: Option<u8> = Some(b'#');
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];
const COLOR: [&str; 3] = ["red", "green", "blue"];
/// The allowed numbers of columns.
const COLUMN_COUNTS: [usize; 3] = [3, 6, 9];
/// Upper bound on the columns.
const MOST_COLUMNS: usize = 9;

pub(super) fn parse(bytes: &[u8]) -> Result<MeshData> {
    let mut lines = Lines::new(bytes);
    let mut positions = Vec::new();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    while let Some(line) = lines.next_filled(COMMENT) {
        let mut values = [0.0; MOST_COLUMNS];
        let mut count = 0;
        for token in tokens(line) {
            let Some(value) = values.get_mut(count) else {
                return Err(lines.error(format!("more than {MOST_COLUMNS} numbers")));
            };
            *value = parse_number(token)
                .ok_or_else(|| lines.error(format!("{} is no number", quoted(token))))?;
            count += 1;
        }
        if positions.is_empty() {
            if !COLUMN_COUNTS.contains(&count) {
                return Err(lines.error(format!(
                    "a point has 3, 6 or 9 numbers (position, normal, color), not {count}"
                )));
            }
            columns = vec![Vec::new(); count - 3];
        } else if count != columns.len() + 3 {
            return Err(lines.error(format!(
                "{count} numbers, but the first point has {}",
                columns.len() + 3
            )));
        }
        positions.push([values[0], values[1], values[2]]);
        for (column, value) in columns.iter_mut().zip(&values[3..]) {
            column.push(*value);
        }
    }
    if positions.is_empty() {
        return Err(parse_error("there are no points"));
    }
    check_vertex_count(positions.len())?;
    let mut mesh = MeshData::new(positions, Vec::new());
    let mut has_color = false;
    for group in columns.chunks(3) {
        let is_color = !has_color && are_colors(group);
        has_color |= is_color;
        let (names, scalar_type) = if is_color {
            (COLOR, ScalarType::U8)
        } else {
            (NORMAL, ScalarType::F64)
        };
        for (name, column) in names.iter().zip(group) {
            let mut values = ScalarValues::new(scalar_type);
            column.iter().for_each(|&value| values.push(value));
            let values = AttributeValues::Scalars(values);
            mesh.vertex_attributes.push(*name, values).map_err(|_| {
                parse_error("of the numbers after the positions, neither three are whole numbers from 0 to 255")
            })?;
        }
    }
    Ok(mesh)
}

/// Whether three columns are colors in bytes. Otherwise they are normals.
fn are_colors(columns: &[Vec<f64>]) -> bool {
    let values = || columns.iter().flatten();
    let is_byte = |&&value: &&f64| (0.0..=255.0).contains(&value) && value.fract() == 0.0;
    values().all(|value| is_byte(&value)) && values().any(|&value| value > 1.0)
}

fn tokens(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|b| b.is_ascii_whitespace() || matches!(b, b',' | b';'))
        .filter(|token| !token.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    fn names(mesh: &MeshData) -> Vec<&str> {
        let columns = mesh.vertex_attributes.iter();
        columns.map(|column| column.name.as_str()).collect()
    }

    #[test]
    fn three_columns_are_positions_in_any_usual_layout() {
        for text in [
            "0 1 2\n3 4 5\n",
            "# two points\n\n0,1,2\r\n3;4;5",
            "\t0\t1\t2 # first\n  3e0 4. 5.0\n",
        ] {
            let mesh = parse(text.as_bytes()).unwrap();
            assert_eq!(
                mesh.positions,
                [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]],
                "{text:?}"
            );
            assert!(mesh.vertex_attributes.columns().is_empty());
            assert!(mesh.triangles.is_empty());
        }
    }

    #[test]
    fn normals_and_colors_are_told_apart_in_either_order() {
        let normal = ["nx", "ny", "nz"];
        let color = ["red", "green", "blue"];
        for (text, expected) in [
            ("0 0 0 0 0 1\n", normal.to_vec()),
            ("0 0 0 0 0 255\n", color.to_vec()),
            ("0 0 0 0.5 0.5 2\n", normal.to_vec()),
            ("0 0 0 -1 0 0 9 9 9\n", [normal, color].concat()),
            ("0 0 0 9 9 9 -1 0 0\n", [color, normal].concat()),
        ] {
            let mesh = parse(text.as_bytes()).unwrap();
            assert_eq!(names(&mesh), expected, "{text:?}");
        }
        let mesh = parse(b"0 0 0 9 8 7 -1 0 0\n").unwrap();
        let red = mesh.vertex_attributes.get("red").unwrap();
        assert_eq!(
            (red.scalar_type(), red.number(0)),
            (ScalarType::U8, Some(9.0))
        );
        let nx = mesh.vertex_attributes.get("nx").unwrap();
        assert_eq!(
            (nx.scalar_type(), nx.number(0)),
            (ScalarType::F64, Some(-1.0))
        );
    }

    #[test]
    fn errors_name_the_line() {
        for (text, expected) in [
            ("", "there are no points"),
            ("# nothing\n", "there are no points"),
            ("0 0\n", "line 1: a point has 3, 6 or 9 numbers"),
            ("0 0 0 1\n", "line 1: a point has 3, 6 or 9 numbers"),
            ("\n0 0 0\n0 0 x\n", "line 3: \"x\" is no number"),
            (
                "0 0 0\n\n0 0 0 0 0 1\n",
                "line 3: 6 numbers, but the first point has 3",
            ),
            ("1 2 3 4 5 6 7 8 9 10\n", "line 1: more than 9 numbers"),
            ("0 0 0 1 0 0 1 0 0\n", "of the numbers after the positions"),
        ] {
            let error = parse(text.as_bytes()).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Parse);
            assert!(error.message().starts_with(expected), "{text:?}: {error}");
        }
    }
}
