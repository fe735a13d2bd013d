//! Boundary loops: counted, described, found and chosen.

use super::guard::{Failure, guard};
use super::memory::{
    blank, null, read_indices, read_optional_indices, read_struct, write, write_ids, write_indices,
    write_struct,
};
use super::mesh::MeshObject;
use super::objects::with_mesh;
use super::status::{
    HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, HOLEFILL_STATUS_NOT_FOUND, HOLEFILL_STATUS_OK,
    HolefillStatus,
};
use super::types::{
    HOLEFILL_CLASS_ISLAND, HOLEFILL_CLASS_NOT_ORIENTED, HOLEFILL_CLASS_OPEN_CHAIN,
    HOLEFILL_CLASS_OUTER_RIM, HOLEFILL_CLASS_SIMPLE, HOLEFILL_CLASS_TOUCHING, HolefillClass,
    HolefillError, HolefillInput, HolefillLoopInfo, HolefillMesh, HolefillOutput,
    HolefillSelection,
};
use crate::boundary::classify::LoopClass;
use crate::boundary::loops::BoundaryLoop;
use crate::boundary::select::Selection;
use crate::fill::session::FillSession;

pub(super) fn class_number(class: LoopClass) -> HolefillClass {
    match class {
        LoopClass::Simple => HOLEFILL_CLASS_SIMPLE,
        LoopClass::Touching => HOLEFILL_CLASS_TOUCHING,
        LoopClass::Island => HOLEFILL_CLASS_ISLAND,
        LoopClass::OuterRim => HOLEFILL_CLASS_OUTER_RIM,
        LoopClass::NotOriented => HOLEFILL_CLASS_NOT_ORIENTED,
        LoopClass::OpenChain => HOLEFILL_CLASS_OPEN_CHAIN,
    }
}

fn find_loop(object: &MeshObject, id: u64) -> Result<&BoundaryLoop, Failure> {
    let loops = &object.session.boundary().loops;
    usize::try_from(id)
        .ok()
        .and_then(|id| loops.get(id))
        .ok_or_else(|| not_found(format!("there is no loop {id} among {}", loops.len())))
}

fn not_found(message: String) -> Failure {
    Failure::new(HOLEFILL_STATUS_NOT_FOUND, message)
}

/// Number of boundary loops that the mesh was made with. Their ids are the numbers below it. They keep them whatever is
/// filled or undone: a loop that a fill has closed stays in the list and says so in `is_open`.
///
/// The first call of a function that needs the loops finds them, in time linear in the boundary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_loop_count(
    mesh: HolefillMesh,
    count: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            let loops = object.session.boundary().loops.len();
            // SAFETY: the caller's promise.
            unsafe { write(count, loops as u64, "count")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// What a loop is.
///
/// Statuses: `NOT_FOUND`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_loop_info(
    mesh: HolefillMesh,
    loop_id: u64,
    info: *mut HolefillLoopInfo,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            let l = find_loop(object, loop_id)?;
            let value = HolefillLoopInfo {
                loop_id,
                edge_count: l.edge_count() as u64,
                vertex_count: l.vertices.len() as u64,
                edge: l.edge().map(u64::from),
                perimeter: l.perimeter,
                vector_area: l.vector_area,
                diameter: l.diameter,
                planarity: l.planarity,
                loop_class: class_number(l.class),
                is_open: object.session.is_open(l.id).into(),
                ..blank()
            };
            // SAFETY: the caller's promise.
            unsafe { write_struct(info, &value, "info")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// Copies the vertices of a loop from position `first` on, in the direction in which its triangles run: `output` has rows
/// of one, `uint32_t` or `uint64_t`, as many as are wanted.
///
/// Statuses: `NOT_FOUND` for no such loop or more vertices than it has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_read_loop(
    mesh: HolefillMesh,
    loop_id: u64,
    first: u64,
    output: *const HolefillOutput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            let (vertices, _) = find_loop(object, loop_id)?.vertices.as_chunks::<1>();
            // SAFETY: the caller's promise.
            unsafe { write_indices(output, first, vertices)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// The loop through the boundary edge from vertex `from` to vertex `to`, as it runs in its triangle.
///
/// Statuses: `NOT_FOUND`; the message says when the edge runs the other way.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_find_edge(
    mesh: HolefillMesh,
    from: u64,
    to: u64,
    loop_id: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            let id = loop_of_edge(&object.session, from, to)?;
            // SAFETY: the caller's promise.
            unsafe { write(loop_id, id as u64, "loop_id")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

pub(super) fn loop_of_edge(session: &FillSession, from: u64, to: u64) -> Result<usize, Failure> {
    let count = session.mesh().positions().len();
    let vertex = |v: u64| {
        u32::try_from(v)
            .ok()
            .filter(|&v| (v as usize) < count)
            .ok_or_else(|| {
                let message = format!("there is no vertex {v} among {count}");
                Failure::new(HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, message)
            })
    };
    let edge = [vertex(from)?, vertex(to)?];
    session
        .loop_with_edge(edge)
        .map_err(|e| not_found(e.to_string()))
}

/// The loops that the closed chain `vertices` consists of: rows of one, `uint32_t` or `uint64_t`, the last joined to the
/// first. It may start anywhere and run either way. Where it visits a vertex twice it passes through more than one loop:
/// loops are cut where the boundary touches itself.
///
/// `ids` gets the ids, ascending, and `count` their number, also when they do not fit into `capacity`. With `ids` null
/// and `capacity` 0 only the number is written.
///
/// Statuses: `NOT_FOUND` when the edges of the chain are not all edges of some loops, `BUFFER_TOO_SMALL`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_find_vertices(
    mesh: HolefillMesh,
    vertices: *const HolefillInput,
    ids: *mut u64,
    capacity: u64,
    count: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            // SAFETY: the caller's promise.
            let found = unsafe { loops_of_vertices(&object.session, vertices)? };
            // SAFETY: the caller's promise.
            unsafe { write_ids(&found, ids, capacity, count)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// # Safety
/// `vertices` is null or describes memory of the caller.
pub(super) unsafe fn loops_of_vertices(
    session: &FillSession,
    vertices: *const HolefillInput,
) -> Result<Vec<usize>, Failure> {
    // SAFETY: the caller's promise.
    let vertices = unsafe { read_indices::<1>(vertices, "vertices")? };
    session
        .loops_with_vertices(vertices.as_flattened())
        .map_err(|e| not_found(e.to_string()))
}

/// The loops that the rules choose among those that are open.
///
/// `selection` may be null: all open loops. `ids`, `capacity` and `count` as in `holefill_mesh_find_vertices`.
///
/// Statuses: `INVALID_ARGUMENT` when an edge of the rules is on no loop, `BUFFER_TOO_SMALL`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_select(
    mesh: HolefillMesh,
    selection: *const HolefillSelection,
    ids: *mut u64,
    capacity: u64,
    count: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh(mesh.id, |object| {
            // SAFETY: the caller's promise.
            let rules = unsafe { read_selection(selection)? };
            let session = &object.session;
            let kept = rules.reasons_to_keep(session.boundary())?;
            let chosen: Vec<usize> = (0..kept.len())
                .filter(|&id| kept[id].is_none() && session.is_open(id))
                .collect();
            // SAFETY: the caller's promise.
            unsafe { write_ids(&chosen, ids, capacity, count)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// # Safety
/// `selection` is null or points to a struct as its first fields say, whose pointers are the caller's.
pub(super) unsafe fn read_selection(
    selection: *const HolefillSelection,
) -> Result<Selection, Failure> {
    // SAFETY: the caller's promise.
    let Some(rules) = (unsafe { read_struct(selection, "selection")? }) else {
        return Ok(Selection::default());
    };
    // SAFETY: the caller's promise.
    let edges = |view: &HolefillInput, what| unsafe { read_optional_indices::<2>(view, what) };
    Ok(Selection {
        only: edges(&rules.only, "only")?,
        keep: edges(&rules.keep, "keep")?,
        max_edges: (rules.max_edges > 0)
            .then(|| usize::try_from(rules.max_edges).unwrap_or(usize::MAX)),
        max_perimeter: (rules.max_perimeter != 0.0).then_some(rules.max_perimeter),
        keep_largest: usize::try_from(rules.keep_largest).unwrap_or(usize::MAX),
    })
}

/// Makes `selection` one that chooses every open loop. `struct_size` is `sizeof(HolefillSelection)` of the caller.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_selection_init(
    selection: *mut HolefillSelection,
    struct_size: u32,
) -> HolefillStatus {
    guard(std::ptr::null_mut(), || {
        if selection.is_null() {
            return Err(null("selection"));
        }
        // SAFETY: not null, and the caller's promise.
        unsafe { super::memory::init_struct(selection, struct_size, "selection")? };
        Ok(HOLEFILL_STATUS_OK)
    })
}
