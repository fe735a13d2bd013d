//! Filling holes.

use super::failure::Failure;
use super::guard::guard;
use super::loops::Wish;
use super::objects::{MeshObject, Object, with_mesh_mut};
use super::options::read_options;
use super::output::hand_out;
use super::status::{
    HOLEFILL_STATUS_INCOMPLETE, HOLEFILL_STATUS_NOTHING_TO_UNDO, HOLEFILL_STATUS_OK, HolefillStatus,
};
use super::types::*;
use crate::fill::report::{FillReport, HoleStatus};
use crate::fill::session::FillSession;
use std::ptr;

/// Whether a report says that something that was asked for was not done.
pub(super) fn status_of(report: &FillReport) -> HolefillStatus {
    let is_open = |s: HoleStatus| matches!(s, HoleStatus::Failed | HoleStatus::Cancelled);
    match report.holes.iter().any(|h| is_open(h.status)) {
        true => HOLEFILL_STATUS_INCOMPLETE,
        false => HOLEFILL_STATUS_OK,
    }
}

/// Changes a mesh by `work`, and hands out the report if the caller wants it. When that fails the mesh is as before.
///
/// # Safety
/// `place` is null or points to a handle.
pub(super) unsafe fn change(
    object: &mut MeshObject,
    place: *mut HolefillReport,
    work: impl FnOnce(&mut FillSession) -> Result<FillReport, Failure>,
) -> Result<FillReport, Failure> {
    let session = &mut object.session;
    let before = session.undo_count();
    let report = work(session)?;
    if !place.is_null() {
        let kept = Object::Report(report.clone());
        // SAFETY: the caller's promise.
        if let Err(failure) = unsafe { hand_out(kept, place, "report") } {
            if session.undo_count() > before {
                session.undo();
            }
            return Err(failure);
        }
    }
    Ok(report)
}

/// Fills holes. Everything that was in the mesh stays bit for bit and keeps its index. New vertices and triangles are
/// appended, oriented like those round the hole.
///
/// `target` says which holes; null is every open loop. They are filled in parallel and appended in the order of the ids of
/// their loops. An island is filled together with the loop that it lies in, if both are asked for. A hole that stays open
/// does not keep the others from being filled.
///
/// `options` may be null. `report` may be null; otherwise it gets what happened: an entry for each loop that was named, or,
/// for `HOLEFILL_TARGET_SELECTED`, for every loop of the mesh.
///
/// Statuses: `INCOMPLETE` when a hole stays open that was asked for: the report says why; `NOT_FOUND` for a loop, an edge
/// or a chain that the mesh does not have; `INVALID_ARGUMENT` for a loop that was closed before, an option that is not
/// allowed, an unknown kind of target or an edge of the rules that is on no loop; `TOPOLOGY` for a loop that cannot be
/// filled; `CANCELLED`; `BUSY`. With any but `OK` and `INCOMPLETE` nothing was changed and no report written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_fill(
    mesh: HolefillMesh,
    target: *const HolefillTarget,
    options: *const HolefillFillOptions,
    report: *mut HolefillReport,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        // SAFETY: the caller's promise.
        let (options, callbacks) = unsafe { read_options(options)? };
        let fill = |session: &mut FillSession| {
            // SAFETY: the caller's promise.
            let wish = unsafe { Wish::read(target, session)? };
            Ok(callbacks
                .with_progress(|progress| session.fill(wish.target(), &options, progress))?)
        };
        // SAFETY: the caller's promise.
        let filled = with_mesh_mut(mesh, |object| unsafe { change(object, report, fill) })?;
        callbacks.log(&filled);
        Ok(status_of(&filled))
    })
}

/// Fills every open loop with the default options: `holefill_mesh_fill` with null for everything else.
///
/// Statuses: as `holefill_mesh_fill`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_fill_all(
    mesh: HolefillMesh,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise, and null is allowed.
    unsafe { holefill_mesh_fill(mesh, ptr::null(), ptr::null(), ptr::null_mut(), error) }
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
        with_mesh_mut(mesh, |object| match object.session.undo() {
            true => Ok(()),
            false => Err(Failure::of(HOLEFILL_STATUS_NOTHING_TO_UNDO)),
        })
    })
}
