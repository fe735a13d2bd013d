//! Structs of the caller that begin with their size and version.
//!
//! A program may be older or newer than the library. What a shorter struct does not have is read as zero and not written.
//! What a longer struct has more must be zero, and becomes zero where the library writes.

use super::failure::{Failure, invalid_struct, not_null};
use super::types::*;
use std::mem::{MaybeUninit, align_of};

/// A struct of the caller that begins with its size and version.
///
/// # Safety
/// The type is `repr(C)`, begins with `struct_size: u32` and `version: u32`, and all zero bytes are a value of it.
pub(super) unsafe trait CStruct: Copy + Default {
    const VERSION: u32;
}

macro_rules! versioned {
    ($($name:ident = $version:ident),* $(,)?) => {
        $(
            // SAFETY: repr(C), begins with two `u32`, and all zero bytes are a value: numbers, pointers, and
            // functions that may be null.
            unsafe impl CStruct for $name {
                const VERSION: u32 = $version;
            }

            /// Nothing but its size and version.
            impl Default for $name {
                fn default() -> Self {
                    blank()
                }
            }
        )*
    };
}
versioned!(
    HolefillMeshInfo = HOLEFILL_MESH_INFO_VERSION,
    HolefillDefects = HOLEFILL_DEFECTS_VERSION,
    HolefillAttributeInfo = HOLEFILL_ATTRIBUTE_INFO_VERSION,
    HolefillLoopInfo = HOLEFILL_LOOP_INFO_VERSION,
    HolefillSelection = HOLEFILL_SELECTION_VERSION,
    HolefillTarget = HOLEFILL_TARGET_VERSION,
    HolefillProgress = HOLEFILL_PROGRESS_VERSION,
    HolefillFillOptions = HOLEFILL_FILL_OPTIONS_VERSION,
    HolefillPointOptions = HOLEFILL_POINT_OPTIONS_VERSION,
    HolefillPointSummary = HOLEFILL_POINT_SUMMARY_VERSION,
    HolefillPatchInfo = HOLEFILL_PATCH_INFO_VERSION,
    HolefillHole = HOLEFILL_HOLE_VERSION,
    HolefillPrediction = HOLEFILL_PREDICTION_VERSION,
    HolefillSummary = HOLEFILL_SUMMARY_VERSION,
);

/// A greater size is not that of a struct: the field was not set.
const LARGEST_STRUCT: usize = 4096;
/// Size of the two fields that every such struct begins with.
const HEAD: usize = 8;

/// The size that the caller's struct has, after the checks of its first two fields.
///
/// # Safety
/// `data` is null or points to two `u32`.
pub(super) unsafe fn check_struct<T: CStruct>(
    data: *const T,
    what: &str,
) -> Result<usize, Failure> {
    not_null(data, what)?;
    let fields: *const u32 = data.cast();
    // SAFETY: not null, and the caller's promise.
    let (size, version) = unsafe { (fields.read_unaligned(), fields.add(1).read_unaligned()) };
    if version != T::VERSION {
        let known = T::VERSION;
        return Err(invalid_struct(format!(
            "{what} has version {version}, this library knows {known}"
        )));
    }
    let (size, own) = (size as usize, size_of::<T>());
    // Structs of older headers end where their alignment says: another size would cut a field.
    let is_older = size < own && size.is_multiple_of(align_of::<T>());
    if !(HEAD..=LARGEST_STRUCT).contains(&size) || !(is_older || size >= own) {
        return Err(invalid_struct(format!(
            "{what} has the struct_size {size}, which no version of it has; this library knows {own}"
        )));
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
    // SAFETY: the caller's promise.
    let size = unsafe { check_struct(data, what)? };
    let bytes: *const u8 = data.cast();
    // SAFETY: within the size that the caller states.
    let is_zero = |i: usize| unsafe { bytes.add(i).read() } == 0;
    if !(size_of::<T>()..size).all(is_zero) {
        return Err(invalid_struct(format!(
            "{what} has a field that this library does not know and that is not zero"
        )));
    }
    let mut value = MaybeUninit::<T>::zeroed();
    let known = size.min(size_of::<T>());
    // SAFETY: both have `known` bytes. Zeros are a value of every field, and so is whatever the caller gives: fields are
    // numbers, pointers and nullable functions.
    unsafe {
        std::ptr::copy_nonoverlapping(bytes, value.as_mut_ptr().cast(), known);
        Ok(Some(value.assume_init()))
    }
}

/// Writes the fields of a struct after the first two, as far as the caller's struct goes.
///
/// # Safety
/// As [`read_struct`].
pub(super) unsafe fn write_struct<T: CStruct>(
    data: *mut T,
    value: &T,
    what: &str,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    let size = unsafe { check_struct(data.cast_const(), what)? };
    let known = size.min(size_of::<T>());
    let (to, from): (*mut u8, *const u8) = (data.cast(), std::ptr::from_ref(value).cast());
    // SAFETY: `known` is at most the size of either, and `size` that of the caller's.
    unsafe {
        std::ptr::copy_nonoverlapping(from.add(HEAD), to.add(HEAD), known - HEAD);
        to.add(known).write_bytes(0, size - known);
    }
    Ok(())
}

/// A struct with nothing but its size and version.
fn blank<T: CStruct>() -> T {
    let mut value = MaybeUninit::<T>::zeroed();
    let fields: *mut u32 = value.as_mut_ptr().cast();
    // SAFETY: `CStruct` says that zeros are a value and that it begins with two `u32`.
    unsafe {
        fields.write(size_of::<T>() as u32);
        fields.add(1).write(T::VERSION);
        value.assume_init()
    }
}
