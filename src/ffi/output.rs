//! What is written to the caller's memory, which may be aligned or not.

use super::failure::{Failure, not_found, not_null};
use super::objects::{Object, keep};
use super::rows::{INDEX_TYPES, POINT_TYPES, Rows};
use super::status::{HOLEFILL_STATUS_BUFFER_TOO_SMALL, HOLEFILL_STATUS_LIMIT};
use super::types::*;
use std::ops::Range;

/// Writes a value.
///
/// # Safety
/// `place` is null or points to a `T`.
pub(super) unsafe fn write<T>(place: *mut T, value: T, what: &str) -> Result<(), Failure> {
    not_null(place.cast_const(), what)?;
    // SAFETY: not null, and the caller's promise.
    unsafe { place.write_unaligned(value) };
    Ok(())
}

/// Keeps an object and writes its handle.
///
/// # Safety
/// `place` is null or points to a handle.
pub(super) unsafe fn hand_out<H>(
    object: impl Into<Object>,
    place: *mut H,
    what: &str,
) -> Result<(), Failure> {
    const { assert!(size_of::<H>() == size_of::<u64>()) };
    not_null(place.cast_const(), what)?;
    let id = keep(object.into())?;
    // SAFETY: not null, and the caller's promise; a handle is a number and nothing else.
    unsafe { write(place.cast::<u64>(), id, what) }
}

/// Writes a list that is followed by `end`, and the length of the list alone: that also when both do not fit.
///
/// # Safety
/// `buffer` is null or points to `capacity` elements, `length` is null or points to a number.
pub(super) unsafe fn write_list<T: Copy>(
    list: &[T],
    end: &[T],
    (buffer, capacity, buffer_name): (*mut T, u64, &str),
    (length, length_name): (*mut u64, &str),
) -> Result<(), Failure> {
    not_null(length.cast_const(), length_name)?;
    if capacity > 0 {
        not_null(buffer.cast_const(), buffer_name)?;
    }
    // SAFETY: not null, and the caller's promise.
    unsafe { write(length, list.len() as u64, length_name)? };
    if buffer.is_null() {
        return Ok(());
    }
    let needed = list.len() + end.len();
    if capacity < needed as u64 {
        return Err(Failure::new(
            HOLEFILL_STATUS_BUFFER_TOO_SMALL,
            format!("{buffer_name} has room for {capacity}, but {needed} are needed"),
        ));
    }
    for (i, &value) in list.iter().chain(end).enumerate() {
        // SAFETY: the buffer has room for them all.
        unsafe { buffer.add(i).write_unaligned(value) };
    }
    Ok(())
}

/// The caller's memory for the rows `range` of something.
pub(super) struct Sink {
    rows: Rows,
    /// The rows that are asked for.
    pub(super) range: Range<usize>,
}

impl Sink {
    /// Checks where to write: rows of `width` numbers of one of the types `allowed`, from row `first` on, of which there
    /// are `total`.
    ///
    /// # Safety
    /// `output` is null or describes memory of the caller.
    pub(super) unsafe fn check(
        output: *const HolefillOutput,
        first: u64,
        total: usize,
        (width, allowed): (usize, &[HolefillType]),
    ) -> Result<Self, Failure> {
        not_null(output, "output")?;
        // SAFETY: not null, and the caller's promise.
        let view = unsafe { output.read_unaligned() };
        let as_input = HolefillInput {
            data: view.data.cast_const(),
            count: view.count,
            stride: view.stride,
            scalar_type: view.scalar_type,
            reserved: view.reserved,
        };
        let rows = Rows::check(as_input, width, allowed, "output")?;
        let end = first.checked_add(view.count);
        if end.is_none_or(|end| end > total as u64) {
            let count = view.count;
            return Err(not_found(format!(
                "there are {total} rows, not {count} from row {first} on"
            )));
        }
        let first = first as usize;
        Ok(Self {
            range: first..first + rows.count,
            rows,
        })
    }

    /// Writes number `k` of the `i`-th row as it is; it must have the type of the rows.
    pub(super) fn put<T: Copy>(&self, i: usize, k: usize, value: T) {
        debug_assert_eq!(size_of::<T>(), self.rows.scalar_size);
        debug_assert!(i < self.rows.count);
        if size_of::<T>() != self.rows.scalar_size || i >= self.rows.count {
            return;
        }
        // SAFETY: the rows were checked, and the number is as wide as theirs.
        unsafe { self.rows.at::<T>(i, k).write_unaligned(value) };
    }

    /// Whether rows are wanted as this type.
    pub(super) fn is_of(&self, scalar_type: HolefillType) -> bool {
        self.rows.scalar_type == scalar_type
    }
}

/// Writes the points from `first` on, as many as the caller wants, as `float` or `double`.
///
/// # Safety
/// As [`Sink::check`].
pub(super) unsafe fn write_points(
    output: *const HolefillOutput,
    first: u64,
    points: &[[f64; 3]],
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    let sink = unsafe { Sink::check(output, first, points.len(), (3, POINT_TYPES))? };
    for (i, point) in points[sink.range.clone()].iter().enumerate() {
        for (k, &value) in point.iter().enumerate() {
            match sink.is_of(HOLEFILL_TYPE_F32) {
                true => sink.put(i, k, value as f32),
                false => sink.put(i, k, value),
            }
        }
    }
    Ok(())
}

/// Writes the rows of indices from `first` on, as many as the caller wants, with 32 or 64 bits.
///
/// # Safety
/// As [`Sink::check`].
pub(super) unsafe fn write_indices<const N: usize>(
    output: *const HolefillOutput,
    first: u64,
    rows: &[[u32; N]],
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    let sink = unsafe { Sink::check(output, first, rows.len(), (N, INDEX_TYPES))? };
    let rows = &rows[sink.range.clone()];
    let largest = rows.as_flattened().iter().copied().max().unwrap_or(0);
    if sink.is_of(HOLEFILL_TYPE_I32) && largest > i32::MAX as u32 {
        let message = format!("int32_t has no room for the index {largest}");
        return Err(Failure::new(HOLEFILL_STATUS_LIMIT, message));
    }
    let has_32_bits = sink.is_of(HOLEFILL_TYPE_I32) || sink.is_of(HOLEFILL_TYPE_U32);
    for (i, row) in rows.iter().enumerate() {
        for (k, &value) in row.iter().enumerate() {
            // Numbers that are not negative have the same bits with and without a sign.
            match has_32_bits {
                true => sink.put(i, k, value),
                false => sink.put(i, k, u64::from(value)),
            }
        }
    }
    Ok(())
}
