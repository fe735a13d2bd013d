//! Planning patches without changing the mesh, reading them, and applying them.

use super::failure::{Failure, not_null};
use super::fill::{change, status_of};
use super::guard::{guard, guard_free, guard_with};
use super::loops::Wish;
use super::objects::{Handle as _, Object, PlanObject, with_mesh_mut};
use super::options::read_options;
use super::output::{hand_out, write_indices, write_points};
use super::status::{HOLEFILL_STATUS_STALE_PLAN, HolefillStatus};
use super::structs::write_struct;
use super::types::*;
use crate::error::ErrorKind;
use crate::fill::session::FillSession;

/// Makes patches and leaves the mesh as it is. The patches can be read, in the mesh's vertex indices, and applied. Nothing
/// of the mesh is copied, and other threads may read the mesh meanwhile.
///
/// `target` and `options` as in `holefill_mesh_fill`. `plan` gets the handle.
///
/// Each patch is checked against the mesh, but not against the other patches of the plan: that is done when the plan is
/// applied. To get patches that fit each other without keeping them in the mesh, fill, read what was appended, and undo.
///
/// Statuses: as `holefill_mesh_fill`. With `INCOMPLETE` there is a plan that lacks patches, and its report says why.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_plan(
    mesh: HolefillMesh,
    target: *const HolefillTarget,
    options: *const HolefillFillOptions,
    plan: *mut HolefillPlan,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        not_null(plan.cast_const(), "plan")?;
        // SAFETY: the caller's promise.
        let (options, callbacks) = unsafe { read_options(options)? };
        let planned = mesh.with(|object| {
            let session = &object.session;
            // SAFETY: the caller's promise.
            let wish = unsafe { Wish::read(target, session)? };
            Ok(callbacks
                .with_progress(|progress| session.plan(wish.target(), &options, progress))?)
        })?;
        callbacks.log(planned.report());
        let status = status_of(planned.report());
        let made = Object::Plan(PlanObject::new(planned));
        // SAFETY: the caller's promise.
        unsafe { hand_out(made, plan, "plan")? };
        Ok(status)
    })
}

/// Appends the patches of a plan to its mesh, in the order of the loops. Patches are checked against each other and
/// against what was filled since; one that does not fit is made anew. The plan stays until it is freed.
///
/// Of `options` only the callbacks count, and it may be null; everything else is as it was given when the plan was made.
/// `report` may be null.
///
/// Statuses: `INCOMPLETE`, `STALE_PLAN` when it is of another mesh, an undo took back what it was made for, or attributes
/// were added since; `CANCELLED`; `BUSY`. With any but `OK` and `INCOMPLETE` nothing was changed and no report written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_plan_apply(
    plan: HolefillPlan,
    mesh: HolefillMesh,
    options: *const HolefillFillOptions,
    report: *mut HolefillReport,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        // SAFETY: the caller's promise.
        let (_, callbacks) = unsafe { read_options(options)? };
        let filled = plan.with(|object| {
            let apply = |session: &mut FillSession| {
                let applied =
                    callbacks.with_progress(|progress| session.apply(&object.plan, progress));
                applied.map_err(|e| match e.kind() {
                    ErrorKind::InvalidInput => {
                        Failure::new(HOLEFILL_STATUS_STALE_PLAN, e.to_string())
                    }
                    _ => e.into(),
                })
            };
            // SAFETY: the caller's promise.
            with_mesh_mut(mesh, |mesh| unsafe { change(mesh, report, apply) })
        })?;
        callbacks.log(&filled);
        Ok(status_of(&filled))
    })
}

/// What each loop would get: a report in which `HOLEFILL_HOLE_FILLED` says that there is a patch, and ranges are those of
/// the plan's own numbering, in which the patches follow each other.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_plan_report(
    plan: HolefillPlan,
    report: *mut HolefillReport,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(plan, error, |object| {
        let kept = Object::Report(object.plan.report().clone());
        // SAFETY: the caller's promise.
        unsafe { hand_out(kept, report, "report") }
    })
}

/// The size of the patch for a loop.
///
/// Statuses: `NOT_FOUND` when the plan has no patch for it. An island that is filled together with the loop round it has
/// none of its own.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_plan_patch(
    plan: HolefillPlan,
    loop_id: u64,
    info: *mut HolefillPatchInfo,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(plan, error, |object| {
        let patch = object.patch(loop_id)?;
        let value = HolefillPatchInfo {
            first_vertex: patch.first_vertex as u64,
            vertex_count: patch.vertices.len() as u64,
            triangle_count: patch.triangles.len() as u64,
            ..Default::default()
        };
        // SAFETY: the caller's promise.
        unsafe { write_struct(info, &value, "info") }
    })
}

/// Copies the positions of the new vertices of the patch for a loop, from its `first` on: `output` has rows of three,
/// `float` or `double`, as many as are wanted.
///
/// Statuses: `NOT_FOUND`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_plan_read_positions(
    plan: HolefillPlan,
    loop_id: u64,
    first: u64,
    output: *const HolefillOutput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(plan, error, |object| {
        // SAFETY: the caller's promise.
        unsafe { write_points(output, first, &object.patch(loop_id)?.vertices) }
    })
}

/// Copies the triangles of the patch for a loop, from its `first` on: `output` has rows of three, of 32 or 64 bits, as
/// many as are wanted. Indices below the number of vertices of the mesh are those of the mesh. The first new vertex has
/// the index `first_vertex` of `holefill_plan_patch`.
///
/// Statuses: `NOT_FOUND`; `LIMIT` for an index that the type has no room for.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_plan_read_triangles(
    plan: HolefillPlan,
    loop_id: u64,
    first: u64,
    output: *const HolefillOutput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(plan, error, |object| {
        // SAFETY: the caller's promise.
        unsafe { write_indices(output, first, &object.patch(loop_id)?.triangles) }
    })
}

/// Frees a plan. The handle 0 is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_plan_free(plan: HolefillPlan) -> HolefillStatus {
    guard_free(plan)
}
