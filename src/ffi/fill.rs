//! Filling holes.

use super::callbacks::Callbacks;
use super::guard::{Failure, guard};
use super::loops::{loop_of_edge, loops_of_vertices, read_selection};
use super::memory::{read_ids, write};
use super::mesh::index;
use super::objects::{Object, keep, with_mesh_mut};
use super::options::read_options;
use super::status::{
    HOLEFILL_STATUS_INCOMPLETE, HOLEFILL_STATUS_NOT_FOUND, HOLEFILL_STATUS_NOTHING_TO_UNDO,
    HOLEFILL_STATUS_OK, HolefillStatus,
};
use super::types::{
    HolefillError, HolefillFillOptions, HolefillInput, HolefillMesh, HolefillReport,
    HolefillSelection,
};
use crate::boundary::select::Selection;
use crate::fill::options::FillOptions;
use crate::fill::progress::{Progress, ProgressCallback};
use crate::fill::report::{FillReport, HoleStatus};
use crate::fill::session::{FillSession, Target};

/// Which holes a call is about, as the caller names them.
pub(super) enum Holes {
    Loop(u64),
    Edge(u64, u64),
    Vertices(*const HolefillInput),
    Loops(*const HolefillInput),
    Selected(*const HolefillSelection),
}

impl Holes {
    /// Reads what the caller points to and finds it in the mesh. That loops exist is checked here, since it is a
    /// status of its own.
    ///
    /// # Safety
    /// The pointers are as the exported functions say.
    pub(super) unsafe fn find(self, session: &FillSession) -> Result<Wish, Failure> {
        let ids = match self {
            Self::Loop(id) => vec![index(id, "loop")?],
            Self::Edge(from, to) => vec![loop_of_edge(session, from, to)?],
            // SAFETY: the caller's promise.
            Self::Vertices(vertices) => unsafe { loops_of_vertices(session, vertices)? },
            // SAFETY: the caller's promise.
            Self::Loops(loops) => unsafe { read_ids(loops, "loops")? },
            Self::Selected(selection) => {
                // SAFETY: the caller's promise.
                return Ok(Wish::Selected(unsafe { read_selection(selection)? }));
            }
        };
        let count = session.boundary().loops.len();
        match ids.iter().find(|&&id| id >= count) {
            Some(id) => Err(Failure::new(
                HOLEFILL_STATUS_NOT_FOUND,
                format!("there is no loop {id} among {count}"),
            )),
            None => Ok(Wish::Loops(ids)),
        }
    }
}

/// Which holes a call is about, found.
pub(super) enum Wish {
    Loops(Vec<usize>),
    Selected(Selection),
}

impl Wish {
    pub(super) fn target(&self) -> Target<'_> {
        match self {
            Self::Loops(ids) => Target::Loops(ids),
            Self::Selected(selection) => Target::Selected(selection),
        }
    }
}

/// Whether a report says that something that was asked for was not done.
pub(super) fn status_of(report: &FillReport) -> HolefillStatus {
    let is_open = |s: HoleStatus| matches!(s, HoleStatus::Failed | HoleStatus::Cancelled);
    match report.holes.iter().any(|h| is_open(h.status)) {
        true => HOLEFILL_STATUS_INCOMPLETE,
        false => HOLEFILL_STATUS_OK,
    }
}

/// Calls `work` with the options and the callback that it takes.
pub(super) fn with_callback<R>(
    options: FillOptions,
    callbacks: &Callbacks,
    work: impl FnOnce(&FillOptions, Option<ProgressCallback<'_>>) -> R,
) -> R {
    let tell = |progress: Progress| callbacks.tell(progress);
    let callback: Option<ProgressCallback<'_>> = match callbacks.has_progress() {
        true => Some(&tell),
        false => None,
    };
    work(&options, callback)
}

/// Keeps a report if the caller wants it.
///
/// # Safety
/// `place` is null or points to a handle.
pub(super) unsafe fn hand_out(
    report: FillReport,
    place: *mut HolefillReport,
) -> Result<(), Failure> {
    if place.is_null() {
        return Ok(());
    }
    let id = keep(Object::Report(report))?;
    // SAFETY: not null, and the caller's promise.
    unsafe { write(place, HolefillReport { id }, "report") }
}

/// Fills holes of a mesh.
///
/// # Safety
/// The pointers are as the exported functions say.
unsafe fn fill(
    mesh: HolefillMesh,
    holes: Holes,
    options: *const HolefillFillOptions,
    report: *mut HolefillReport,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        // SAFETY: the caller's promise.
        let (options, callbacks) = unsafe { read_options(options)? };
        let (status, filled) = with_mesh_mut(mesh.id, |object| {
            let session = &mut object.session;
            // SAFETY: the caller's promise.
            let wish = unsafe { holes.find(session)? };
            let before = session.undo_count();
            let filled = with_callback(options, &callbacks, |options, progress| {
                session.fill(wish.target(), options, progress)
            })?;
            let status = status_of(&filled);
            // SAFETY: the caller's promise.
            if let Err(failure) = unsafe { hand_out(filled.clone(), report) } {
                if session.undo_count() > before {
                    session.undo();
                }
                return Err(failure);
            }
            Ok((status, filled))
        })?;
        callbacks.log(&filled);
        Ok(status)
    })
}

/// Fills the hole of the loop `loop_id`. Everything that was in the mesh stays bit for bit and keeps its index; new
/// vertices and triangles are appended, oriented like those round the hole.
///
/// `options` may be null. `report` may be null; otherwise it gets a report with one entry, which says what was appended.
///
/// Statuses: `INCOMPLETE` when the hole stays open: nothing was changed, and the report says why; `NOT_FOUND`;
/// `INVALID_ARGUMENT` for a loop that was closed before or an option that is not allowed; `TOPOLOGY` for a loop that
/// cannot be filled; `CANCELLED`; `BUSY`. With any but `OK` and `INCOMPLETE` nothing was changed and no report written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_fill_loop(
    mesh: HolefillMesh,
    loop_id: u64,
    options: *const HolefillFillOptions,
    report: *mut HolefillReport,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { fill(mesh, Holes::Loop(loop_id), options, report, error) }
}

/// As `holefill_mesh_fill_loop`, for the loop through the boundary edge from vertex `from` to vertex `to`, as it runs in
/// its triangle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_fill_edge(
    mesh: HolefillMesh,
    from: u64,
    to: u64,
    options: *const HolefillFillOptions,
    report: *mut HolefillReport,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { fill(mesh, Holes::Edge(from, to), options, report, error) }
}

/// As `holefill_mesh_fill_loops`, for the loops that the closed chain `vertices` consists of: see
/// `holefill_mesh_find_vertices`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_fill_vertices(
    mesh: HolefillMesh,
    vertices: *const HolefillInput,
    options: *const HolefillFillOptions,
    report: *mut HolefillReport,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { fill(mesh, Holes::Vertices(vertices), options, report, error) }
}

/// As `holefill_mesh_fill_loop`, for several loops: `loops` has rows of one id, `uint32_t` or `uint64_t`. They are filled
/// in parallel and appended in the order of their ids; an island together with the loop that it lies in, if both are
/// named. The report has an entry for each loop. A hole that stays open does not keep the others from being filled.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_fill_loops(
    mesh: HolefillMesh,
    loops: *const HolefillInput,
    options: *const HolefillFillOptions,
    report: *mut HolefillReport,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { fill(mesh, Holes::Loops(loops), options, report, error) }
}

/// As `holefill_mesh_fill_loops`, for all open loops that the rules choose; with `selection` null for all open loops. The
/// report has an entry for every loop of the mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_fill_selected(
    mesh: HolefillMesh,
    selection: *const HolefillSelection,
    options: *const HolefillFillOptions,
    report: *mut HolefillReport,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { fill(mesh, Holes::Selected(selection), options, report, error) }
}

/// Takes the last fill or apply back that appended something: its vertices, triangles and attribute values are removed,
/// and its loops are open again. May be called again for the one before. Time follows what is removed.
///
/// Statuses: `NOTHING_TO_UNDO`, `BUSY`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_undo(
    mesh: HolefillMesh,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_mesh_mut(mesh.id, |object| match object.session.undo() {
            true => Ok(HOLEFILL_STATUS_OK),
            false => Err(Failure::of(HOLEFILL_STATUS_NOTHING_TO_UNDO)),
        })
    })
}
