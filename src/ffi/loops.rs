//! Boundary loops: counted, described, found and chosen.

use super::failure::{Failure, invalid, invalid_struct, not_found, nth};
use super::guard::guard_with;
use super::input::{read_indices, read_optional_indices};
use super::objects::MeshObject;
use super::output::{write, write_indices, write_list};
use super::status::{HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, HolefillStatus};
use super::structs::{read_struct, write_struct};
use super::types::*;
use crate::boundary::boundary_loop::BoundaryLoop;
use crate::boundary::boundary_loop::LoopClass;
use crate::boundary::select::Selection;
use crate::fill::session::{FillSession, Target};

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

fn loop_of_edge(session: &FillSession, edge: [u64; 2]) -> Result<usize, Failure> {
    let count = session.mesh().positions().len();
    if let Some(v) = edge.into_iter().find(|&v| v >= count as u64) {
        let message = format!("there is no vertex {v} among {count}");
        return Err(Failure::new(HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, message));
    }
    session
        .loop_with_edge(edge.map(|v| v as u32))
        .map_err(|e| not_found(e.to_string()))
}

/// The loops that `target` names, as `holefill_mesh_fill` takes it; null is every open loop.
///
/// `ids` gets the ids, ascending but for those that the target lists itself, and `count` their number, also when they do
/// not fit into `capacity`. With `ids` null and `capacity` 0 only the number is written.
///
/// Statuses: `NOT_FOUND` for a loop, an edge or a chain that the mesh does not have; for an edge that runs the other way
/// the message says so. `INVALID_ARGUMENT` for an unknown kind of target or an edge of the rules that is on no loop;
/// `BUFFER_TOO_SMALL`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_find_loops(
    mesh: HolefillMesh,
    target: *const HolefillTarget,
    ids: *mut u64,
    capacity: u64,
    count: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(mesh, error, |object| {
        let session = &object.session;
        // SAFETY: the caller's promise.
        let found = match unsafe { Wish::read(target, session)? } {
            Wish::Loops(ids) => ids,
            Wish::Selected(rules) => {
                let kept = rules.reasons_to_keep(session.boundary())?;
                let is_chosen = |&id: &usize| kept[id].is_none() && session.is_open(id);
                (0..kept.len()).filter(is_chosen).collect()
            }
        };
        let found: Vec<u64> = found.iter().map(|&id| id as u64).collect();
        // SAFETY: the caller's promise.
        unsafe { write_list(&found, &[], (ids, capacity, "ids"), (count, "count")) }
    })
}

/// Which holes a call is about, found in the mesh.
pub(super) enum Wish {
    Loops(Vec<usize>),
    Selected(Selection),
}

impl Wish {
    /// Reads what the caller points to, and finds it in the mesh. That a loop exists is checked here: it has a status of
    /// its own.
    ///
    /// # Safety
    /// `target` is null or points to a struct as its first fields say, whose pointers are the caller's.
    pub(super) unsafe fn read(
        target: *const HolefillTarget,
        session: &FillSession,
    ) -> Result<Self, Failure> {
        // SAFETY: the caller's promise.
        let Some(target) = (unsafe { read_struct(target, "target")? }) else {
            return Ok(Self::Selected(Selection::default()));
        };
        if target.reserved != 0 {
            return Err(invalid_struct(
                "target has a reserved field that is not zero",
            ));
        }
        let loops = &session.boundary().loops;
        // SAFETY: the caller's promise, for every pointer.
        unsafe {
            Ok(match target.kind {
                HOLEFILL_TARGET_SELECTED => Self::Selected(read_selection(target.selection)?),
                HOLEFILL_TARGET_LOOP => Self::Loops(vec![nth(loops, target.loop_id, "loop")?.id]),
                HOLEFILL_TARGET_EDGE => Self::Loops(vec![loop_of_edge(session, target.edge)?]),
                HOLEFILL_TARGET_VERTICES => {
                    let chain = read_indices::<1>(target.ids, "ids")?;
                    let found = session.loops_with_vertices(chain.as_flattened());
                    Self::Loops(found.map_err(|e| not_found(e.to_string()))?)
                }
                HOLEFILL_TARGET_LOOPS => {
                    let ids = read_indices::<1>(target.ids, "ids")?.into_iter();
                    let known = ids.map(|[id]| Ok(nth(loops, id.into(), "loop")?.id));
                    Self::Loops(known.collect::<Result<_, Failure>>()?)
                }
                kind => return Err(invalid(format!("there is no kind {kind} of target"))),
            })
        }
    }

    pub(super) fn target(&self) -> Target<'_> {
        match self {
            Self::Loops(ids) => Target::Loops(ids),
            Self::Selected(selection) => Target::Selected(selection),
        }
    }
}

/// # Safety
/// `selection` is null or points to a struct as its first fields say, whose pointers are the caller's.
unsafe fn read_selection(selection: *const HolefillSelection) -> Result<Selection, Failure> {
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
