//! Reads the rows of a PLY element into columns.
//!
//! If all rows of a binary element have the same layout, it is read column by column. This is the case if it has no
//! lists, or if the lists of a property have the same length in all rows, as for triangles. Any other element is read
//! row by row.

use super::super::text::{Lines, parse_error, parse_number, quoted, tokens};
use super::details::PlyEncoding;
use super::header::{Element, Property};
use super::number::{Encoded, decode_count};
use crate::error::Result;
use crate::mesh::attributes::{AttributeValues, ListValues, ScalarValues, with_scalars};

/// Reads the rows of `element` from `body`. Then `body` is at the byte after them.
pub(super) fn read(
    body: &mut Lines,
    element: &Element,
    encoding: PlyEncoding,
) -> Result<Vec<AttributeValues>> {
    check_count(body, element, encoding)?;
    if element.properties.is_empty() || element.count == 0 {
        return element
            .properties
            .iter()
            .map(|property| empty_column(property, 0))
            .collect();
    }
    if encoding == PlyEncoding::Ascii {
        return read_text(body, element);
    }
    let layout = row_layout(body.rest(), element, encoding)
        .ok_or_else(|| cut_off(element, 0, body.position()))?;
    if has_uniform_rows(body.rest(), element, &layout) {
        let columns = read_uniform(body.rest(), element, &layout, encoding);
        body.skip(layout.size * element.count);
        columns
    } else {
        read_rows(body, element, encoding)
    }
}

/// The place of row `row` of `element` for an error message. `start` is at its first row.
pub(super) fn place(start: &Lines, element: &Element, encoding: PlyEncoding, row: usize) -> String {
    let mut body = start.clone();
    if encoding == PlyEncoding::Ascii {
        for _ in 0..=row {
            body.next_filled(None);
        }
        return format!("line {}", body.number());
    }
    for _ in 0..row {
        body.skip(row_layout(body.rest(), element, encoding).map_or(0, |layout| layout.size));
    }
    format!("byte {}", body.position())
}

/// Refuses a number of rows for which the rest of the file is too short. It is called before any allocation.
fn check_count(body: &Lines, element: &Element, encoding: PlyEncoding) -> Result<()> {
    let least_row = element.properties.iter().map(|property| match encoding {
        // A digit, and a space or a line break.
        PlyEncoding::Ascii => 2,
        _ => property.least_size(),
    });
    // The last line of a text file may have no line break.
    let available = body.rest().len() + usize::from(encoding == PlyEncoding::Ascii);
    match least_row.sum::<usize>().checked_mul(element.count) {
        Some(least) if least <= available => Ok(()),
        _ => Err(parse_error(format!(
            "byte {}: the header promises {} rows of {}, too many for the {} bytes left",
            body.position(),
            element.count,
            element.name,
            body.rest().len()
        ))),
    }
}

fn empty_column(property: &Property, capacity: usize) -> Result<AttributeValues> {
    Ok(match property.count_type {
        None => AttributeValues::Scalars(ScalarValues::with_capacity(property.item_type, capacity)),
        Some(count_type) => {
            AttributeValues::Lists(ListValues::new(count_type, property.item_type)?)
        }
    })
}

fn cut_off(element: &Element, row: usize, position: usize) -> crate::error::Error {
    let name = &element.name;
    parse_error(format!(
        "byte {position}: the file ends within {name} {row} of {}",
        element.count
    ))
}

fn read_text(body: &mut Lines, element: &Element) -> Result<Vec<AttributeValues>> {
    let mut columns = element
        .properties
        .iter()
        .map(|property| empty_column(property, element.count))
        .collect::<Result<Vec<_>>>()?;
    for row in 0..element.count {
        let Some(line) = body.next_filled(None) else {
            let (name, count) = (&element.name, element.count);
            return Err(body.end_error(format!("{name} {row} of {count} is missing")));
        };
        let mut words = tokens(line);
        for (property, column) in element.properties.iter().zip(&mut columns) {
            match column {
                AttributeValues::Scalars(values) => {
                    push_text(body, property, words.next(), values)?;
                }
                AttributeValues::Lists(lists) => {
                    let count: u32 = body.number_from(&mut words, "the length of a list")?;
                    for _ in 0..count {
                        push_text(body, property, words.next(), lists.items_mut())?;
                    }
                    lists.close_list();
                }
            }
        }
        if words.next().is_some() {
            let (name, known) = (&element.name, element.properties.len());
            return Err(body.error(format!("{name} {row} has more than its {known} properties")));
        }
    }
    Ok(columns)
}

fn push_text(
    body: &Lines,
    property: &Property,
    word: Option<&[u8]>,
    values: &mut ScalarValues,
) -> Result<()> {
    let name = &property.name;
    let Some(word) = word else {
        return Err(body.error(format!("property {name} has too few values")));
    };
    let is_number = with_scalars!(values, v => parse_number(word).map(|number| v.push(number)));
    is_number.ok_or_else(|| {
        let wanted = super::header::type_name(property.item_type);
        body.error(format!(
            "property {name} ({wanted}) cannot be {}",
            quoted(word)
        ))
    })
}

/// The positions of the properties in a row.
struct RowLayout {
    /// For each property: the offset of its first item, and its number of items.
    slots: Vec<(usize, usize)>,
    size: usize,
}

/// The layout of the row at the start of `bytes`; `None` if `bytes` end before the row does.
fn row_layout(bytes: &[u8], element: &Element, encoding: PlyEncoding) -> Option<RowLayout> {
    let mut slots = Vec::with_capacity(element.properties.len());
    let mut size = 0usize;
    for property in &element.properties {
        let mut count = 1;
        if let Some(count_type) = property.count_type {
            let field = bytes.get(size..size.checked_add(count_type.size())?)?;
            count = decode_count(field, count_type, encoding)?;
            size += count_type.size();
        }
        slots.push((size, count));
        size = size.checked_add(count.checked_mul(property.item_type.size())?)?;
    }
    (size <= bytes.len()).then_some(RowLayout { slots, size })
}

/// Whether every row has the layout of the first one.
fn has_uniform_rows(bytes: &[u8], element: &Element, layout: &RowLayout) -> bool {
    let Some(total) = layout
        .size
        .checked_mul(element.count)
        .filter(|&n| n <= bytes.len())
    else {
        return false;
    };
    element
        .properties
        .iter()
        .zip(&layout.slots)
        .all(|(property, &(start, _))| {
            let Some(count_type) = property.count_type else {
                return true;
            };
            let field = start - count_type.size()..start;
            let expected = &bytes[field.clone()];
            bytes[..total]
                .chunks_exact(layout.size)
                .all(|row| &row[field.clone()] == expected)
        })
}

fn read_uniform(
    bytes: &[u8],
    element: &Element,
    layout: &RowLayout,
    encoding: PlyEncoding,
) -> Result<Vec<AttributeValues>> {
    let rows = &bytes[..layout.size * element.count];
    let mut columns = Vec::with_capacity(element.properties.len());
    for (property, &(start, count)) in element.properties.iter().zip(&layout.slots) {
        let total = count * element.count;
        let mut items = ScalarValues::with_capacity(property.item_type, total);
        let span = start..start + count * property.item_type.size();
        with_scalars!(&mut items, v => for row in rows.chunks_exact(layout.size) {
            extend_decoded(v, &row[span.clone()], encoding);
        });
        columns.push(match property.count_type {
            None => AttributeValues::Scalars(items),
            Some(count_type) => {
                let ends = (1..=element.count).map(|row| row * count).collect();
                AttributeValues::Lists(ListValues::from_parts(count_type, items, ends)?)
            }
        });
    }
    Ok(columns)
}

fn extend_decoded<T: Encoded>(values: &mut Vec<T>, bytes: &[u8], encoding: PlyEncoding) {
    values.extend(
        bytes
            .chunks_exact(T::SIZE)
            .map(|item| T::decode(item, encoding)),
    );
}

fn read_rows(
    body: &mut Lines,
    element: &Element,
    encoding: PlyEncoding,
) -> Result<Vec<AttributeValues>> {
    let mut columns = element
        .properties
        .iter()
        .map(|property| empty_column(property, element.count))
        .collect::<Result<Vec<_>>>()?;
    for row in 0..element.count {
        let bytes = body.rest();
        let mut size = 0;
        for (property, column) in element.properties.iter().zip(&mut columns) {
            let take = |from: usize, length: usize| {
                from.checked_add(length)
                    .and_then(|end| bytes.get(from..end))
                    .ok_or_else(|| cut_off(element, row, body.position()))
            };
            let item_size = property.item_type.size();
            match column {
                AttributeValues::Scalars(values) => {
                    let field = take(size, item_size)?;
                    with_scalars!(values, v => extend_decoded(v, field, encoding));
                    size += item_size;
                }
                AttributeValues::Lists(lists) => {
                    let count_type = lists.count_type();
                    let field = take(size, count_type.size())?;
                    size += count_type.size();
                    let Some(count) = decode_count(field, count_type, encoding) else {
                        let (name, at) = (&property.name, body.position());
                        return Err(parse_error(format!(
                            "byte {at}: list {name} of {} {row} has a negative length",
                            element.name
                        )));
                    };
                    let length = count.saturating_mul(item_size);
                    let field = take(size, length)?;
                    with_scalars!(lists.items_mut(), v => extend_decoded(v, field, encoding));
                    size += length;
                    lists.close_list();
                }
            }
        }
        body.skip(size);
    }
    Ok(columns)
}
