//! Reads and writes PLY, the polygon file format: any elements and properties, as text or binary.

mod body;
pub(super) mod details;
mod faces;
mod header;
mod number;
mod write;

pub(super) use write::{check, write};

use super::mesh_data::{MeshData, check_vertex_count};
use super::text::{Lines, parse_error};
use crate::error::{Error, Result};
use crate::mesh::attributes::{AttributeValues, Attributes, ListValues, ScalarType, ScalarValues};
use details::{CornerList, PlyDetails, PlyElement, PlyEncoding};
use header::{Element, Header};

/// Upper bound on the values of face attributes after polygons are cut into triangles, divided by the bytes of the
/// file. It protects against files that would need far more memory than they have bytes.
const REPEATED_VALUES_PER_BYTE: usize = 64;

const CORNER_LIST_NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The rows of an element.
struct Table<'a> {
    element: Element,
    columns: Vec<AttributeValues>,
    /// The file from the first row on.
    start: Lines<'a>,
}

pub(super) fn parse(bytes: &[u8]) -> Result<MeshData> {
    let Header {
        encoding,
        remarks,
        elements,
        mut body,
    } = header::parse(bytes)?;
    let mut details = PlyDetails {
        encoding,
        remarks,
        ..PlyDetails::default()
    };
    let mut notes = Vec::new();
    let mut tables = Vec::with_capacity(elements.len());
    for element in elements {
        let start = body.clone();
        let columns = body::read(&mut body, &element, encoding)?;
        tables.push(Table {
            element,
            columns,
            start,
        });
    }
    check_end(body, encoding, &mut notes)?;

    let mut take = |name: &str| {
        let k = tables.iter().position(|table| table.element.name == name)?;
        Some(tables.remove(k))
    };
    let vertices =
        take("vertex").ok_or_else(|| parse_error("the PLY header has no vertex element"))?;
    let faces = take("face");
    let strips = if faces.is_none() {
        take("tristrips")
    } else {
        None
    };
    let vertices = read_vertices(vertices, &mut details, &mut notes)?;
    let vertex_count = vertices.positions.len();
    let (triangles, face_attributes) = match (faces, strips) {
        (Some(faces), _) => {
            let budget = bytes.len().saturating_mul(REPEATED_VALUES_PER_BYTE);
            read_faces(faces, vertex_count, budget, &mut details, &mut notes)?
        }
        (None, Some(strips)) => {
            let triangles = read_strips(strips, vertex_count, &mut details)?;
            notes.push(format!(
                "triangle strips cut into {} triangles",
                triangles.len()
            ));
            let attributes = Attributes::new(triangles.len());
            (triangles, attributes)
        }
        (None, None) => (Vec::new(), Attributes::new(0)),
    };
    for Table {
        element, columns, ..
    } in tables
    {
        let mut rows = Attributes::new(element.count);
        for (property, values) in element.properties.into_iter().zip(columns) {
            rows.push(property.name, values)?;
        }
        details.elements.push(PlyElement {
            name: element.name,
            rows,
        });
    }
    Ok(MeshData {
        triangles,
        face_attributes,
        ply: details,
        notes,
        ..vertices
    })
}

/// Refuses text after the last row of a text file, because then a count is wrong. Binary files may be padded.
fn check_end(mut body: Lines, encoding: PlyEncoding, notes: &mut Vec<String>) -> Result<()> {
    let is_padding = body
        .rest()
        .iter()
        .all(|&b| b == 0 || b.is_ascii_whitespace());
    if is_padding {
        return Ok(());
    }
    if encoding == PlyEncoding::Ascii {
        body.next_filled(None);
        return Err(body.error("more rows than the header promises"));
    }
    notes.push(format!(
        "{} bytes after the last element ignored",
        body.rest().len()
    ));
    Ok(())
}

/// Takes the positions out of the vertex columns. All other fields of the result are empty.
fn read_vertices(
    table: Table,
    details: &mut PlyDetails,
    notes: &mut Vec<String>,
) -> Result<MeshData> {
    let mut coordinates: [Option<ScalarValues>; 3] = [None, None, None];
    let mut attributes = Attributes::new(table.element.count);
    for (property, values) in table.element.properties.into_iter().zip(table.columns) {
        match (
            ["x", "y", "z"]
                .iter()
                .position(|&name| name == property.name),
            values,
        ) {
            (Some(axis), AttributeValues::Scalars(values)) => {
                if axis == 0 {
                    details.vertex_attributes_before = attributes.columns().len();
                }
                coordinates[axis] = Some(values);
            }
            (_, values) => attributes.push(property.name, values)?,
        }
    }
    let [Some(x), Some(y), Some(z)] = coordinates else {
        return Err(parse_error(
            "the vertex element of the PLY header lacks x, y or z",
        ));
    };
    check_vertex_count(attributes.len())?;
    let types = [&x, &y, &z].map(ScalarValues::scalar_type);
    if types.iter().any(|t| t.is_integer()) {
        notes.push("whole-number coordinates are kept in double precision".to_owned());
    }
    let is_single = types.iter().all(|&t| t == ScalarType::F32);
    let [x, y, z] = [x, y, z].map(|values| values.to_f64_vec());
    let positions: Vec<_> = x
        .into_iter()
        .zip(y)
        .zip(z)
        .map(|((x, y), z)| [x, y, z])
        .collect();
    Ok(MeshData {
        vertex_attributes: attributes,
        position_type: if is_single {
            ScalarType::F32
        } else {
            ScalarType::F64
        },
        ..MeshData::new(positions, Vec::new())
    })
}

fn read_faces(
    table: Table,
    vertex_count: usize,
    budget: usize,
    details: &mut PlyDetails,
    notes: &mut Vec<String>,
) -> Result<(Vec<[u32; 3]>, Attributes)> {
    let Table {
        element,
        columns,
        start,
    } = table;
    let mut attributes = Attributes::new(element.count);
    let mut corners: Option<ListValues> = None;
    for (property, values) in element.properties.iter().zip(columns) {
        let known = CORNER_LIST_NAMES
            .into_iter()
            .find(|&name| name == property.name);
        match (known, values, &corners) {
            (Some(name), AttributeValues::Lists(lists), None) => {
                let (count_type, index_type) = (lists.count_type(), property.item_type);
                details.corner_list = CornerList {
                    name,
                    count_type,
                    index_type,
                };
                details.face_attributes_before = attributes.columns().len();
                corners = Some(lists);
            }
            (_, values, _) => attributes.push(property.name.clone(), values)?,
        }
    }
    let Some(corners) = corners else {
        if element.count == 0 {
            return Ok((Vec::new(), attributes));
        }
        return Err(parse_error(
            "the face element of the PLY header has no list vertex_indices",
        ));
    };
    check_index_type(&element, details.corner_list.index_type)?;
    let polygons = faces::polygons(&corners, vertex_count)
        .map_err(|bad| index_error(&bad, &start, &element, details.encoding, vertex_count))?;
    drop(corners);
    polygons.spread(&mut attributes, budget)?;
    notes.extend(polygons.notes());
    Ok((polygons.triangles, attributes))
}

fn read_strips(
    table: Table,
    vertex_count: usize,
    details: &mut PlyDetails,
) -> Result<Vec<[u32; 3]>> {
    let Table {
        element,
        columns,
        start,
    } = table;
    for (property, values) in element.properties.iter().zip(&columns) {
        if let AttributeValues::Lists(lists) = values
            && CORNER_LIST_NAMES.contains(&property.name.as_str())
        {
            check_index_type(&element, property.item_type)?;
            return faces::strips(lists, vertex_count).map_err(|bad| {
                index_error(&bad, &start, &element, details.encoding, vertex_count)
            });
        }
    }
    Err(parse_error(
        "the tristrips element of the PLY header has no list vertex_indices",
    ))
}

fn check_index_type(element: &Element, index_type: ScalarType) -> Result<()> {
    if index_type.is_integer() {
        return Ok(());
    }
    Err(parse_error(format!(
        "vertex_indices of {} needs an integer type",
        element.name
    )))
}

fn index_error(
    bad: &faces::BadIndex,
    start: &Lines,
    element: &Element,
    encoding: PlyEncoding,
    vertex_count: usize,
) -> Error {
    let (name, row, index) = (&element.name, bad.row, bad.index);
    parse_error(format!(
        "{}: {name} {row} has the vertex index {index}, but there are {vertex_count} vertices",
        body::place(start, element, encoding, row)
    ))
}

#[cfg(test)]
mod tests;
