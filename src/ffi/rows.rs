//! Rows of numbers in the caller's memory: their extent, checked before anything is read or written.

use super::failure::{Failure, invalid, invalid_struct, null};
use super::status::HOLEFILL_STATUS_OVERFLOW;
use super::types::*;

/// Types that points can have.
pub(super) const POINT_TYPES: &[HolefillType] = &[HOLEFILL_TYPE_F32, HOLEFILL_TYPE_F64];
/// Types that indices and ids can have.
pub(super) const INDEX_TYPES: &[HolefillType] = &[
    HOLEFILL_TYPE_I32,
    HOLEFILL_TYPE_U32,
    HOLEFILL_TYPE_I64,
    HOLEFILL_TYPE_U64,
];
/// Types that attributes can have.
pub(super) const ATTRIBUTE_TYPES: &[HolefillType] = &[
    HOLEFILL_TYPE_I8,
    HOLEFILL_TYPE_U8,
    HOLEFILL_TYPE_I16,
    HOLEFILL_TYPE_U16,
    HOLEFILL_TYPE_I32,
    HOLEFILL_TYPE_U32,
    HOLEFILL_TYPE_F32,
    HOLEFILL_TYPE_F64,
];

/// Bytes of a number of this type; `None` for a number that is no type.
fn scalar_size(scalar_type: HolefillType) -> Option<usize> {
    match scalar_type {
        HOLEFILL_TYPE_I8 | HOLEFILL_TYPE_U8 => Some(1),
        HOLEFILL_TYPE_I16 | HOLEFILL_TYPE_U16 => Some(2),
        HOLEFILL_TYPE_I32 | HOLEFILL_TYPE_U32 | HOLEFILL_TYPE_F32 => Some(4),
        HOLEFILL_TYPE_I64 | HOLEFILL_TYPE_U64 | HOLEFILL_TYPE_F64 => Some(8),
        _ => None,
    }
}

/// No address space is larger: processors of 64 bits use at most 57 of them, one for the system.
const MOST_BYTES: usize = if usize::BITS == 64 {
    1 << 56
} else {
    isize::MAX as usize
};

/// Rows in the caller's memory whose extent was checked.
#[derive(Clone, Copy)]
pub(super) struct Rows {
    pub(super) data: *mut u8,
    pub(super) count: usize,
    pub(super) stride: usize,
    pub(super) scalar_type: HolefillType,
    /// Bytes of a number.
    pub(super) scalar_size: usize,
}

impl Rows {
    /// Checks rows of `width` numbers of one of the types `allowed`.
    pub(super) fn check(
        view: HolefillInput,
        width: usize,
        allowed: &[HolefillType],
        what: &str,
    ) -> Result<Self, Failure> {
        let scalar_type = view.scalar_type;
        let known = scalar_size(scalar_type).filter(|_| allowed.contains(&scalar_type));
        let Some(scalar_size) = known else {
            return Err(invalid(format!(
                "{what} cannot have the type {scalar_type}"
            )));
        };
        if view.reserved != 0 {
            let message = format!("{what} has a reserved field that is not zero");
            return Err(invalid_struct(message));
        }
        let overflow = || {
            let message = format!("{what} is larger than the address space");
            Failure::new(HOLEFILL_STATUS_OVERFLOW, message)
        };
        let row = scalar_size.checked_mul(width).ok_or_else(overflow)?;
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
            scalar_type,
            scalar_size,
        })
    }

    /// Where number `k` of row `i` is.
    ///
    /// # Safety
    /// `i` is below the count, `k` below the width of a row.
    pub(super) unsafe fn at<T>(&self, i: usize, k: usize) -> *mut T {
        // SAFETY: the caller's promise, and `check`.
        let place = unsafe { self.data.add(i * self.stride + k * self.scalar_size) };
        place.cast()
    }
}
