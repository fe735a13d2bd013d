//! Arrays of numbers, and of lists of numbers, whose number type is known only at run time.

use crate::error::{Error, Result};
use std::ops::Range;

/// The type of a number in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ScalarType {
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 32 bits.
    I32,
    /// Unsigned, 32 bits.
    U32,
    /// Floating point, single precision.
    F32,
    /// Floating point, double precision.
    F64,
}

impl ScalarType {
    /// The size of one number in bytes.
    #[must_use]
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Whether the type holds whole numbers only.
    #[must_use]
    pub fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// Numbers of one type.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // each variant is the `ScalarType` of its name
pub enum ScalarValues {
    I8(Vec<i8>),
    U8(Vec<u8>),
    I16(Vec<i16>),
    U16(Vec<u16>),
    I32(Vec<i32>),
    U32(Vec<u32>),
    F32(Vec<f32>),
    F64(Vec<f64>),
}

/// Evaluates `$body` with `$v` bound to the vector inside a [`ScalarValues`] of any type. The name `ScalarValues`
/// must be in scope.
macro_rules! with_scalars {
    ($values:expr, $v:ident => $body:expr) => {
        match $values {
            ScalarValues::I8($v) => $body,
            ScalarValues::U8($v) => $body,
            ScalarValues::I16($v) => $body,
            ScalarValues::U16($v) => $body,
            ScalarValues::I32($v) => $body,
            ScalarValues::U32($v) => $body,
            ScalarValues::F32($v) => $body,
            ScalarValues::F64($v) => $body,
        }
    };
}
pub(crate) use with_scalars;

/// Conversion of one number from and to `f64`.
trait Number: Copy {
    fn to_f64(self) -> f64;
    fn from_f64(value: f64) -> Self;
}

macro_rules! impl_number {
    ($round:path: $($t:ty),*) => {
        $(impl Number for $t {
            fn to_f64(self) -> f64 {
                self.into()
            }

            // A cast to an integer clamps to its range and turns NaN into zero.
            fn from_f64(value: f64) -> Self {
                $round(value) as $t
            }
        })*
    };
}
impl_number!(f64::round: i8, u8, i16, u16, i32, u32);
impl_number!(std::convert::identity: f32, f64);

impl ScalarValues {
    /// An empty array of the type `scalar_type`.
    #[must_use]
    pub fn new(scalar_type: ScalarType) -> Self {
        Self::with_capacity(scalar_type, 0)
    }

    pub(crate) fn with_capacity(scalar_type: ScalarType, capacity: usize) -> Self {
        match scalar_type {
            ScalarType::I8 => Self::I8(Vec::with_capacity(capacity)),
            ScalarType::U8 => Self::U8(Vec::with_capacity(capacity)),
            ScalarType::I16 => Self::I16(Vec::with_capacity(capacity)),
            ScalarType::U16 => Self::U16(Vec::with_capacity(capacity)),
            ScalarType::I32 => Self::I32(Vec::with_capacity(capacity)),
            ScalarType::U32 => Self::U32(Vec::with_capacity(capacity)),
            ScalarType::F32 => Self::F32(Vec::with_capacity(capacity)),
            ScalarType::F64 => Self::F64(Vec::with_capacity(capacity)),
        }
    }

    /// The type of the numbers.
    #[must_use]
    pub fn scalar_type(&self) -> ScalarType {
        match self {
            Self::I8(_) => ScalarType::I8,
            Self::U8(_) => ScalarType::U8,
            Self::I16(_) => ScalarType::I16,
            Self::U16(_) => ScalarType::U16,
            Self::I32(_) => ScalarType::I32,
            Self::U32(_) => ScalarType::U32,
            Self::F32(_) => ScalarType::F32,
            Self::F64(_) => ScalarType::F64,
        }
    }

    /// The number of numbers.
    #[must_use]
    pub fn len(&self) -> usize {
        with_scalars!(self, v => v.len())
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number `k`, widened exactly; `None` past the end.
    #[must_use]
    pub fn get(&self, k: usize) -> Option<f64> {
        with_scalars!(self, v => v.get(k).map(|&x| x.to_f64()))
    }

    /// Appends `value`. For an integer type it is rounded to the nearest integer (halves away from zero) and clamped to
    /// the range of the type; NaN becomes zero.
    pub fn push(&mut self, value: f64) {
        with_scalars!(self, v => v.push(Number::from_f64(value)));
    }

    pub(crate) fn to_f64_vec(&self) -> Vec<f64> {
        with_scalars!(self, v => v.iter().map(|&x| x.to_f64()).collect())
    }

    /// Appends a copy of the numbers in `range`, which must exist.
    pub(super) fn push_copies_of(&mut self, range: Range<usize>) {
        with_scalars!(self, v => v.extend_from_within(range));
    }

    /// Keeps the first `count` numbers.
    pub(super) fn truncate(&mut self, count: usize) {
        with_scalars!(self, v => v.truncate(count));
    }

    /// Removes the first `count` numbers, which must exist.
    pub(super) fn drop_front(&mut self, count: usize) {
        with_scalars!(self, v => drop(v.drain(..count)));
    }
}

/// Lists of numbers of one type, stored one after the other in one array.
#[derive(Clone, Debug, PartialEq)]
pub struct ListValues {
    count_type: ScalarType,
    items: ScalarValues,
    /// The end of each list in `items`. A list starts at the end of the list before.
    ends: Vec<usize>,
}

impl ListValues {
    /// An empty array of lists. `count_type` is the type in which a PLY file stores the length of a list.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`](crate::ErrorKind::InvalidInput) when `count_type` is not an integer type.
    pub fn new(count_type: ScalarType, item_type: ScalarType) -> Result<Self> {
        Self::from_parts(count_type, ScalarValues::new(item_type), Vec::new())
    }

    /// Makes lists from the `items` of all lists and the end of each list in them.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`](crate::ErrorKind::InvalidInput) when `count_type` is not an integer type, or
    /// `ends` decreases or does not end at the number of items.
    pub fn from_parts(
        count_type: ScalarType,
        items: ScalarValues,
        ends: Vec<usize>,
    ) -> Result<Self> {
        if !count_type.is_integer() {
            return Err(Error::invalid("the length of a list needs an integer type"));
        }
        if !ends.is_sorted() || ends.last().copied().unwrap_or(0) != items.len() {
            return Err(Error::invalid(
                "the ends of the lists do not match their items",
            ));
        }
        Ok(Self {
            count_type,
            items,
            ends,
        })
    }

    /// The type in which a PLY file stores the length of a list.
    #[must_use]
    pub fn count_type(&self) -> ScalarType {
        self.count_type
    }

    /// The items of all lists, one list after the other.
    #[must_use]
    pub fn items(&self) -> &ScalarValues {
        &self.items
    }

    /// The number of lists.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The range of list `k` in [`items`](Self::items); `None` past the end.
    #[must_use]
    pub fn range(&self, k: usize) -> Option<Range<usize>> {
        let end = *self.ends.get(k)?;
        Some(if k == 0 { 0 } else { self.ends[k - 1] }..end)
    }

    pub(crate) fn items_mut(&mut self) -> &mut ScalarValues {
        &mut self.items
    }

    /// Makes one list of the items that were pushed since the last call.
    pub(crate) fn close_list(&mut self) {
        self.ends.push(self.items.len());
    }

    /// Appends a copy of list `k`, which must exist.
    pub(super) fn push_copy_of(&mut self, k: usize) {
        if let Some(range) = self.range(k) {
            self.items.push_copies_of(range);
            self.close_list();
        }
    }

    /// Keeps the first `count` lists.
    pub(super) fn truncate(&mut self, count: usize) {
        self.ends.truncate(count);
        self.items.truncate(self.ends.last().copied().unwrap_or(0));
    }

    /// Removes the first `count` lists, which must exist.
    pub(super) fn drop_front(&mut self, count: usize) {
        let first = count.checked_sub(1).map_or(0, |last| self.ends[last]);
        self.items.drop_front(first);
        self.ends.drain(..count);
        self.ends.iter_mut().for_each(|end| *end -= first);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn appended_numbers_are_rounded_and_clamped_to_integer_types() {
        let cases = [
            (ScalarType::U8, 254.5, 255.0),
            (ScalarType::U8, 254.4, 254.0),
            (ScalarType::U8, 1e9, 255.0),
            (ScalarType::U8, -0.6, 0.0),
            (ScalarType::I8, -1e9, -128.0),
            (ScalarType::I16, -2.5, -3.0),
            (ScalarType::U16, f64::INFINITY, 65535.0),
            (ScalarType::I32, f64::NAN, 0.0),
            (ScalarType::U32, 4294967294.6, 4294967295.0),
            (ScalarType::F32, 0.1, f64::from(0.1f32)),
            (ScalarType::F64, 0.1, 0.1),
        ];
        for (scalar_type, value, expected) in cases {
            let mut values = ScalarValues::new(scalar_type);
            values.push(value);
            assert_eq!(values.get(0), Some(expected), "{scalar_type:?} {value}");
        }
    }

    #[test]
    fn lists_with_inconsistent_parts_are_refused() {
        let items = || ScalarValues::F64(vec![1.0, 2.0]);
        let make = |count, ends: &[usize]| ListValues::from_parts(count, items(), ends.to_vec());
        assert!(make(ScalarType::U8, &[1, 2]).is_ok());
        assert!(make(ScalarType::U8, &[1]).is_err());
        assert!(make(ScalarType::U8, &[3, 2]).is_err());
        assert!(make(ScalarType::U8, &[]).is_err());
        assert!(make(ScalarType::F32, &[1, 2]).is_err());
    }
}
