//! Reading what happened to each hole.

use super::guard::{Failure, guard, guard_free};
use super::loops::class_number;
use super::memory::{blank, null, write, write_struct, write_text};
use super::objects::{REPORT, free, with_report};
use super::options::method_text;
use super::status::{HOLEFILL_STATUS_NOT_FOUND, HOLEFILL_STATUS_OK, HolefillStatus};
use super::types::{
    HOLEFILL_CAUSE_CANCELLED, HOLEFILL_CAUSE_GEOMETRY, HOLEFILL_CAUSE_INPUT, HOLEFILL_CAUSE_LIMIT,
    HOLEFILL_CAUSE_NONE, HOLEFILL_CAUSE_SOLVER, HOLEFILL_CAUSE_TOPOLOGY, HOLEFILL_HOLE_CANCELLED,
    HOLEFILL_HOLE_FAILED, HOLEFILL_HOLE_FILLED, HOLEFILL_HOLE_KEPT, HolefillCause, HolefillError,
    HolefillHole, HolefillHoleStatus, HolefillReport, HolefillSummary,
};
use crate::error::ErrorKind;
use crate::fill::report::{FillReport, HoleReport, HoleStatus};
use std::ffi::c_char;

fn status_number(status: HoleStatus) -> HolefillHoleStatus {
    match status {
        HoleStatus::Filled => HOLEFILL_HOLE_FILLED,
        HoleStatus::Kept => HOLEFILL_HOLE_KEPT,
        HoleStatus::Failed => HOLEFILL_HOLE_FAILED,
        HoleStatus::Cancelled => HOLEFILL_HOLE_CANCELLED,
    }
}

fn cause_number(cause: Option<ErrorKind>) -> HolefillCause {
    match cause {
        None => HOLEFILL_CAUSE_NONE,
        Some(ErrorKind::Topology) => HOLEFILL_CAUSE_TOPOLOGY,
        Some(ErrorKind::Geometry) => HOLEFILL_CAUSE_GEOMETRY,
        Some(ErrorKind::Solver) => HOLEFILL_CAUSE_SOLVER,
        Some(ErrorKind::Limit) => HOLEFILL_CAUSE_LIMIT,
        Some(ErrorKind::Cancelled) => HOLEFILL_CAUSE_CANCELLED,
        Some(_) => HOLEFILL_CAUSE_INPUT,
    }
}

/// Element `index` of a list of things that are called `what`.
pub(super) fn nth<'a, T>(list: &'a [T], index: u64, what: &str) -> Result<&'a T, Failure> {
    let found = usize::try_from(index).ok().and_then(|i| list.get(i));
    found.ok_or_else(|| {
        let message = format!("there is no {what} {index} among {}", list.len());
        Failure::new(HOLEFILL_STATUS_NOT_FOUND, message)
    })
}

/// Entry `index` of the report.
pub(super) fn find(report: &FillReport, index: u64) -> Result<&HoleReport, Failure> {
    nth(&report.holes, index, "entry")
}

/// What happened to all holes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_summary(
    report: HolefillReport,
    summary: *mut HolefillSummary,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_report(report.id, |report| {
            let count = |status| report.count(status) as u64;
            let sum = |size: &dyn Fn(&HoleReport) -> usize| {
                report.holes.iter().map(|h| size(h) as u64).sum()
            };
            let value = HolefillSummary {
                hole_count: report.holes.len() as u64,
                filled: count(HoleStatus::Filled),
                kept: count(HoleStatus::Kept),
                failed: count(HoleStatus::Failed),
                cancelled: count(HoleStatus::Cancelled),
                new_vertices: sum(&|h| h.new_vertices.len()),
                new_triangles: sum(&|h| h.new_triangles.len()),
                index_seconds: report.index_seconds,
                fill_seconds: report.fill_seconds,
                ..blank()
            };
            // SAFETY: the caller's promise.
            unsafe { write_struct(summary, &value, "summary")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// What happened to one hole: entry `index` of the report, in the order of the loops' ids.
///
/// A fill of chosen loops has an entry for each of them, a fill by rules one for every loop of the mesh.
///
/// Statuses: `NOT_FOUND`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_hole(
    report: HolefillReport,
    index: u64,
    hole: *mut HolefillHole,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_report(report.id, |report| {
            let found = find(report, index)?;
            let value = HolefillHole {
                loop_id: found.id as u64,
                edge_count: found.edges as u64,
                edge: found.edge.map(u64::from),
                perimeter: found.perimeter,
                loop_class: class_number(found.class),
                status: status_number(found.status),
                cause: cause_number(found.cause),
                tried_count: found.tried.len() as u32,
                method: found.method.map_or(std::ptr::null(), method_text),
                first_vertex: found.new_vertices.start.into(),
                vertex_count: found.new_vertices.len() as u64,
                first_triangle: found.new_triangles.start.into(),
                triangle_count: found.new_triangles.len() as u64,
                self_intersections: found.self_intersections as u64,
                min_angle: found.min_angle.unwrap_or(0.0),
                seconds: found.seconds,
                ..blank()
            };
            // SAFETY: the caller's promise.
            unsafe { write_struct(hole, &value, "hole")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// Why the hole of entry `index` stays open, or what remains to be said of it; empty when that is nothing. `buffer`,
/// `capacity` and `length` as in `holefill_error_message`.
///
/// Statuses: `NOT_FOUND`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_reason(
    report: HolefillReport,
    index: u64,
    buffer: *mut c_char,
    capacity: u64,
    length: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_report(report.id, |report| {
            let found = find(report, index)?;
            // SAFETY: the caller's promise.
            unsafe { write_text(&found.reason, buffer, capacity, length)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// The `attempt`-th method that was tried for the hole of entry `index` and not used, and why. `method` gets its name as
/// static text that is never freed; `buffer`, `capacity` and `length` as in `holefill_error_message` for the reason.
///
/// Statuses: `NOT_FOUND`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_tried(
    report: HolefillReport,
    index: u64,
    attempt: u32,
    method: *mut *const c_char,
    buffer: *mut c_char,
    capacity: u64,
    length: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_report(report.id, |report| {
            let hole = find(report, index)?;
            let tried = hole.tried.get(attempt as usize).ok_or_else(|| {
                let message = format!("{} methods were tried and not used", hole.tried.len());
                Failure::new(HOLEFILL_STATUS_NOT_FOUND, message)
            })?;
            if method.is_null() {
                return Err(null("method"));
            }
            // SAFETY: the caller's promise.
            unsafe { write_text(&tried.reason, buffer, capacity, length)? };
            // SAFETY: not null, and the caller's promise.
            unsafe { write(method, method_text(tried.method), "method")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// Frees a report. The handle 0 is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_report_free(report: HolefillReport) -> HolefillStatus {
    guard_free(|| free(REPORT, report.id))
}
