//! Rows of numbers that are copied from the caller's memory, which may be aligned or not.

use super::failure::{Failure, invalid, not_null};
use super::rows::{INDEX_TYPES, POINT_TYPES, Rows};
use super::status::{
    HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, HOLEFILL_STATUS_NOT_FINITE, HOLEFILL_STATUS_OUT_OF_MEMORY,
};
use super::types::*;
use rayon::prelude::*;

/// Checks rows that may be null.
///
/// # Safety
/// `input` is null or points to a `HolefillInput`.
pub(super) unsafe fn rows(
    input: *const HolefillInput,
    width: usize,
    allowed: &[HolefillType],
    what: &str,
) -> Result<Rows, Failure> {
    not_null(input, what)?;
    // SAFETY: not null, and the caller's promise.
    Rows::check(unsafe { input.read_unaligned() }, width, allowed, what)
}

fn room<T>(count: usize, what: &str) -> Result<Vec<T>, Failure> {
    let mut values = Vec::new();
    match values.try_reserve_exact(count) {
        Ok(()) => Ok(values),
        Err(_) => Err(Failure::new(
            HOLEFILL_STATUS_OUT_OF_MEMORY,
            format!("there is no memory for the {count} rows of {what}"),
        )),
    }
}

/// Rows that one task copies: some hundred kilobytes, so that starting it costs nothing.
const COPIED_ROWS: usize = 1 << 14;

/// Fills an empty vector, which has room for them, with copies of rows without gaps. Several threads share the work:
/// most of it is that memory is used for the first time.
///
/// # Safety
/// Rows are as long as a `T`, and any bits are a `T`.
unsafe fn copy_rows<T: Copy + Send>(rows: &Rows, values: &mut Vec<T>) {
    if rows.count == 0 {
        return;
    }
    let chunk = COPIED_ROWS * size_of::<T>();
    // SAFETY: the rows were checked and have no gaps; bytes need no alignment, and nobody writes to them during the call.
    let bytes = unsafe { std::slice::from_raw_parts(rows.data, rows.count * rows.stride) };
    let room = values.spare_capacity_mut()[..rows.count].par_chunks_mut(COPIED_ROWS);
    room.zip(bytes.par_chunks(chunk)).for_each(|(room, bytes)| {
        // SAFETY: both are of the same rows.
        unsafe {
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), room.as_mut_ptr().cast(), bytes.len())
        };
    });
    // SAFETY: all of them were written just now.
    unsafe { values.set_len(rows.count) };
}

/// Copies rows of three coordinates.
///
/// # Safety
/// `input` is null or describes memory of the caller.
pub(super) unsafe fn read_points(
    input: *const HolefillInput,
    what: &str,
) -> Result<Vec<[f64; 3]>, Failure> {
    // SAFETY: the caller's promise.
    let rows = unsafe { rows(input, 3, POINT_TYPES, what)? };
    let mut points: Vec<[f64; 3]> = room(rows.count, what)?;
    if rows.scalar_type == HOLEFILL_TYPE_F64 && rows.stride == size_of::<[f64; 3]>() {
        // SAFETY: the rows are as long as points, and any bits are numbers.
        unsafe { copy_rows(&rows, &mut points) };
        return Ok(points);
    }
    // SAFETY: `i` is below the count and `k` below 3; any bits are numbers.
    let number = |i: usize, k: usize| unsafe {
        match rows.scalar_type {
            HOLEFILL_TYPE_F32 => f64::from(rows.at::<f32>(i, k).read_unaligned()),
            _ => rows.at::<f64>(i, k).read_unaligned(),
        }
    };
    points.extend((0..rows.count).map(|i| [0, 1, 2].map(|k| number(i, k))));
    Ok(points)
}

/// Refuses points that are not finite.
pub(super) fn check_finite(points: &[[f64; 3]], what: &str) -> Result<(), Failure> {
    match points.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        Some(i) => Err(Failure::new(
            HOLEFILL_STATUS_NOT_FINITE,
            format!("row {i} of {what} is not finite"),
        )),
        None => Ok(()),
    }
}

/// Copies points that must be finite.
///
/// # Safety
/// As [`read_points`].
pub(super) unsafe fn read_finite(
    input: *const HolefillInput,
    what: &str,
) -> Result<Vec<[f64; 3]>, Failure> {
    // SAFETY: the caller's promise.
    let points = unsafe { read_points(input, what)? };
    check_finite(&points, what)?;
    Ok(points)
}

/// As [`read_finite`]; nothing for a null pointer.
///
/// # Safety
/// As [`read_points`].
pub(super) unsafe fn read_optional(
    input: *const HolefillInput,
    what: &str,
) -> Result<Option<Vec<[f64; 3]>>, Failure> {
    if input.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    unsafe { read_finite(input, what) }.map(Some)
}

/// Copies rows of `N` indices.
///
/// # Errors
/// `HOLEFILL_STATUS_INVALID_ARGUMENT` for a negative index, `HOLEFILL_STATUS_INDEX_OUT_OF_RANGE` for one beyond 32 bits.
///
/// # Safety
/// As [`read_points`].
pub(super) unsafe fn read_indices<const N: usize>(
    input: *const HolefillInput,
    what: &str,
) -> Result<Vec<[u32; N]>, Failure> {
    // SAFETY: the caller's promise.
    let rows = unsafe { rows(input, N, INDEX_TYPES, what)? };
    let mut values: Vec<[u32; N]> = room(rows.count, what)?;
    let has_32_bits = [HOLEFILL_TYPE_I32, HOLEFILL_TYPE_U32].contains(&rows.scalar_type);
    if has_32_bits && rows.stride == size_of::<[u32; N]>() {
        // SAFETY: the rows are as long as those of indices, and any bits are numbers.
        unsafe { copy_rows(&rows, &mut values) };
        if rows.scalar_type == HOLEFILL_TYPE_I32 {
            let is_negative = |row: &[u32; N]| row.iter().any(|&v| v > i32::MAX as u32);
            if let Some(i) = values.iter().position(is_negative) {
                let found = values[i].iter().map(|&v| v.cast_signed()).find(|v| *v < 0);
                return Err(negative(i, found.unwrap_or_default().into(), what));
            }
        }
        return Ok(values);
    }
    for i in 0..rows.count {
        let mut row = [0; N];
        for (k, place) in row.iter_mut().enumerate() {
            // SAFETY: `i` is below the count and `k` below the width; any bits are numbers.
            let index = unsafe {
                match rows.scalar_type {
                    HOLEFILL_TYPE_I32 => i128::from(rows.at::<i32>(i, k).read_unaligned()),
                    HOLEFILL_TYPE_U32 => i128::from(rows.at::<u32>(i, k).read_unaligned()),
                    HOLEFILL_TYPE_I64 => i128::from(rows.at::<i64>(i, k).read_unaligned()),
                    _ => i128::from(rows.at::<u64>(i, k).read_unaligned()),
                }
            };
            if index < 0 {
                return Err(negative(i, index, what));
            }
            *place = u32::try_from(index).map_err(|_| {
                let message = format!("row {i} of {what} has the index {index}");
                Failure::new(HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, message)
            })?;
        }
        values.push(row);
    }
    Ok(values)
}

fn negative(row: usize, index: i128, what: &str) -> Failure {
    invalid(format!(
        "row {row} of {what} has the negative index {index}"
    ))
}

/// Copies rows of `N` indices that may be none at all: all zero.
///
/// # Safety
/// What `view` says is the caller's memory.
pub(super) unsafe fn read_optional_indices<const N: usize>(
    view: &HolefillInput,
    what: &str,
) -> Result<Vec<[u32; N]>, Failure> {
    if view.count == 0 && view.data.is_null() {
        return Ok(Vec::new());
    }
    // SAFETY: a reference is not null, and the caller's promise.
    unsafe { read_indices(view, what) }
}

/// Numbers that can be copied from the caller's memory: any bits are a value.
pub(super) trait Plain: Copy {}
macro_rules! plain {
    ($($number:ty)*) => { $(impl Plain for $number {})* };
}
plain!(i8 u8 i16 u16 i32 u32 f32 f64);

/// Column `k` of rows, which must exist, as numbers of the type that the rows have.
pub(super) fn copy_column<T: Plain>(rows: &Rows, k: usize, what: &str) -> Result<Vec<T>, Failure> {
    let mut values = room(rows.count, what)?;
    debug_assert_eq!(size_of::<T>(), rows.scalar_size);
    // SAFETY: the rows were checked, and any bits are a `T`.
    let number = |i| unsafe { rows.at::<T>(i, k).read_unaligned() };
    values.extend((0..rows.count).map(number));
    Ok(values)
}
