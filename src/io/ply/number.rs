//! Reads and writes numbers in the three encodings of PLY.

use super::details::PlyEncoding;
use crate::mesh::attributes::ScalarType;
use std::fmt::Debug;
use std::io::{self, Write};
use std::str::FromStr;

/// A number type of PLY. `Debug` prints the shortest text that gives the same number when it is read.
pub(super) trait Encoded: Copy + Debug + FromStr {
    const SIZE: usize;

    /// Reads a number from the first `SIZE` bytes, which must exist.
    fn decode(bytes: &[u8], encoding: PlyEncoding) -> Self;

    fn encode(self, encoding: PlyEncoding, out: &mut impl Write) -> io::Result<()>;

    /// The number as the index of a vertex.
    fn to_index(self) -> Option<u32>;
}

macro_rules! impl_encoded {
    ($to_index:expr => $($t:ty),*) => {
        $(impl Encoded for $t {
            const SIZE: usize = size_of::<$t>();

            fn decode(bytes: &[u8], encoding: PlyEncoding) -> Self {
                let mut array = [0; size_of::<$t>()];
                array.copy_from_slice(&bytes[..size_of::<$t>()]);
                match encoding {
                    PlyEncoding::BinaryBigEndian => <$t>::from_be_bytes(array),
                    _ => <$t>::from_le_bytes(array),
                }
            }

            fn encode(self, encoding: PlyEncoding, out: &mut impl Write) -> io::Result<()> {
                match encoding {
                    PlyEncoding::Ascii => write!(out, "{self:?} "),
                    PlyEncoding::BinaryLittleEndian => out.write_all(&self.to_le_bytes()),
                    PlyEncoding::BinaryBigEndian => out.write_all(&self.to_be_bytes()),
                }
            }

            fn to_index(self) -> Option<u32> {
                $to_index(self)
            }
        })*
    };
}
impl_encoded!(|value| u32::try_from(i64::from(value)).ok() => i8, u8, i16, u16, i32, u32);
impl_encoded!(|_| None => f32, f64);

/// The length of a list, read from a number of type `count_type`; `None` if it is negative.
pub(super) fn decode_count(
    bytes: &[u8],
    count_type: ScalarType,
    encoding: PlyEncoding,
) -> Option<usize> {
    let index = match count_type {
        ScalarType::I8 => i8::decode(bytes, encoding).to_index(),
        ScalarType::U8 => u8::decode(bytes, encoding).to_index(),
        ScalarType::I16 => i16::decode(bytes, encoding).to_index(),
        ScalarType::U16 => u16::decode(bytes, encoding).to_index(),
        ScalarType::I32 => i32::decode(bytes, encoding).to_index(),
        ScalarType::U32 => u32::decode(bytes, encoding).to_index(),
        ScalarType::F32 | ScalarType::F64 => None,
    };
    index.and_then(|count| usize::try_from(count).ok())
}

/// Writes the length of a list. It must fit `count_type`.
pub(super) fn encode_count(
    count: usize,
    count_type: ScalarType,
    encoding: PlyEncoding,
    out: &mut impl Write,
) -> io::Result<()> {
    match count_type {
        ScalarType::I8 => (count as i8).encode(encoding, out),
        ScalarType::U8 => (count as u8).encode(encoding, out),
        ScalarType::I16 => (count as i16).encode(encoding, out),
        ScalarType::U16 => (count as u16).encode(encoding, out),
        ScalarType::I32 => (count as i32).encode(encoding, out),
        ScalarType::U32 => (count as u32).encode(encoding, out),
        ScalarType::F32 | ScalarType::F64 => Err(io::Error::from(io::ErrorKind::InvalidInput)),
    }
}

/// The largest whole number that an integer type holds.
pub(super) fn largest(scalar_type: ScalarType) -> Option<usize> {
    let largest = match scalar_type {
        ScalarType::I8 => i8::MAX as u32,
        ScalarType::U8 => u8::MAX.into(),
        ScalarType::I16 => i16::MAX as u32,
        ScalarType::U16 => u16::MAX.into(),
        ScalarType::I32 => i32::MAX as u32,
        ScalarType::U32 => u32::MAX,
        ScalarType::F32 | ScalarType::F64 => return None,
    };
    usize::try_from(largest).ok()
}
