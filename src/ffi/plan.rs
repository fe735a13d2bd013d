//! Planning patches without changing the mesh, reading them, and applying them.

use super::fill::{Holes, hand_out, status_of, with_callback};
use super::guard::{Failure, guard, guard_free};
use super::memory::{blank, null, write, write_indices, write_points, write_struct};
use super::objects::{Object, PLAN, free, keep, with_mesh, with_mesh_mut, with_plan};
use super::options::read_options;
use super::status::{
    HOLEFILL_STATUS_NOT_FOUND, HOLEFILL_STATUS_OK, HOLEFILL_STATUS_STALE_PLAN, HolefillStatus,
};
use super::types::{
    HolefillError, HolefillFillOptions, HolefillInput, HolefillMesh, HolefillOutput,
    HolefillPatchInfo, HolefillPlan, HolefillReport, HolefillSelection,
};
use crate::error::ErrorKind;
use crate::fill::session::{FillPlan, PlannedPatch};
use std::sync::OnceLock;

/// A plan that C has a handle of.
pub(super) struct PlanObject {
    plan: FillPlan,
    /// Its patches as C reads them, by the ids of their loops; made when they are first asked for.
    patches: OnceLock<Vec<PlannedPatch>>,
}

impl PlanObject {
    fn patch(&self, loop_id: u64) -> Result<&PlannedPatch, Failure> {
        let patches = self.patches.get_or_init(|| {
            let ids = self.plan.report().holes.iter().map(|h| h.id);
            ids.filter_map(|id| self.plan.patch(id)).collect()
        });
        patches
            .iter()
            .find(|p| p.loop_id as u64 == loop_id)
            .ok_or_else(|| {
                let message = format!("the plan has no patch for loop {loop_id}");
                Failure::new(HOLEFILL_STATUS_NOT_FOUND, message)
            })
    }
}

/// Plans holes of a mesh.
///
/// # Safety
/// The pointers are as the exported functions say.
unsafe fn make_plan(
    mesh: HolefillMesh,
    holes: Holes,
    options: *const HolefillFillOptions,
    plan: *mut HolefillPlan,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        if plan.is_null() {
            return Err(null("plan"));
        }
        // SAFETY: the caller's promise.
        let (options, callbacks) = unsafe { read_options(options)? };
        let planned = with_mesh(mesh.id, |object| {
            let session = &object.session;
            // SAFETY: the caller's promise.
            let wish = unsafe { holes.find(session)? };
            with_callback(options, &callbacks, |options, progress| {
                session.plan(wish.target(), options, progress)
            })
            .map_err(Failure::from)
        })?;
        callbacks.log(planned.report());
        let status = status_of(planned.report());
        let id = keep(Object::Plan(PlanObject {
            plan: planned,
            patches: OnceLock::new(),
        }))?;
        // SAFETY: not null, and the caller's promise.
        unsafe { write(plan, HolefillPlan { id }, "plan")? };
        Ok(status)
    })
}

/// Makes the patch for the loop `loop_id` and leaves the mesh as it is. The patch can be read, in the mesh's vertex
/// indices, and applied. Nothing of the mesh is copied, and other threads may read the mesh meanwhile.
///
/// `options` may be null. `plan` gets the handle.
///
/// Statuses: as `holefill_mesh_fill_loop`; with `INCOMPLETE` there is a plan without a patch, whose report says why.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_plan_loop(
    mesh: HolefillMesh,
    loop_id: u64,
    options: *const HolefillFillOptions,
    plan: *mut HolefillPlan,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { make_plan(mesh, Holes::Loop(loop_id), options, plan, error) }
}

/// As `holefill_mesh_plan_loop`, for the loop through the boundary edge from vertex `from` to vertex `to`, as it runs in
/// its triangle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_plan_edge(
    mesh: HolefillMesh,
    from: u64,
    to: u64,
    options: *const HolefillFillOptions,
    plan: *mut HolefillPlan,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { make_plan(mesh, Holes::Edge(from, to), options, plan, error) }
}

/// As `holefill_mesh_plan_loops`, for the loops that the closed chain `vertices` consists of: see
/// `holefill_mesh_find_vertices`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_plan_vertices(
    mesh: HolefillMesh,
    vertices: *const HolefillInput,
    options: *const HolefillFillOptions,
    plan: *mut HolefillPlan,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { make_plan(mesh, Holes::Vertices(vertices), options, plan, error) }
}

/// As `holefill_mesh_plan_loop`, for several loops: `loops` has rows of one id, `uint32_t` or `uint64_t`. Each patch is
/// checked against the mesh, but not against the other patches of the plan: that is done when the plan is applied.
/// To get patches that fit each other without keeping them in the mesh, fill, read what was appended, and undo.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_plan_loops(
    mesh: HolefillMesh,
    loops: *const HolefillInput,
    options: *const HolefillFillOptions,
    plan: *mut HolefillPlan,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { make_plan(mesh, Holes::Loops(loops), options, plan, error) }
}

/// As `holefill_mesh_plan_loops`, for all open loops that the rules choose; with `selection` null for all open loops.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_plan_selected(
    mesh: HolefillMesh,
    selection: *const HolefillSelection,
    options: *const HolefillFillOptions,
    plan: *mut HolefillPlan,
    error: *mut HolefillError,
) -> HolefillStatus {
    // SAFETY: the caller's promise.
    unsafe { make_plan(mesh, Holes::Selected(selection), options, plan, error) }
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
        let (options, callbacks) = unsafe { read_options(options)? };
        let (status, filled) = with_plan(plan.id, |object| {
            with_mesh_mut(mesh.id, |mesh| {
                let session = &mut mesh.session;
                let before = session.undo_count();
                let applied = with_callback(options, &callbacks, |_, progress| {
                    session.apply(&object.plan, progress)
                });
                let filled = applied.map_err(|e| match e.kind() {
                    ErrorKind::InvalidInput => {
                        Failure::new(HOLEFILL_STATUS_STALE_PLAN, e.to_string())
                    }
                    _ => e.into(),
                })?;
                // SAFETY: the caller's promise.
                if let Err(failure) = unsafe { hand_out(filled.clone(), report) } {
                    if session.undo_count() > before {
                        session.undo();
                    }
                    return Err(failure);
                }
                Ok((status_of(&filled), filled))
            })
        })?;
        callbacks.log(&filled);
        Ok(status)
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
    guard(error, || {
        if report.is_null() {
            return Err(null("report"));
        }
        with_plan(plan.id, |object| {
            // SAFETY: the caller's promise.
            unsafe { hand_out(object.plan.report().clone(), report)? };
            Ok(HOLEFILL_STATUS_OK)
        })
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
    guard(error, || {
        with_plan(plan.id, |object| {
            let patch = object.patch(loop_id)?;
            let value = HolefillPatchInfo {
                first_vertex: patch.first_vertex as u64,
                vertex_count: patch.vertices.len() as u64,
                triangle_count: patch.triangles.len() as u64,
                ..blank()
            };
            // SAFETY: the caller's promise.
            unsafe { write_struct(info, &value, "info")? };
            Ok(HOLEFILL_STATUS_OK)
        })
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
    guard(error, || {
        with_plan(plan.id, |object| {
            let vertices = &object.patch(loop_id)?.vertices;
            // SAFETY: the caller's promise.
            unsafe { write_points(output, first, vertices)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// Copies the triangles of the patch for a loop, from its `first` on: `output` has rows of three, `uint32_t` or `uint64_t`,
/// as many as are wanted. Indices below the number of vertices of the mesh are those of the mesh; the first new vertex
/// has the index `first_vertex` of `holefill_plan_patch`.
///
/// Statuses: `NOT_FOUND`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_plan_read_triangles(
    plan: HolefillPlan,
    loop_id: u64,
    first: u64,
    output: *const HolefillOutput,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_plan(plan.id, |object| {
            let triangles = &object.patch(loop_id)?.triangles;
            // SAFETY: the caller's promise.
            unsafe { write_indices(output, first, triangles)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// Frees a plan. The handle 0 is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_plan_free(plan: HolefillPlan) -> HolefillStatus {
    guard_free(|| free(PLAN, plan.id))
}
