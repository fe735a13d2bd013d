//! Memory of the caller: checked before it is read or written, and taken to be aligned nowhere.

use super::guard::Failure;
use super::status::{
    HOLEFILL_STATUS_BUFFER_TOO_SMALL, HOLEFILL_STATUS_INDEX_OUT_OF_RANGE,
    HOLEFILL_STATUS_INVALID_ARGUMENT, HOLEFILL_STATUS_INVALID_STRUCT, HOLEFILL_STATUS_NOT_FOUND,
    HOLEFILL_STATUS_NULL_POINTER, HOLEFILL_STATUS_OUT_OF_MEMORY, HOLEFILL_STATUS_OVERFLOW,
};
use super::types::{
    HOLEFILL_TYPE_F32, HOLEFILL_TYPE_F64, HOLEFILL_TYPE_I8, HOLEFILL_TYPE_I16, HOLEFILL_TYPE_I32,
    HOLEFILL_TYPE_U8, HOLEFILL_TYPE_U16, HOLEFILL_TYPE_U32, HOLEFILL_TYPE_U64, HolefillInput,
    HolefillOutput, HolefillType,
};
use rayon::prelude::*;
use std::ffi::{CStr, c_char};
use std::mem::{MaybeUninit, offset_of};
use std::ops::Range;

/// A struct of the caller that begins with its size and version.
///
/// # Safety
/// The type is `repr(C)`, begins with `struct_size: u32` and `version: u32`, and all zero bytes are a value of it.
pub(super) unsafe trait CStruct: Copy {
    const VERSION: u32;
}

/// No struct that begins with its size is larger than this; a greater size is an uninitialised one.
const LARGEST_STRUCT: usize = 4096;
/// Size of the two fields that every such struct begins with.
const HEAD: usize = 8;

pub(super) fn null(what: &str) -> Failure {
    Failure::new(HOLEFILL_STATUS_NULL_POINTER, format!("{what} is null"))
}

pub(super) fn invalid(message: impl Into<String>) -> Failure {
    Failure::new(HOLEFILL_STATUS_INVALID_ARGUMENT, message)
}

/// The size that the caller's struct has, after the checks of its first two fields.
///
/// # Safety
/// `data` is not null and points to two `u32`.
unsafe fn checked_size<T: CStruct>(data: *const T, what: &str) -> Result<usize, Failure> {
    let fields: *const u32 = data.cast();
    // SAFETY: the caller's promise.
    let (size, version) = unsafe {
        let version = fields.add(1);
        (fields.read_unaligned() as usize, version.read_unaligned())
    };
    let refuse = |message: String| Err(Failure::new(HOLEFILL_STATUS_INVALID_STRUCT, message));
    if version != T::VERSION {
        return refuse(format!(
            "{what} has version {version}, this library knows {}",
            T::VERSION
        ));
    }
    if size < size_of::<T>() || size > LARGEST_STRUCT {
        return refuse(format!(
            "{what} has the size {size}, which is not {} or somewhat more",
            size_of::<T>()
        ));
    }
    Ok(size)
}

/// Copies a struct of the caller; `None` when the pointer is null.
///
/// # Safety
/// `data` is null or points to as many bytes as its first field says.
pub(super) unsafe fn read_struct<T: CStruct>(
    data: *const T,
    what: &str,
) -> Result<Option<T>, Failure> {
    if data.is_null() {
        return Ok(None);
    }
    // SAFETY: not null, and the caller's promise.
    let size = unsafe { checked_size(data, what)? };
    let bytes: *const u8 = data.cast();
    for i in size_of::<T>()..size {
        // SAFETY: within the size that the caller states.
        if unsafe { bytes.add(i).read() } != 0 {
            return Err(Failure::new(
                HOLEFILL_STATUS_INVALID_STRUCT,
                format!("{what} has a field that this library does not know and that is not zero"),
            ));
        }
    }
    // SAFETY: `size_of::<T>()` bytes are within the stated size; whatever they are is for the user of the value to
    // check: its fields are numbers, pointers and nullable functions.
    Ok(Some(unsafe { data.read_unaligned() }))
}

/// Checks a struct of the caller that will be written.
///
/// # Safety
/// As [`read_struct`].
pub(super) unsafe fn check_struct<T: CStruct>(data: *mut T, what: &str) -> Result<(), Failure> {
    if data.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, and the caller's promise.
    unsafe { checked_size(data.cast_const(), what) }.map(|_| ())
}

/// Writes the fields of a struct after the first two; what the caller's struct has beyond them becomes zero.
///
/// # Safety
/// As [`read_struct`].
pub(super) unsafe fn write_struct<T: CStruct>(
    data: *mut T,
    value: &T,
    what: &str,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe { check_struct(data, what)? };
    // SAFETY: checked just now.
    let size = unsafe { checked_size(data.cast_const(), what)? };
    let (to, from): (*mut u8, *const u8) = (data.cast(), std::ptr::from_ref(value).cast());
    // SAFETY: both are as long as `T`, which is at most the size that the caller states.
    unsafe {
        std::ptr::copy_nonoverlapping(from.add(HEAD), to.add(HEAD), size_of::<T>() - HEAD);
        to.add(size_of::<T>()).write_bytes(0, size - size_of::<T>());
    }
    Ok(())
}

/// A struct with nothing but its size and version.
pub(super) fn blank<T: CStruct>() -> T {
    let mut value = MaybeUninit::<T>::zeroed();
    let fields: *mut u32 = value.as_mut_ptr().cast();
    // SAFETY: `CStruct` says that zeros are a value and that it begins with two `u32`.
    unsafe {
        fields.write(size_of::<T>() as u32);
        fields.add(1).write(T::VERSION);
        value.assume_init()
    }
}

/// Writes a value of the caller.
///
/// # Safety
/// `place` is null or points to a `T`.
pub(super) unsafe fn write<T>(place: *mut T, value: T, what: &str) -> Result<(), Failure> {
    if place.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, and the caller's promise.
    unsafe { place.write_unaligned(value) };
    Ok(())
}

/// A text of the caller; `None` when the pointer is null.
///
/// # Safety
/// `text` is null or ends with a zero byte; it must not change as long as the result lives.
pub(super) unsafe fn read_text<'a>(
    text: *const c_char,
    what: &str,
) -> Result<Option<&'a str>, Failure> {
    if text.is_null() {
        return Ok(None);
    }
    // SAFETY: not null, and the caller's promise.
    match unsafe { CStr::from_ptr(text) }.to_str() {
        Ok(text) => Ok(Some(text)),
        Err(_) => Err(invalid(format!("{what} is not UTF-8"))),
    }
}

/// Writes a text and its length without the zero byte that ends it.
///
/// # Safety
/// `buffer` is null or points to `capacity` bytes, `length` is null or points to a number.
pub(super) unsafe fn write_text(
    text: &str,
    buffer: *mut c_char,
    capacity: u64,
    length: *mut u64,
) -> Result<(), Failure> {
    let bytes = text.as_bytes();
    if length.is_null() {
        return Err(null("length"));
    }
    if buffer.is_null() && capacity > 0 {
        return Err(null("buffer"));
    }
    // SAFETY: not null, and the caller's promise.
    unsafe { length.write_unaligned(bytes.len() as u64) };
    if buffer.is_null() {
        return Ok(());
    }
    if capacity <= bytes.len() as u64 {
        return Err(Failure::new(
            HOLEFILL_STATUS_BUFFER_TOO_SMALL,
            format!("the text needs {} bytes", bytes.len() + 1),
        ));
    }
    // SAFETY: the buffer has room for the text and one byte more.
    unsafe {
        std::ptr::copy_nonoverlapping(bytes.as_ptr(), buffer.cast(), bytes.len());
        buffer.add(bytes.len()).write(0);
    }
    Ok(())
}

/// Writes a list of ids and its length.
///
/// # Safety
/// `buffer` is null or points to `capacity` numbers, `count` is null or points to a number.
pub(super) unsafe fn write_ids(
    ids: &[usize],
    buffer: *mut u64,
    capacity: u64,
    count: *mut u64,
) -> Result<(), Failure> {
    if count.is_null() {
        return Err(null("count"));
    }
    if buffer.is_null() && capacity > 0 {
        return Err(null("ids"));
    }
    // SAFETY: not null, and the caller's promise.
    unsafe { count.write_unaligned(ids.len() as u64) };
    if buffer.is_null() {
        return Ok(());
    }
    if capacity < ids.len() as u64 {
        return Err(Failure::new(
            HOLEFILL_STATUS_BUFFER_TOO_SMALL,
            format!("the list has {} ids", ids.len()),
        ));
    }
    for (i, &id) in ids.iter().enumerate() {
        // SAFETY: the buffer has room for them all.
        unsafe { buffer.add(i).write_unaligned(id as u64) };
    }
    Ok(())
}

/// Bytes of a number of this type; `None` for a number that is no type.
pub(super) fn scalar_size(scalar_type: HolefillType) -> Option<usize> {
    match scalar_type {
        HOLEFILL_TYPE_I8 | HOLEFILL_TYPE_U8 => Some(1),
        HOLEFILL_TYPE_I16 | HOLEFILL_TYPE_U16 => Some(2),
        HOLEFILL_TYPE_I32 | HOLEFILL_TYPE_U32 | HOLEFILL_TYPE_F32 => Some(4),
        HOLEFILL_TYPE_U64 | HOLEFILL_TYPE_F64 => Some(8),
        _ => None,
    }
}

/// No address space is larger: processors of 64 bits use at most 57 of them, one for the system.
const MOST_BYTES: usize = if usize::BITS == 64 {
    1 << 56
} else {
    isize::MAX as usize
};

/// Rows in the caller's memory, whose extent was checked.
#[derive(Clone, Copy)]
struct Rows {
    data: *mut u8,
    count: usize,
    stride: usize,
    width: usize,
}

impl Rows {
    /// Checks rows of `width` numbers of one of the types `allowed`.
    fn check(
        view: HolefillInput,
        width: usize,
        allowed: &[HolefillType],
        what: &str,
    ) -> Result<Self, Failure> {
        let size = scalar_size(view.scalar_type).filter(|_| allowed.contains(&view.scalar_type));
        let Some(size) = size else {
            return Err(invalid(format!(
                "{what} cannot have the type {}",
                view.scalar_type
            )));
        };
        if view.reserved != 0 {
            return Err(Failure::new(
                HOLEFILL_STATUS_INVALID_STRUCT,
                format!("{what} has a reserved field that is not zero"),
            ));
        }
        let overflow = || {
            Failure::new(
                HOLEFILL_STATUS_OVERFLOW,
                format!("{what} is larger than the address space"),
            )
        };
        let row = size.checked_mul(width).ok_or_else(overflow)?;
        let stride = match view.stride {
            0 => row,
            stride => usize::try_from(stride).map_err(|_| overflow())?,
        };
        if stride < row {
            return Err(invalid(format!(
                "{what} has the stride {stride}, but its rows have {row} bytes"
            )));
        }
        let count = usize::try_from(view.count).map_err(|_| overflow())?;
        let extent = count.checked_mul(stride).ok_or_else(overflow)?;
        if extent > MOST_BYTES || (view.data as usize).checked_add(extent).is_none() {
            return Err(overflow());
        }
        if count > 0 && view.data.is_null() {
            return Err(null(what));
        }
        Ok(Self {
            data: view.data.cast_mut().cast(),
            count,
            stride,
            width: size,
        })
    }

    /// Where number `k` of row `i` is.
    ///
    /// # Safety
    /// `i` is below the count, `k` below the width of a row.
    unsafe fn at(&self, i: usize, k: usize) -> *mut u8 {
        // SAFETY: the caller's promise, and `check`.
        unsafe { self.data.add(i * self.stride + k * self.width) }
    }
}

/// The description of input, checked for null.
///
/// # Safety
/// `input` is null or points to a `HolefillInput`.
unsafe fn input_view(input: *const HolefillInput, what: &str) -> Result<HolefillInput, Failure> {
    if input.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, and the caller's promise.
    Ok(unsafe { input.read_unaligned() })
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

/// The address of the caller's memory, for several threads to read.
#[derive(Clone, Copy)]
struct Source(*const u8);

// SAFETY: the memory is only read, and the caller promises that it stays as it is during the call.
unsafe impl Sync for Source {}

impl Source {
    /// # Safety
    /// As `pointer::add`.
    unsafe fn add(&self, bytes: usize) -> *const u8 {
        // SAFETY: the caller's promise.
        unsafe { self.0.add(bytes) }
    }
}

/// Fills an empty vector, which has room for them, with copies of rows without gaps. Several threads share the work:
/// most of it is that memory is used for the first time.
///
/// # Safety
/// Rows are as long as a `T`, and any bits are a `T`.
unsafe fn copy_rows<T: Copy + Send>(rows: &Rows, values: &mut Vec<T>) {
    let source = Source(rows.data.cast_const());
    let room = &mut values.spare_capacity_mut()[..rows.count];
    room.par_chunks_mut(COPIED_ROWS)
        .enumerate()
        .for_each(|(k, room)| {
            // SAFETY: the chunk lies within the rows, which were checked; bytes need no alignment.
            unsafe {
                let from = source.add(k * COPIED_ROWS * size_of::<T>());
                let to: *mut u8 = room.as_mut_ptr().cast();
                std::ptr::copy_nonoverlapping(from, to, size_of_val(room));
            }
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
    let view = unsafe { input_view(input, what)? };
    let rows = Rows::check(view, 3, &[HOLEFILL_TYPE_F32, HOLEFILL_TYPE_F64], what)?;
    let mut points: Vec<[f64; 3]> = room(rows.count, what)?;
    if view.scalar_type == HOLEFILL_TYPE_F64 && rows.stride == size_of::<[f64; 3]>() {
        // SAFETY: the rows are as long as points, and any bits are numbers.
        unsafe { copy_rows(&rows, &mut points) };
        return Ok(points);
    }
    // SAFETY: `i` is below the count and `k` below 3; any bits are numbers.
    let number = |i: usize, k: usize| unsafe {
        match view.scalar_type {
            HOLEFILL_TYPE_F32 => f64::from(rows.at(i, k).cast::<f32>().read_unaligned()),
            _ => rows.at(i, k).cast::<f64>().read_unaligned(),
        }
    };
    points.extend((0..rows.count).map(|i| [number(i, 0), number(i, 1), number(i, 2)]));
    Ok(points)
}

/// Copies rows of `N` indices.
///
/// # Errors
/// `HOLEFILL_STATUS_INDEX_OUT_OF_RANGE` for an index beyond 32 bits.
///
/// # Safety
/// As [`read_points`].
pub(super) unsafe fn read_indices<const N: usize>(
    input: *const HolefillInput,
    what: &str,
) -> Result<Vec<[u32; N]>, Failure> {
    // SAFETY: the caller's promise.
    let view = unsafe { input_view(input, what)? };
    let rows = Rows::check(view, N, &[HOLEFILL_TYPE_U32, HOLEFILL_TYPE_U64], what)?;
    let mut values: Vec<[u32; N]> = room(rows.count, what)?;
    if view.scalar_type == HOLEFILL_TYPE_U32 && rows.stride == size_of::<[u32; N]>() {
        // SAFETY: the rows are as long as those of indices, and any bits are numbers.
        unsafe { copy_rows(&rows, &mut values) };
        return Ok(values);
    }
    for i in 0..rows.count {
        let mut row = [0; N];
        for (k, place) in row.iter_mut().enumerate() {
            // SAFETY: `i` is below the count and `k` below the width; any bits are numbers.
            let index = unsafe {
                match view.scalar_type {
                    HOLEFILL_TYPE_U32 => u64::from(rows.at(i, k).cast::<u32>().read_unaligned()),
                    _ => rows.at(i, k).cast::<u64>().read_unaligned(),
                }
            };
            *place = u32::try_from(index).map_err(|_| {
                Failure::new(
                    HOLEFILL_STATUS_INDEX_OUT_OF_RANGE,
                    format!("row {i} of {what} has the index {index}"),
                )
            })?;
        }
        values.push(row);
    }
    Ok(values)
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

/// Copies ids.
///
/// # Safety
/// As [`read_points`].
pub(super) unsafe fn read_ids(
    input: *const HolefillInput,
    what: &str,
) -> Result<Vec<usize>, Failure> {
    // SAFETY: the caller's promise.
    let ids = unsafe { read_indices::<1>(input, what)? };
    Ok(ids.into_iter().map(|[id]| id as usize).collect())
}

/// Numbers that can be copied from the caller's memory: any bits are a value.
pub(super) trait Plain: Copy {}
impl Plain for i8 {}
impl Plain for u8 {}
impl Plain for i16 {}
impl Plain for u16 {}
impl Plain for i32 {}
impl Plain for u32 {}
impl Plain for f32 {}
impl Plain for f64 {}

/// Columns of numbers in the caller's rows.
pub(super) struct Columns {
    rows: Rows,
}

impl Columns {
    /// Checks rows of `width` numbers.
    ///
    /// # Safety
    /// As [`read_points`]; the memory must stay as it is while the result lives.
    pub(super) unsafe fn check(
        input: *const HolefillInput,
        width: usize,
        what: &str,
    ) -> Result<(Self, HolefillType), Failure> {
        // SAFETY: the caller's promise.
        let view = unsafe { input_view(input, what)? };
        let rows = Rows::check(view, width, &ATTRIBUTE_TYPES, what)?;
        Ok((Self { rows }, view.scalar_type))
    }

    pub(super) fn count(&self) -> usize {
        self.rows.count
    }

    /// Column `k`, which must exist, as numbers of the type that the rows have.
    pub(super) fn column<T: Plain>(&self, k: usize, what: &str) -> Result<Vec<T>, Failure> {
        let mut values = room(self.rows.count, what)?;
        // SAFETY: the rows were checked, and any bits are a `T`.
        let number = |i| unsafe { self.rows.at(i, k).cast::<T>().read_unaligned() };
        values.extend((0..self.rows.count).map(number));
        Ok(values)
    }
}

/// Types that attributes can have.
pub(super) const ATTRIBUTE_TYPES: [HolefillType; 8] = [
    HOLEFILL_TYPE_I8,
    HOLEFILL_TYPE_U8,
    HOLEFILL_TYPE_I16,
    HOLEFILL_TYPE_U16,
    HOLEFILL_TYPE_I32,
    HOLEFILL_TYPE_U32,
    HOLEFILL_TYPE_F32,
    HOLEFILL_TYPE_F64,
];

/// The caller's memory for the rows `range` of something.
pub(super) struct Sink {
    rows: Rows,
    scalar_type: HolefillType,
    /// The rows that are asked for.
    pub(super) range: Range<usize>,
}

/// What is asked of a [`Sink`]: rows of `width` numbers of one of the types `allowed`, from row `first` on, of which
/// there are `total`.
pub(super) struct Wanted<'a> {
    pub(super) first: u64,
    pub(super) total: usize,
    pub(super) width: usize,
    pub(super) allowed: &'a [HolefillType],
}

impl Sink {
    /// Checks where to write.
    ///
    /// # Safety
    /// `output` is null or describes memory of the caller.
    pub(super) unsafe fn check(
        output: *const HolefillOutput,
        wanted: &Wanted<'_>,
    ) -> Result<Self, Failure> {
        if output.is_null() {
            return Err(null("output"));
        }
        // SAFETY: not null, and the caller's promise.
        let view = unsafe { output.read_unaligned() };
        let as_input = HolefillInput {
            data: view.data.cast_const(),
            count: view.count,
            stride: view.stride,
            scalar_type: view.scalar_type,
            reserved: view.reserved,
        };
        let rows = Rows::check(as_input, wanted.width, wanted.allowed, "output")?;
        let end = wanted.first.checked_add(view.count);
        if end.is_none_or(|end| end > wanted.total as u64) {
            return Err(Failure::new(
                HOLEFILL_STATUS_NOT_FOUND,
                format!(
                    "there are {} rows, not {} from row {} on",
                    wanted.total, view.count, wanted.first
                ),
            ));
        }
        let first = wanted.first as usize;
        Ok(Self {
            range: first..first + rows.count,
            scalar_type: view.scalar_type,
            rows,
        })
    }

    /// Writes number `k` of the `i`-th row as it is; it must have the type of the rows.
    pub(super) fn put<T: Copy>(&self, i: usize, k: usize, value: T) {
        debug_assert_eq!(size_of::<T>(), self.rows.width);
        debug_assert!(i < self.rows.count);
        if size_of::<T>() != self.rows.width || i >= self.rows.count {
            return;
        }
        // SAFETY: the rows were checked, and the number is as wide as theirs.
        unsafe { self.rows.at(i, k).cast::<T>().write_unaligned(value) };
    }

    /// Whether rows are wanted as this type.
    pub(super) fn is_of(&self, scalar_type: HolefillType) -> bool {
        self.scalar_type == scalar_type
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
    let wanted = Wanted {
        first,
        total: points.len(),
        width: 3,
        allowed: &[HOLEFILL_TYPE_F32, HOLEFILL_TYPE_F64],
    };
    // SAFETY: the caller's promise.
    let sink = unsafe { Sink::check(output, &wanted)? };
    for (i, point) in points[sink.range.clone()].iter().enumerate() {
        for (k, &value) in point.iter().enumerate() {
            match sink.scalar_type {
                HOLEFILL_TYPE_F32 => sink.put(i, k, value as f32),
                _ => sink.put(i, k, value),
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
    let wanted = Wanted {
        first,
        total: rows.len(),
        width: N,
        allowed: &[HOLEFILL_TYPE_U32, HOLEFILL_TYPE_U64],
    };
    // SAFETY: the caller's promise.
    let sink = unsafe { Sink::check(output, &wanted)? };
    for (i, row) in rows[sink.range.clone()].iter().enumerate() {
        for (k, &value) in row.iter().enumerate() {
            match sink.scalar_type {
                HOLEFILL_TYPE_U32 => sink.put(i, k, value),
                _ => sink.put(i, k, u64::from(value)),
            }
        }
    }
    Ok(())
}

const _: () = {
    assert!(offset_of!(HolefillInput, data) == 0);
    assert!(offset_of!(HolefillOutput, data) == 0);
};

/// Makes a struct of the caller blank.
///
/// # Safety
/// `data` is not null and points to `struct_size` bytes.
pub(super) unsafe fn init_struct<T: CStruct>(
    data: *mut T,
    struct_size: u32,
    what: &str,
) -> Result<(), Failure> {
    let size = struct_size as usize;
    if !(size_of::<T>()..=LARGEST_STRUCT).contains(&size) {
        return Err(Failure::new(
            HOLEFILL_STATUS_INVALID_STRUCT,
            format!(
                "{what} has the size {size}, which is not {} or somewhat more",
                size_of::<T>()
            ),
        ));
    }
    let fields: *mut u32 = data.cast();
    // SAFETY: the caller's promise; the size was checked.
    unsafe {
        data.cast::<u8>().write_bytes(0, size);
        fields.write_unaligned(struct_size);
        fields.add(1).write_unaligned(T::VERSION);
    }
    Ok(())
}
