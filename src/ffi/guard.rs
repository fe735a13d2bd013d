//! What every exported function runs in.

use super::failure::Failure;
use super::objects::{ERROR, MeshObject, Object, PlanObject, TABLE, keep};
use super::objects::{with_mesh, with_mesh_mut, with_plan, with_report};
use super::status::{HOLEFILL_STATUS_OK, HOLEFILL_STATUS_PANIC, HolefillStatus};
use super::types::{HolefillError, HolefillMesh, HolefillPlan, HolefillReport};
use crate::fill::report::FillReport;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

/// How a call ended that did not fail: nothing is `HOLEFILL_STATUS_OK`.
pub(super) trait Success {
    fn status(self) -> HolefillStatus;
}

impl Success for () {
    fn status(self) -> HolefillStatus {
        HOLEFILL_STATUS_OK
    }
}

impl Success for HolefillStatus {
    fn status(self) -> HolefillStatus {
        self
    }
}

/// Runs the body of an exported function. A failure is described in the error object that `error` holds, or in a new
/// one. Nothing is written there otherwise.
///
/// `error` is null or points to a handle that the caller may write.
pub(super) fn guard<S: Success>(
    error: *mut HolefillError,
    body: impl FnOnce() -> Result<S, Failure>,
) -> HolefillStatus {
    // Whatever the body leaves half done is behind a handle that is poisoned.
    match contained(body) {
        Ok(success) => success.status(),
        Err(failure) => {
            let status = failure.status;
            if !error.is_null() {
                // A failure to describe the failure must not leave the function either.
                let _ = contained(|| describe(error, failure));
            }
            status
        }
    }
}

/// As [`guard`], for functions without an error object.
pub(super) fn guard_silent(body: impl FnOnce() -> Result<(), Failure>) -> HolefillStatus {
    guard(std::ptr::null_mut(), body)
}

/// As [`guard`], for functions that return something else. `otherwise` stands for a panic.
pub(super) fn guard_value<R>(otherwise: R, body: impl FnOnce() -> R) -> R {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or(otherwise)
}

/// As [`guard`], with a mesh to read.
pub(super) fn guard_mesh(
    mesh: HolefillMesh,
    error: *mut HolefillError,
    body: impl FnOnce(&MeshObject) -> Result<(), Failure>,
) -> HolefillStatus {
    guard(error, || with_mesh(mesh.id, body))
}

/// As [`guard`], with a mesh to change.
pub(super) fn guard_mesh_mut(
    mesh: HolefillMesh,
    error: *mut HolefillError,
    body: impl FnOnce(&mut MeshObject) -> Result<(), Failure>,
) -> HolefillStatus {
    guard(error, || with_mesh_mut(mesh.id, body))
}

/// As [`guard`], with a plan.
pub(super) fn guard_plan(
    plan: HolefillPlan,
    error: *mut HolefillError,
    body: impl FnOnce(&PlanObject) -> Result<(), Failure>,
) -> HolefillStatus {
    guard(error, || with_plan(plan.id, body))
}

/// As [`guard`], with a report.
pub(super) fn guard_report(
    report: HolefillReport,
    error: *mut HolefillError,
    body: impl FnOnce(&FillReport) -> Result<(), Failure>,
) -> HolefillStatus {
    guard(error, || with_report(report.id, body))
}

fn contained<S>(body: impl FnOnce() -> Result<S, Failure>) -> Result<S, Failure> {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| {
        let text = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied());
        let message = format!("defect in the library: {}", text.unwrap_or("no message"));
        Err(Failure::new(HOLEFILL_STATUS_PANIC, message))
    })
}

fn describe(error: *mut HolefillError, failure: Failure) -> Result<(), Failure> {
    // SAFETY: `error` is not null, and points to a handle of the caller.
    let known = unsafe { error.read_unaligned() };
    if let Some(object) = TABLE.get(ERROR, known.id)
        && let Object::Error(place) = &*object
    {
        *place.lock().unwrap_or_else(|e| e.into_inner()) = failure;
        return Ok(());
    }
    let id = keep(Object::Error(Mutex::new(failure))).unwrap_or(0);
    // SAFETY: as above.
    unsafe { error.write_unaligned(HolefillError { id }) };
    Ok(())
}
