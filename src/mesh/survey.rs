//! The first pass over the triangles of a mesh. It checks the indices, records degenerate triangles and unused
//! vertices, and finds the range of vertices of each chunk of triangles. Linear, in parallel.

use super::defects::MeshDefects;
use super::halfedge::is_degenerate;
use crate::error::{Error, ErrorKind, Result};
use rayon::prelude::*;
use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of triangles in one chunk, which is one task.
pub(super) const FACE_CHUNK: usize = 1 << 14;

/// The findings on one chunk of [`FACE_CHUNK`] triangles.
#[derive(Debug)]
pub(super) struct FaceChunk {
    /// Lowest to highest vertex.
    pub(super) vertices: RangeInclusive<u32>,
    /// Triangles that name a vertex twice, ascending.
    pub(super) degenerate: Vec<u32>,
}

/// Examines all triangles, and records the degenerate ones and the unused vertices in `defects`.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] for the first triangle with a vertex that is not below `vertex_count`.
pub(super) fn survey(
    vertex_count: usize,
    triangles: &[[u32; 3]],
    defects: &mut MeshDefects,
) -> Result<Vec<FaceChunk>> {
    let unused = vec![false; vertex_count];
    let used: Vec<AtomicBool> = unused.into_iter().map(AtomicBool::new).collect();
    let looked: Vec<std::result::Result<FaceChunk, u32>> = triangles
        .par_chunks(FACE_CHUNK)
        .enumerate()
        .map(|(chunk, faces)| look((chunk * FACE_CHUNK) as u32, faces, &used))
        .collect();
    let chunks = looked
        .into_iter()
        .collect::<std::result::Result<Vec<_>, u32>>()
        .map_err(|face| out_of_range(vertex_count, triangles, face))?;
    for &face in chunks.iter().flat_map(|c| &c.degenerate) {
        defects.degenerate_faces.record(face);
    }
    for (v, used) in used.into_iter().enumerate() {
        if !used.into_inner() {
            defects.isolated_vertices.record(v as u32);
        }
    }
    Ok(chunks)
}

/// Looks at `faces`; fails with the first one that names a vertex beyond `used`.
fn look(
    first_face: u32,
    faces: &[[u32; 3]],
    used: &[AtomicBool],
) -> std::result::Result<FaceChunk, u32> {
    let (mut low, mut high) = (u32::MAX, 0);
    let mut degenerate = Vec::new();
    for (face, t) in (first_face..).zip(faces) {
        for &v in t {
            let used = used.get(v as usize).ok_or(face)?;
            // The value is read first, because threads that write to one cache line wait for each other.
            if !used.load(Ordering::Relaxed) {
                used.store(true, Ordering::Relaxed);
            }
            low = low.min(v);
            high = high.max(v);
        }
        if is_degenerate(t) {
            degenerate.push(face);
        }
    }
    Ok(FaceChunk {
        vertices: low..=high,
        degenerate,
    })
}

fn out_of_range(vertex_count: usize, triangles: &[[u32; 3]], face: u32) -> Error {
    let t = triangles[face as usize];
    let message =
        format!("triangle {face} names vertices {t:?}, but there are only {vertex_count}");
    Error::new(ErrorKind::InvalidInput, message)
}
