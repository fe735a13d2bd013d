//! Meshes: made from arrays or a polyline, and read.

use super::failure::{Failure, not_null};
use super::guard::{guard, guard_free, guard_with};
use super::input::{check_finite, read_finite, read_indices, read_optional, read_points};
use super::objects::Object;
use super::output::{hand_out, write_indices, write_points};
use super::status::{HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, HolefillStatus};
use super::structs::write_struct;
use super::types::*;
use crate::fill::session::FillSession;
use crate::mesh::trimesh::TriMesh;

fn check_indices(triangles: &[[u32; 3]], vertex_count: usize) -> Result<(), Failure> {
    let is_known = |t: &[u32; 3]| t.iter().all(|&v| (v as usize) < vertex_count);
    match triangles.iter().position(|t| !is_known(t)) {
        Some(i) => Err(Failure::new(
            HOLEFILL_STATUS_INDEX_OUT_OF_RANGE,
            format!(
                "triangle {i} is {:?}, but there are {vertex_count} vertices",
                triangles[i]
            ),
        )),
        None => Ok(()),
    }
}

/// Makes a mesh from copies of arrays.
///
/// `positions`: rows of three, `float` or `double`. `triangles`: rows of three vertex indices from 0, of 32
/// or 64 bits. Vertices and triangles keep their order, their indices and, in double precision, their bits. Non-manifold
/// edges, isolated vertices, duplicate and degenerate triangles and mixed orientation are kept: see
/// `holefill_mesh_defects`. `mesh` gets the handle.
///
/// Time and memory are linear in the size of the mesh.
///
/// Statuses: `NULL_POINTER`, `INVALID_ARGUMENT` (type, stride, a negative index, more than about 10^9 triangles), `OVERFLOW`, `NOT_FINITE`,
/// `INDEX_OUT_OF_RANGE`, `OUT_OF_MEMORY`, `LIMIT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_from_arrays(
    positions: *const HolefillInput,
    triangles: *const HolefillInput,
    mesh: *mut HolefillMesh,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        not_null(mesh.cast_const(), "mesh")?;
        // SAFETY: the caller's promise.
        let points = unsafe { read_points(positions, "positions")? };
        // SAFETY: as above.
        let faces = unsafe { read_indices::<3>(triangles, "triangles")? };
        let vertex_count = points.len();
        let built = TriMesh::new(points, faces).map_err(|e| {
            // The same again, to tell what it was. Only what fails costs twice.
            // SAFETY: as above.
            let found = unsafe { read_points(positions, "positions") }
                .and_then(|points| check_finite(&points, "positions"))
                // SAFETY: as above.
                .and_then(|()| unsafe { read_indices::<3>(triangles, "triangles") })
                .and_then(|faces| check_indices(&faces, vertex_count));
            found.err().unwrap_or_else(|| e.into())
        })?;
        // SAFETY: as above.
        unsafe { hand_out(Object::mesh(FillSession::new(built)), mesh, "mesh") }
    })
}

/// Makes a mesh of a closed polyline: its points as vertices, no triangles, and one loop with the id 0. Every function
/// takes it as it takes other meshes; a fill appends the patch.
///
/// `points`: rows of three, `float` or `double`, at least three; the last is joined to the first. The patch runs along
/// the polyline in its direction, counter-clockwise as seen from the side to which its normals point.
///
/// `normals` may be null. Otherwise it has a row of three for each point, of any length: the normals of the surface that
/// the patch is to go on from. A strip of surface perpendicular to them is supposed outside the polyline, and every
/// method meets it as it would meet a mesh. Without normals, or where one is zero or along the polyline, nothing is
/// known outside: `flat` and `membrane` do what they always do, and the fair methods give the patch of least energy
/// through the polyline, with no tangent plane prescribed.
///
/// Statuses: as `holefill_mesh_from_arrays`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_from_polyline(
    points: *const HolefillInput,
    normals: *const HolefillInput,
    mesh: *mut HolefillMesh,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        // SAFETY: the caller's promise.
        let points = unsafe { read_finite(points, "points")? };
        // SAFETY: as above.
        let normals = unsafe { read_optional(normals, "normals")? };
        let session = FillSession::from_polyline(points, normals.as_deref())?;
        // SAFETY: as above.
        unsafe { hand_out(Object::mesh(session), mesh, "mesh") }
    })
}

/// Frees a mesh. The handle 0 is allowed. Calls of other threads that use the mesh right now go on undisturbed, and
/// its memory is freed when they are done. Plans and reports made with it stay.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_mesh_free(mesh: HolefillMesh) -> HolefillStatus {
    guard_free(mesh)
}

/// The size of a mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_info(
    mesh: HolefillMesh,
    info: *mut HolefillMeshInfo,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        let mesh = object.session.mesh();
        let value = HolefillMeshInfo {
            vertex_count: mesh.positions().len() as u64,
            triangle_count: mesh.triangles().len() as u64,
            input_vertex_count: object.input[0] as u64,
            input_triangle_count: object.input[1] as u64,
            undo_count: object.session.undo_count() as u64,
            is_polyline: object.session.is_polyline().into(),
            ..Default::default()
        };
        // SAFETY: the caller's promise.
        unsafe { write_struct(info, &value, "info") }
    })
}

/// What was irregular in a mesh when it was made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_defects(
    mesh: HolefillMesh,
    defects: *mut HolefillDefects,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        let found = object.session.mesh().defects();
        let value = HolefillDefects {
            nonmanifold_edges: found.nonmanifold_edges.count as u64,
            inconsistent_edges: found.inconsistent_edges.count as u64,
            degenerate_triangles: found.degenerate_faces.count as u64,
            duplicate_triangles: found.duplicate_faces.count as u64,
            isolated_vertices: found.isolated_vertices.count as u64,
            ..Default::default()
        };
        // SAFETY: the caller's promise.
        unsafe { write_struct(defects, &value, "defects") }
    })
}

/// Finds the loops and indexes the mesh for the intersection tests, in time linear in the size of the mesh. Otherwise the
/// first function that needs them does it. After it the time of a fill follows the holes that it fills and not the mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_prepare(
    mesh: HolefillMesh,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        object.session.prepare();
        Ok(())
    })
}

/// Copies the positions of the vertices from `first` on: `output` has rows of three, `float` or `double`, as many as are
/// wanted.
///
/// Statuses: `NOT_FOUND` when the mesh has fewer vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_read_positions(
    mesh: HolefillMesh,
    first: u64,
    output: *const HolefillOutput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        // SAFETY: the caller's promise.
        unsafe { write_points(output, first, object.session.mesh().positions()) }
    })
}

/// Copies the vertex indices of the triangles from `first` on: `output` has rows of three, of 32 or 64 bits, as many as
/// are wanted.
///
/// Statuses: `NOT_FOUND` when the mesh has fewer triangles; `LIMIT` for an index that the type has no room for.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_read_triangles(
    mesh: HolefillMesh,
    first: u64,
    output: *const HolefillOutput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        // SAFETY: the caller's promise.
        unsafe { write_indices(output, first, object.session.mesh().triangles()) }
    })
}
