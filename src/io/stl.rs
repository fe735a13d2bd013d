//! Reads and writes STL, triangles without connectivity. Text and binary files are read; binary files are written.
//!
//! When a file is read, corners with equal coordinates become one vertex (-0.0 equals 0.0). Vertices are numbered in
//! the order of their first corners. Normals and names are ignored. A binary file has single precision, so writing
//! rounds positions. A text file is read in double precision.
//!
//! Complexity: O(n log n) in the number of triangles, for sorting their corners.

use super::mesh_data::{MeshData, check_single_precision, check_vertex_count};
use super::text::{Lines, parse_error, quoted, tokens};
use crate::error::{Error, Result};
use crate::mesh::attributes::ScalarType;
use rayon::slice::ParallelSliceMut;
use std::io::{self, Write};

const HEADER_BYTES: usize = 80;
/// Number of bytes of the header and the count of triangles.
const PREFIX_BYTES: usize = HEADER_BYTES + 4;
const FACET_BYTES: usize = 50;
const NORMAL_BYTES: usize = 12;
const CORNER_BYTES: usize = 12;

/// The header of written files. It must not begin with "solid", the first word of a text file.
const HEADER: &[u8; HEADER_BYTES] =
    b"binary STL written by holefill                                                  ";

/// Reads a file. It is binary if its size is exactly that for its count of triangles; otherwise it is text if it begins
/// like text.
pub(super) fn parse(bytes: &[u8]) -> Result<MeshData> {
    let size = bytes.len() as u64;
    match binary_size(bytes) {
        Some(promised) if promised == size => parse_binary(bytes),
        _ if looks_like_text(bytes) => parse_text(bytes),
        Some(promised) if promised < size => parse_binary(bytes),
        Some(promised) => Err(parse_error(format!(
            "byte {HEADER_BYTES}: a binary STL file of {} triangles has {promised} bytes, but this \
             file has {size}",
            facet_count(bytes).unwrap_or_default()
        ))),
        None => Err(parse_error(format!(
            "byte {size}: the file ends within the header of a binary STL file, and is not text"
        ))),
    }
}

fn facet_count(bytes: &[u8]) -> Option<u32> {
    bytes
        .get(HEADER_BYTES..)?
        .first_chunk()
        .copied()
        .map(u32::from_le_bytes)
}

/// The size of a binary file with the count of triangles in `bytes`.
fn binary_size(bytes: &[u8]) -> Option<u64> {
    Some(PREFIX_BYTES as u64 + u64::from(facet_count(bytes)?) * FACET_BYTES as u64)
}

/// Whether the first two lines are those of a text file. A binary header may begin with "solid", too, but it or the
/// count after it has a zero byte, unless there are 2^24 triangles or more.
fn looks_like_text(bytes: &[u8]) -> bool {
    if bytes.iter().take(PREFIX_BYTES).any(|&b| b == 0) {
        return false;
    }
    let mut lines = Lines::new(bytes);
    let mut next_word = || lines.next_filled(None).and_then(|line| tokens(line).next());
    let is_solid = next_word().is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let is_text =
        |word: &[u8]| word.eq_ignore_ascii_case(b"facet") || word.eq_ignore_ascii_case(b"endsolid");
    is_solid && next_word().is_none_or(is_text)
}

/// Reads a binary file, which must have at least the triangles of its count.
fn parse_binary(bytes: &[u8]) -> Result<MeshData> {
    let (facets, _) = bytes[PREFIX_BYTES..].as_chunks::<FACET_BYTES>();
    let facets = &facets[..facet_count(bytes).unwrap_or_default() as usize];
    let position = |corner: usize| {
        let start = NORMAL_BYTES + corner % 3 * CORNER_BYTES;
        let (words, _) = facets[corner / 3][start..start + CORNER_BYTES].as_chunks();
        [words[0], words[1], words[2]].map(f32::from_le_bytes)
    };
    let corner_count = facets.len() * 3;
    // Adding zero clears the sign of -0.0.
    let welded = weld(corner_count, |corner| {
        position(corner).map(|x| (x + 0.0).to_bits())
    })?;
    let mut mesh = welded.into_mesh(|corner| position(corner).map(f64::from));
    mesh.position_type = ScalarType::F32;
    let marked = facets
        .iter()
        .filter(|facet| facet[FACET_BYTES - 2..] != [0, 0])
        .count();
    if marked > 0 {
        mesh.notes.push(format!(
            "the attribute bytes of {marked} triangles left out"
        ));
    }
    let ignored = bytes.len() - PREFIX_BYTES - facets.len() * FACET_BYTES;
    if ignored > 0 {
        mesh.notes
            .push(format!("{ignored} bytes after the last triangle ignored"));
    }
    Ok(mesh)
}

fn parse_text(bytes: &[u8]) -> Result<MeshData> {
    let mut lines = Lines::new(bytes);
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut is_in_solid = false;
    while let Some(line) = lines.next_filled(None) {
        let keyword = tokens(line).next().unwrap_or_default();
        let is = |name: &[u8]| keyword.eq_ignore_ascii_case(name);
        if !is_in_solid && is(b"solid") {
            is_in_solid = true;
        } else if is_in_solid && is(b"endsolid") {
            is_in_solid = false;
        } else if is_in_solid && is(b"facet") {
            expect(&mut lines, "outer loop")?;
            for _ in 0..3 {
                corners.push(read_corner(&mut lines)?);
            }
            expect(&mut lines, "endloop")?;
            expect(&mut lines, "endfacet")?;
        } else {
            let wanted = if is_in_solid {
                "facet or endsolid"
            } else {
                "solid"
            };
            return Err(unexpected(&lines, line, wanted));
        }
    }
    if is_in_solid {
        return Err(lines.end_error("endsolid is missing"));
    }
    let welded = weld(corners.len(), |corner| {
        corners[corner].map(|x| (x + 0.0).to_bits())
    })?;
    Ok(welded.into_mesh(|corner| corners[corner]))
}

fn read_corner(lines: &mut Lines) -> Result<[f64; 3]> {
    let line = lines
        .next_filled(None)
        .ok_or_else(|| lines.end_error("a vertex is missing"))?;
    let mut words = tokens(line);
    if !words
        .next()
        .is_some_and(|word| word.eq_ignore_ascii_case(b"vertex"))
    {
        return Err(unexpected(lines, line, "vertex"));
    }
    let position = lines.position_from(&mut words)?;
    match words.next() {
        None => Ok(position),
        Some(_) => Err(lines.error("a vertex has three coordinates")),
    }
}

/// Reads a line that must consist of the words of `wanted`.
fn expect(lines: &mut Lines, wanted: &str) -> Result<()> {
    let missing = || lines.clone().end_error(format!("{wanted} is missing"));
    let line = lines.clone().next_filled(None).ok_or_else(missing)?;
    lines.next_filled(None);
    let is_equal = tokens(line)
        .map(<[u8]>::to_ascii_lowercase)
        .eq(tokens(wanted.as_bytes()).map(<[u8]>::to_vec));
    if is_equal {
        Ok(())
    } else {
        Err(unexpected(lines, line, wanted))
    }
}

fn unexpected(lines: &Lines, line: &[u8], wanted: &str) -> Error {
    lines.error(format!(
        "{} where {wanted} should be",
        quoted(line.trim_ascii())
    ))
}

/// Corners of triangles, joined to vertices.
struct Welded {
    triangles: Vec<[u32; 3]>,
    /// The first corner of each vertex, in ascending order.
    first_corners: Vec<u32>,
}

/// Joins corners with equal keys to one vertex.
fn weld<K: Ord + Copy + Send>(count: usize, key: impl Fn(usize) -> K) -> Result<Welded> {
    check_vertex_count(count)?;
    let mut sorted: Vec<(K, u32)> = (0..count)
        .map(|corner| (key(corner), corner as u32))
        .collect();
    sorted.par_sort_unstable();
    // For each corner: at first the first corner with the same key, later the number of its vertex.
    let mut vertices = vec![0; count];
    for equal in sorted.chunk_by(|a, b| a.0 == b.0) {
        for &(_, corner) in equal {
            vertices[corner as usize] = equal[0].1;
        }
    }
    drop(sorted);
    let mut first_corners = Vec::new();
    for corner in 0..count {
        let first = vertices[corner];
        vertices[corner] = if first as usize == corner {
            first_corners.push(first);
            first_corners.len() as u32 - 1
        } else {
            vertices[first as usize]
        };
    }
    Ok(Welded {
        triangles: vertices.as_chunks().0.to_vec(),
        first_corners,
    })
}

impl Welded {
    fn into_mesh(self, position: impl Fn(usize) -> [f64; 3]) -> MeshData {
        let positions: Vec<_> = self
            .first_corners
            .iter()
            .map(|&corner| position(corner as usize))
            .collect();
        let corner_count = 3 * self.triangles.len();
        let note = format!(
            "the {corner_count} corners of the STL file joined to {} vertices by equal coordinates",
            positions.len()
        );
        MeshData {
            notes: vec![note],
            ..MeshData::new(positions, self.triangles)
        }
    }
}

/// Refuses a mesh that the format cannot hold.
pub(super) fn check(mesh: &MeshData) -> Result<()> {
    check_single_precision(mesh)?;
    match u32::try_from(mesh.triangles.len()) {
        Ok(_) => Ok(()),
        Err(_) => Err(Error::invalid(
            "an STL file cannot hold that many triangles",
        )),
    }
}

/// A note on the number of vertices that single precision does not represent exactly.
pub(super) fn rounding_note(mesh: &MeshData) -> Option<String> {
    let is_rounded = |p: &&[f64; 3]| p.iter().any(|&x| f64::from(x as f32) != x && !x.is_nan());
    let count = mesh.positions.iter().filter(is_rounded).count();
    (count > 0).then(|| {
        format!("{count} vertices rounded, as binary STL stores coordinates in single precision")
    })
}

/// Writes `mesh`, which has passed [`check`]. The normal of a triangle without area is zero.
pub(super) fn write(mesh: &MeshData, out: &mut impl Write) -> io::Result<()> {
    out.write_all(HEADER)?;
    out.write_all(&(mesh.triangles.len() as u32).to_le_bytes())?;
    for triangle in &mesh.triangles {
        let corners = triangle.map(|v| mesh.positions[v as usize]);
        let [a, b, c] = corners.map(crate::math::Vec3::from);
        let normal = crate::math::unit(crate::math::cross_normal(&a, &b, &c));
        for [x, y, z] in [normal.into(), corners[0], corners[1], corners[2]] {
            for value in [x, y, z] {
                out.write_all(&(value as f32).to_le_bytes())?;
            }
        }
        out.write_all(&[0, 0])?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;
    use std::collections::BTreeMap;

    /// A binary file of triangles with the given corners and attribute bytes.
    fn binary(header: &[u8], facets: &[([[f32; 3]; 3], u16)]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(HEADER_BYTES, 0);
        bytes.extend((facets.len() as u32).to_le_bytes());
        for (corners, attribute) in facets {
            bytes.extend([0; NORMAL_BYTES]);
            corners
                .as_flattened()
                .iter()
                .for_each(|x| bytes.extend(x.to_le_bytes()));
            bytes.extend(attribute.to_le_bytes());
        }
        bytes
    }

    const FACETS: [([[f32; 3]; 3], u16); 2] = [
        ([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]], 0),
        ([[0.0, 1.0, 1.0], [1.0, -0.0, 1.0], [1.0, 1.0, 0.1]], 0),
    ];

    #[test]
    fn equal_corners_become_one_vertex_in_order_of_appearance() {
        let mesh = parse(&binary(b"x", &FACETS)).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(mesh.positions[3], [1.0, 1.0, f64::from(0.1f32)]);
        assert_eq!(mesh.position_type, ScalarType::F32);
        assert_eq!(mesh.notes.len(), 1);
    }

    #[test]
    fn a_binary_file_may_say_solid() {
        for header in [
            b"solid part".as_slice(),
            b"solid\nfacet",
            &[b' '; HEADER_BYTES],
        ] {
            let mut bytes = binary(header, &FACETS);
            assert_eq!(parse(&bytes).unwrap().triangles.len(), 2);
            bytes.pop();
            let error = parse(&bytes).unwrap_err();
            assert!(
                error
                    .message()
                    .starts_with("byte 80: a binary STL file of 2"),
                "{error}"
            );
        }
    }

    #[test]
    fn attribute_bytes_and_padding_are_noted() {
        let mut facets = FACETS;
        facets[1].1 = 7;
        let mut bytes = binary(b"", &facets);
        bytes.extend([1, 2, 3]);
        let mesh = parse(&bytes).unwrap();
        assert_eq!(mesh.triangles.len(), 2);
        assert_eq!(mesh.notes.len(), 3);
    }

    #[test]
    fn a_promise_of_more_triangles_than_bytes_is_an_error() {
        let mut bytes = binary(b"", &FACETS);
        bytes[HEADER_BYTES..PREFIX_BYTES].copy_from_slice(&u32::MAX.to_le_bytes());
        assert_eq!(parse(&bytes).unwrap_err().kind(), ErrorKind::Parse);
        assert_eq!(parse(&bytes[..50]).unwrap_err().kind(), ErrorKind::Parse);
    }

    const TEXT: &str = "solid a b\n facet normal 0 0 1\n  OUTER loop\n   vertex 0 0 0.1\n   \
                        vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid a b\n\
                        solid\nendsolid\n";

    #[test]
    fn text_is_read_in_double_precision() {
        for text in [
            TEXT.to_owned(),
            TEXT.replace('\n', "\r\n"),
            format!("\n{TEXT}"),
        ] {
            let mesh = parse(text.as_bytes()).unwrap();
            assert_eq!(mesh.triangles, [[0, 1, 2]]);
            assert_eq!(mesh.positions[0][2], 0.1);
            assert_eq!(mesh.position_type, ScalarType::F64);
        }
        assert!(parse(b"solid\nendsolid\n").unwrap().positions.is_empty());
    }

    #[test]
    fn broken_text_is_an_error_at_its_line() {
        let cases = [
            (
                "outer",
                "inner",
                "line 3: \"INNER loop\" where outer loop should be",
            ),
            ("1 0 0", "1 0", "line 5: z is missing"),
            ("1 0 0", "1 0 x", "line 5: z cannot be \"x\""),
            ("1 0 0", "1 0 0 0", "line 5: a vertex has three coordinates"),
            (
                "   vertex 0 1 0\n",
                "",
                "line 6: \"endloop\" where vertex should be",
            ),
            (
                " endfacet\n",
                "",
                "line 8: \"endsolid a b\" where endfacet should be",
            ),
            (
                "solid\nendsolid\n",
                "solid",
                "the file ends after line 10: endsolid is missing",
            ),
            (
                "solid\nendsolid\n",
                "more",
                "line 10: \"more\" where solid should be",
            ),
        ];
        for (from, to, start) in cases {
            let text = TEXT.replace("OUTER", "outer").replace(from, to);
            let text = text.replace("inner", "INNER");
            let error = parse(text.as_bytes()).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Parse);
            assert!(
                error.message().starts_with(start),
                "{from:?} -> {to:?} gives {error}"
            );
        }
        for text in ["solid", "   ", "facet"] {
            assert_eq!(parse(text.as_bytes()).unwrap_err().kind(), ErrorKind::Parse);
        }
    }

    #[test]
    fn welding_agrees_with_a_map() {
        let keys: Vec<u32> = (0..3000u32)
            .map(|k| k.wrapping_mul(2654435761) >> 22)
            .collect();
        let welded = weld(keys.len(), |corner| keys[corner]).unwrap();
        let mut numbers = BTreeMap::new();
        for (corner, key) in keys.iter().enumerate() {
            let next = numbers.len() as u32;
            let number = *numbers.entry(key).or_insert(next);
            assert_eq!(welded.triangles[corner / 3][corner % 3], number);
        }
        assert_eq!(welded.first_corners.len(), numbers.len());
    }

    #[test]
    fn rounded_vertices_are_counted_and_overflow_is_refused() {
        let mesh = MeshData::new(vec![[0.1, 0.0, 0.0], [0.5, f64::NAN, -0.0]], Vec::new());
        assert!(rounding_note(&mesh).unwrap().starts_with("1 vertices"));
        assert!(check(&mesh).is_ok());
        let mesh = MeshData::new(vec![[0.0, 1e39, 0.0]], Vec::new());
        assert_eq!(check(&mesh).unwrap_err().kind(), ErrorKind::InvalidInput);
    }
}
