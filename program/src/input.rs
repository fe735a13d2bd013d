//! Reads a mesh file, and measures the time.

use crate::{Failure, console};
use holefill::io::{self, MeshData};
use holefill::{BoundaryLoops, TriMesh};
use std::path::Path;
use std::time::Instant;

/// A mesh with its boundary, and the other contents of its file.
pub(crate) struct Loaded {
    pub(crate) mesh: TriMesh,
    pub(crate) boundary: BoundaryLoops,
    /// The rest of the file: its arrays have moved to `mesh`.
    pub(crate) file: MeshData,
    pub(crate) seconds: LoadSeconds,
}

/// Seconds that the steps of loading took.
#[derive(Clone, Copy)]
pub(crate) struct LoadSeconds {
    pub(crate) read: f64,
    pub(crate) build: f64,
    pub(crate) loops: f64,
}

/// Reads the file at `path`. Prints notes about the file unless `quiet`.
pub(crate) fn read(path: &Path, quiet: bool) -> Result<MeshData, Failure> {
    let data = io::read(path).map_err(|e| Failure::file(e.to_string()))?;
    if !quiet {
        console::notes(&data.notes);
    }
    Ok(data)
}

/// Reads the file at `path`, builds the mesh and finds its boundary loops. Prints notes about the file
/// and the defects of the mesh unless `quiet`.
pub(crate) fn load(path: &Path, quiet: bool) -> Result<Loaded, Failure> {
    let start = Instant::now();
    let mut file = read(path, quiet)?;
    let read = seconds_since(start);

    let start = Instant::now();
    let mesh = TriMesh::with_attributes(
        std::mem::take(&mut file.positions),
        std::mem::take(&mut file.triangles),
        std::mem::take(&mut file.vertex_attributes),
        std::mem::take(&mut file.face_attributes),
    )
    .map_err(|e| Failure::file(format!("{}: {e}", path.display())))?;
    let build = seconds_since(start);
    if !quiet {
        console::notes(&mesh.defects().summary());
    }

    let start = Instant::now();
    let boundary = BoundaryLoops::find(&mesh);
    let loops = seconds_since(start);
    Ok(Loaded {
        mesh,
        boundary,
        file,
        seconds: LoadSeconds { read, build, loops },
    })
}

pub(crate) fn seconds_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64()
}
