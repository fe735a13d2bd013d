//! Attributes of vertices and triangles, in and out.
//!
//! A mesh has columns of single numbers. An attribute of several components is several columns. Their names are those
//! by which the pipeline knows colors and normals.

use super::failure::{Failure, invalid, nth};
use super::guard::{guard, guard_with};
use super::input::{copy_column, rows};
use super::objects::{MeshObject, NamedColumns, with_mesh_mut};
use super::output::{Sink, write};
use super::rows::{ATTRIBUTE_TYPES, Rows};
use super::status::HolefillStatus;
use super::structs::write_struct;
use super::text::{read_text, write_text};
use super::types::*;
use crate::mesh::attributes::{
    AttributeValues, Attributes, ScalarType, ScalarValues, with_scalars,
};
use std::ffi::c_char;

/// Most components of an attribute.
const MOST_COMPONENTS: u32 = 1024;

/// The names of the columns of an attribute.
fn column_names(name: &str, components: u32) -> Vec<String> {
    let known: &[&str] = match (name, components) {
        ("normal", 3) => &["nx", "ny", "nz"],
        ("color", 3) => &["red", "green", "blue"],
        ("color", 4) => &["red", "green", "blue", "alpha"],
        (_, 1) => &[name],
        _ => &[],
    };
    if known.is_empty() {
        return (0..components).map(|k| format!("{name}[{k}]")).collect();
    }
    known.iter().map(|&n| n.to_owned()).collect()
}

fn place(element: HolefillElement) -> Result<usize, Failure> {
    match element {
        HOLEFILL_ELEMENT_VERTEX => Ok(0),
        HOLEFILL_ELEMENT_TRIANGLE => Ok(1),
        _ => Err(invalid(format!("there is no element {element}"))),
    }
}

fn find(
    object: &MeshObject,
    element: HolefillElement,
    index: u64,
) -> Result<(&NamedColumns, &Attributes), Failure> {
    let place = place(element)?;
    let named = nth(&object.attributes[place], index, "attribute")?;
    let mesh = object.session.mesh();
    let attributes = [mesh.vertex_attributes(), mesh.face_attributes()][place];
    Ok((named, attributes))
}

/// The types of attributes, here and in the mesh.
macro_rules! scalar_types {
    ($($number:ident $variant:ident)*) => {
        fn column(rows: &Rows, k: usize, what: &str) -> Result<ScalarValues, Failure> {
            match rows.scalar_type {
                $($number => Ok(ScalarValues::$variant(copy_column(rows, k, what)?)),)*
                other => Err(invalid(format!("{what} cannot have the type {other}"))),
            }
        }

        fn type_number(scalar_type: ScalarType) -> HolefillType {
            match scalar_type {
                $(ScalarType::$variant => $number,)*
            }
        }
    };
}
scalar_types! {
    HOLEFILL_TYPE_I8 I8
    HOLEFILL_TYPE_U8 U8
    HOLEFILL_TYPE_I16 I16
    HOLEFILL_TYPE_U16 U16
    HOLEFILL_TYPE_I32 I32
    HOLEFILL_TYPE_U32 U32
    HOLEFILL_TYPE_F32 F32
    HOLEFILL_TYPE_F64 F64
}

/// An attribute that was copied from the caller, and its columns by name.
pub(super) type Copied = (NamedColumns, Vec<(String, AttributeValues)>);

/// Copies the rows of `values`, of which there must be `count`.
///
/// # Safety
/// `values` is null or describes memory of the caller.
pub(super) unsafe fn copy_attribute(
    name: &str,
    components: u32,
    values: *const HolefillInput,
    count: usize,
    what: &str,
) -> Result<Copied, Failure> {
    // SAFETY: the caller's promise.
    let given = unsafe { rows(values, components as usize, ATTRIBUTE_TYPES, what)? };
    let rows = given.count;
    if rows != count {
        return Err(invalid(format!(
            "attribute {name} has {rows} rows for {count} elements"
        )));
    }
    let names = column_names(name, components);
    let mut columns = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let values = AttributeValues::Scalars(column(&given, k, what)?);
        columns.push((name.clone(), values));
    }
    let named = NamedColumns {
        name: name.to_owned(),
        scalar_type: given.scalar_type,
        columns: names,
    };
    Ok((named, columns))
}

/// Adds an attribute to the vertices or the triangles of a mesh, and copies its values.
///
/// `name` is UTF-8 and unique among those of the element. `values` has a row of `components` numbers for each vertex or
/// triangle, those of patches included, of any type of at most 32 bits or `double`.
///
/// A fill gives values to new vertices and triangles: floating-point numbers, and whatever is called `color`, are
/// extended smoothly from the rim; three floating-point numbers called `normal` become the normals of the patch; all
/// else is copied from the nearest vertex of the rim, or triangle beside it. Plans that were made before cannot be
/// applied any more.
///
/// Statuses: `INVALID_ARGUMENT` for an unknown element, a name that exists or is empty, no component or more than 1024, or
/// another number of rows; `BUSY`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_add_attribute(
    mesh: HolefillMesh,
    element: HolefillElement,
    name: *const c_char,
    components: u32,
    values: *const HolefillInput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        let place = place(element)?;
        // SAFETY: the caller's promise.
        let name = unsafe { read_text(name, "name")? };
        if name.is_empty() || components == 0 || components > MOST_COMPONENTS {
            return Err(invalid(format!(
                "an attribute needs a name and 1 to {MOST_COMPONENTS} components"
            )));
        }
        with_mesh_mut(mesh, |object| {
            let mesh = object.session.mesh();
            let known = [mesh.vertex_attributes(), mesh.face_attributes()][place];
            let names = column_names(name, components);
            if names.iter().any(|n| known.get(n).is_some()) {
                return Err(invalid(format!("there is an attribute {name} already")));
            }
            // All is copied before anything is added: then nothing can fail.
            // SAFETY: the caller's promise.
            let copied =
                unsafe { copy_attribute(name, components, values, known.len(), "values")? };
            let (named, columns) = copied;
            for (name, values) in columns {
                match place {
                    0 => object.session.add_vertex_attribute(&name, values)?,
                    _ => object.session.add_face_attribute(&name, values)?,
                }
            }
            object.attributes[place].push(named);
            Ok(())
        })
    })
}

/// Number of attributes of the vertices or the triangles.
///
/// Statuses: `INVALID_ARGUMENT` for an unknown element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_attribute_count(
    mesh: HolefillMesh,
    element: HolefillElement,
    count: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        let found = object.attributes[place(element)?].len();
        // SAFETY: the caller's promise.
        unsafe { write(count, found as u64, "count") }
    })
}

/// Type and size of attribute `index`, in the order in which they were added.
///
/// Statuses: `NOT_FOUND`; `INVALID_ARGUMENT` for an unknown element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_attribute_info(
    mesh: HolefillMesh,
    element: HolefillElement,
    index: u64,
    info: *mut HolefillAttributeInfo,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        let (named, attributes) = find(object, element, index)?;
        let value = HolefillAttributeInfo {
            scalar_type: named.scalar_type,
            components: named.columns.len() as u32,
            count: attributes.len() as u64,
            ..Default::default()
        };
        // SAFETY: the caller's promise.
        unsafe { write_struct(info, &value, "info") }
    })
}

/// The name of attribute `index`; `buffer`, `capacity` and `length` as in `holefill_error_message`.
///
/// Statuses: `NOT_FOUND`; `INVALID_ARGUMENT` for an unknown element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_attribute_name(
    mesh: HolefillMesh,
    element: HolefillElement,
    index: u64,
    buffer: *mut c_char,
    capacity: u64,
    length: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        let (named, _) = find(object, element, index)?;
        // SAFETY: the caller's promise.
        unsafe { write_text(&named.name, buffer, capacity, length) }
    })
}

/// Copies values of attribute `index` from row `first` on: `output` has rows of as many numbers as the attribute has
/// components, of its type or `double`, as many as are wanted.
///
/// Statuses: `NOT_FOUND`; `INVALID_ARGUMENT` for an unknown element or another type.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_read_attribute(
    mesh: HolefillMesh,
    element: HolefillElement,
    index: u64,
    first: u64,
    output: *const HolefillOutput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        let (named, attributes) = find(object, element, index)?;
        let (own, width) = (named.scalar_type, named.columns.len());
        // SAFETY: the caller's promise.
        let sink =
            unsafe { Sink::check(output, first, attributes.len(), (width, ATTRIBUTE_TYPES))? };
        if !sink.is_of(own) && !sink.is_of(HOLEFILL_TYPE_F64) {
            return Err(invalid(format!(
                "the attribute can be read as type {own} or {HOLEFILL_TYPE_F64}"
            )));
        }
        for (k, name) in named.columns.iter().enumerate() {
            if let Some(AttributeValues::Scalars(values)) = attributes.get(name) {
                write_column(&sink, k, values);
            }
        }
        Ok(())
    })
}

fn write_column(sink: &Sink, k: usize, values: &ScalarValues) {
    if sink.is_of(type_number(values.scalar_type())) {
        with_scalars!(values, v => {
            for (i, &value) in v[sink.range.clone()].iter().enumerate() {
                sink.put(i, k, value);
            }
        });
        return;
    }
    for (i, row) in sink.range.clone().enumerate() {
        sink.put(i, k, values.get(row).unwrap_or(0.0));
    }
}
