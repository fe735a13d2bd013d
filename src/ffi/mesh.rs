//! Meshes: made from arrays or a polyline, and read.

use super::attributes::NamedColumns;
use super::guard::{Failure, guard, guard_free};
use super::memory::{
    blank, invalid, null, read_indices, read_points, write, write_indices, write_points,
    write_struct,
};
use super::objects::{MESH, Object, free, keep, with_mesh};
use super::status::{
    HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, HOLEFILL_STATUS_NOT_FINITE, HOLEFILL_STATUS_OK,
    HolefillStatus,
};
use super::types::{
    HolefillDefects, HolefillError, HolefillInput, HolefillMesh, HolefillMeshInfo, HolefillOutput,
};
use crate::fill::session::FillSession;
use crate::mesh::trimesh::TriMesh;

/// A mesh that C has a handle of.
pub(super) struct MeshObject {
    pub(super) session: FillSession,
    /// Vertices and triangles that it was made with.
    input: [usize; 2],
    /// The attributes of the vertices and of the triangles.
    pub(super) attributes: [Vec<NamedColumns>; 2],
}

impl MeshObject {
    pub(super) fn new(session: FillSession) -> Self {
        let mesh = session.mesh();
        Self {
            input: [mesh.positions().len(), mesh.triangles().len()],
            attributes: [Vec::new(), Vec::new()],
            session,
        }
    }
}

/// The first point that is not finite.
fn check_finite(points: &[[f64; 3]], what: &str) -> Result<(), Failure> {
    match points.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        Some(i) => Err(Failure::new(
            HOLEFILL_STATUS_NOT_FINITE,
            format!("row {i} of {what} is not finite"),
        )),
        None => Ok(()),
    }
}

/// Copies points that must be finite.
///
/// # Safety
/// `input` is null or describes memory of the caller.
pub(super) unsafe fn read_finite(
    input: *const HolefillInput,
    what: &str,
) -> Result<Vec<[f64; 3]>, Failure> {
    // SAFETY: the caller's promise.
    let points = unsafe { read_points(input, what)? };
    check_finite(&points, what)?;
    Ok(points)
}

/// As [`read_finite`]; nothing for a null pointer.
///
/// # Safety
/// As [`read_finite`].
pub(super) unsafe fn read_optional(
    input: *const HolefillInput,
    what: &str,
) -> Result<Option<Vec<[f64; 3]>>, Failure> {
    if input.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    unsafe { read_finite(input, what) }.map(Some)
}

/// Keeps a mesh that was made and tells its handle.
///
/// # Safety
/// `place` is null or points to a handle.
pub(super) unsafe fn hand_out(
    object: MeshObject,
    place: *mut HolefillMesh,
) -> Result<HolefillStatus, Failure> {
    if place.is_null() {
        return Err(null("mesh"));
    }
    let id = keep(Object::mesh(object))?;
    // SAFETY: not null, and the caller's promise.
    unsafe { write(place, HolefillMesh { id }, "mesh")? };
    Ok(HOLEFILL_STATUS_OK)
}

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
/// `positions`: rows of three, `float` or `double`. `triangles`: rows of three vertex indices from 0, `uint32_t` or
/// `uint64_t`. Vertices and triangles keep their order, their indices and, in double precision, their bits. Non-manifold
/// edges, isolated vertices, duplicate and degenerate triangles and mixed orientation are kept: see
/// `holefill_mesh_defects`. `mesh` gets the handle.
///
/// Time and memory are linear in the size of the mesh.
///
/// Statuses: `NULL_POINTER`, `INVALID_ARGUMENT` (type, stride, more than about 10^9 triangles), `OVERFLOW`, `NOT_FINITE`,
/// `INDEX_OUT_OF_RANGE`, `OUT_OF_MEMORY`, `LIMIT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_from_arrays(
    positions: *const HolefillInput,
    triangles: *const HolefillInput,
    mesh: *mut HolefillMesh,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        if mesh.is_null() {
            return Err(null("mesh"));
        }
        // SAFETY: the caller's promise.
        let points = unsafe { read_points(positions, "positions")? };
        // SAFETY: as above.
        let faces = unsafe { read_indices::<3>(triangles, "triangles")? };
        let vertex_count = points.len();
        let built = TriMesh::new(points, faces).map_err(|e| {
            // The same again, to tell what it was; only what fails costs twice.
            // SAFETY: as above.
            let found = unsafe { read_points(positions, "positions") }
                .and_then(|points| check_finite(&points, "positions"))
                // SAFETY: as above.
                .and_then(|()| unsafe { read_indices::<3>(triangles, "triangles") })
                .and_then(|faces| check_indices(&faces, vertex_count));
            found.err().unwrap_or_else(|| e.into())
        })?;
        // SAFETY: as above.
        unsafe { hand_out(MeshObject::new(FillSession::new(built)), mesh) }
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
        if mesh.is_null() {
            return Err(null("mesh"));
        }
        // SAFETY: the caller's promise.
        let points = unsafe { read_finite(points, "points")? };
        // SAFETY: as above.
        let normals = unsafe { read_optional(normals, "normals")? };
        let session = FillSession::from_polyline(points, normals.as_deref())?;
        // SAFETY: as above.
        unsafe { hand_out(MeshObject::new(session), mesh) }
    })
}

/// Frees a mesh. The handle 0 is allowed. Calls of other threads that use the mesh right now go on undisturbed, and
/// its memory is freed when they are done. Plans and reports made with it stay.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_mesh_free(mesh: HolefillMesh) -> HolefillStatus {
    guard_free(|| free(MESH, mesh.id))
}

/// The size of a mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_info(
    mesh: HolefillMesh,
    info: *mut HolefillMeshInfo,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            let mesh = object.session.mesh();
            let value = HolefillMeshInfo {
                vertex_count: mesh.positions().len() as u64,
                triangle_count: mesh.triangles().len() as u64,
                input_vertex_count: object.input[0] as u64,
                input_triangle_count: object.input[1] as u64,
                undo_count: object.session.undo_count() as u64,
                is_polyline: object.session.is_polyline().into(),
                ..blank()
            };
            // SAFETY: the caller's promise.
            unsafe { write_struct(info, &value, "info")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// What was irregular in a mesh when it was made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_defects(
    mesh: HolefillMesh,
    defects: *mut HolefillDefects,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            let found = object.session.mesh().defects();
            let value = HolefillDefects {
                nonmanifold_edges: found.nonmanifold_edges.count as u64,
                inconsistent_edges: found.inconsistent_edges.count as u64,
                degenerate_triangles: found.degenerate_faces.count as u64,
                duplicate_triangles: found.duplicate_faces.count as u64,
                isolated_vertices: found.isolated_vertices.count as u64,
                ..blank()
            };
            // SAFETY: the caller's promise.
            unsafe { write_struct(defects, &value, "defects")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// Finds the loops and indexes the mesh for the intersection tests now. The first function that needs them does it
/// otherwise, and takes that much longer: time linear in the size of the mesh. After it the time of a fill follows
/// the holes that it fills and not the mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_prepare(
    mesh: HolefillMesh,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            object.session.prepare();
            Ok(HOLEFILL_STATUS_OK)
        })
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
    guard(error, || {
        with_mesh(mesh.id, |object| {
            let positions = object.session.mesh().positions();
            // SAFETY: the caller's promise.
            unsafe { write_points(output, first, positions)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// Copies the vertex indices of the triangles from `first` on: `output` has rows of three, `uint32_t` or `uint64_t`, as
/// many as are wanted.
///
/// Statuses: `NOT_FOUND` when the mesh has fewer triangles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_read_triangles(
    mesh: HolefillMesh,
    first: u64,
    output: *const HolefillOutput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            let triangles = object.session.mesh().triangles();
            // SAFETY: the caller's promise.
            unsafe { write_indices(output, first, triangles)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// The id as an index; none of the library's lists is longer than the address space.
pub(super) fn index(id: u64, what: &str) -> Result<usize, Failure> {
    usize::try_from(id).map_err(|_| invalid(format!("there is no {what} {id}")))
}
