//! [`PlyDetails`]: the parts of a PLY file that other formats do not have.

use crate::mesh::attributes::{Attributes, ScalarType};

/// How a PLY file stores its numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlyEncoding {
    /// As text.
    Ascii,
    /// In binary, least significant byte first.
    #[default]
    BinaryLittleEndian,
    /// In binary, most significant byte first.
    BinaryBigEndian,
}

impl PlyEncoding {
    pub(super) const ALL: [Self; 3] =
        [Self::Ascii, Self::BinaryLittleEndian, Self::BinaryBigEndian];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ascii => "ascii",
            Self::BinaryLittleEndian => "binary_little_endian",
            Self::BinaryBigEndian => "binary_big_endian",
        }
    }
}

/// An element of a PLY file that is neither vertex nor face.
#[derive(Clone, Debug, PartialEq)]
pub struct PlyElement {
    /// The name in the header, such as `edge`.
    pub name: String,
    /// The rows, with one entry for each.
    pub rows: Attributes,
}

/// The parts of a PLY file that other formats do not have. They are kept so that they can be written again.
#[derive(Clone, Debug, PartialEq)]
pub struct PlyDetails {
    /// The encoding of numbers.
    pub encoding: PlyEncoding,
    /// The `comment` and `obj_info` lines of the header, complete and in order.
    pub remarks: Vec<String>,
    /// The elements other than vertex and face, in order.
    pub elements: Vec<PlyElement>,
    pub(super) corner_list: CornerList,
    /// Number of vertex attributes before the position.
    pub(super) vertex_attributes_before: usize,
    /// Number of face attributes before the list of corners.
    pub(super) face_attributes_before: usize,
}

impl Default for PlyDetails {
    fn default() -> Self {
        Self {
            encoding: PlyEncoding::default(),
            remarks: Vec::new(),
            elements: Vec::new(),
            corner_list: CornerList {
                name: "vertex_indices",
                count_type: ScalarType::U8,
                index_type: ScalarType::I32,
            },
            vertex_attributes_before: 0,
            face_attributes_before: 0,
        }
    }
}

/// The property of a face that lists its vertices.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CornerList {
    pub(super) name: &'static str,
    pub(super) count_type: ScalarType,
    pub(super) index_type: ScalarType,
}
