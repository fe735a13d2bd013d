//! Boundary loops: counted, described, found and chosen.

use super::failure::{Failure, not_found, nth};
use super::guard::guard_with;
use super::input::{read_indices, read_optional_indices};
use super::objects::MeshObject;
use super::output::{write, write_indices, write_list};
use super::status::{HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, HolefillStatus};
use super::structs::{read_struct, write_struct};
use super::types::*;
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
    nth(&object.session.boundary().loops, id, "loop")
}

/// Writes a list of ids and its length.
///
/// # Safety
/// As [`write_list`].
unsafe fn write_ids(
    found: &[usize],
    ids: *mut u64,
    capacity: u64,
    count: *mut u64,
) -> Result<(), Failure> {
    let found: Vec<u64> = found.iter().map(|&id| id as u64).collect();
    // SAFETY: the caller's promise.
    unsafe { write_list(&found, &[], (ids, capacity, "ids"), (count, "count")) }
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
    guard_with(mesh, error, |object| {
        let loops = object.session.boundary().loops.len();
        // SAFETY: the caller's promise.
        unsafe { write(count, loops as u64, "count") }
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
    guard_with(mesh, error, |object| {
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
            ..Default::default()
        };
        // SAFETY: the caller's promise.
        unsafe { write_struct(info, &value, "info") }
    })
}

/// Copies the vertices of a loop from position `first` on, in the direction in which its triangles run: `output` has rows
/// of one, of 32 or 64 bits, as many as are wanted.
///
/// Statuses: `NOT_FOUND` for no such loop or more vertices than it has; `LIMIT` for an index that the type has no room
/// for.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_read_loop(
    mesh: HolefillMesh,
    loop_id: u64,
    first: u64,
    output: *const HolefillOutput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        let (vertices, _) = find_loop(object, loop_id)?.vertices.as_chunks::<1>();
        // SAFETY: the caller's promise.
        unsafe { write_indices(output, first, vertices) }
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
    guard_with(mesh, error, |object| {
        let id = loop_of_edge(&object.session, [from, to])?;
        // SAFETY: the caller's promise.
        unsafe { write(loop_id, id as u64, "loop_id") }
    })
}

pub(super) fn loop_of_edge(session: &FillSession, edge: [u64; 2]) -> Result<usize, Failure> {
    let count = session.mesh().positions().len();
    if let Some(v) = edge.into_iter().find(|&v| v >= count as u64) {
        let message = format!("there is no vertex {v} among {count}");
        return Err(Failure::new(HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, message));
    }
    session
        .loop_with_edge(edge.map(|v| v as u32))
        .map_err(|e| not_found(e.to_string()))
}

/// The loops that the closed chain `vertices` consists of: rows of one, of 32 or 64 bits, the last joined to the first.
/// It may start anywhere and run either way. Where it visits a vertex twice it passes through more than one loop: loops
/// are cut where the boundary touches itself.
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
    guard_with(mesh, error, |object| {
        // SAFETY: the caller's promise.
        unsafe {
            let found = loops_of_vertices(&object.session, vertices)?;
            write_ids(&found, ids, capacity, count)
        }
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
    guard_with(mesh, error, |object| {
        // SAFETY: the caller's promise.
        let rules = unsafe { read_selection(selection)? };
        let session = &object.session;
        let kept = rules.reasons_to_keep(session.boundary())?;
        let chosen: Vec<usize> = (0..kept.len())
            .filter(|&id| kept[id].is_none() && session.is_open(id))
            .collect();
        // SAFETY: the caller's promise.
        unsafe { write_ids(&chosen, ids, capacity, count) }
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
