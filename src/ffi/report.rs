//! Reading what happened to each hole.

use super::failure::{Failure, not_found, not_null, nth};
use super::guard::{guard_free, guard_with};
use super::loops::class_number;
use super::options::method_text;
use super::output::write;
use super::status::HolefillStatus;
use super::structs::write_struct;
use super::text::{owned, write_text};
use super::types::*;
use crate::error::ErrorKind;
use crate::fill::report::{FillReport, HoleReport, HoleStatus};
use crate::methods::auto::surface::candidates::Candidate;
use std::ffi::{CString, c_char};
use std::sync::LazyLock;

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

/// The names of `Candidate::ALL`.
static CANDIDATES: LazyLock<Vec<CString>> = LazyLock::new(|| {
    let names = Candidate::ALL.into_iter().map(Candidate::name);
    names.map(owned).collect()
});

fn candidate_text(candidate: Candidate) -> *const c_char {
    let place = Candidate::ALL.iter().position(|&c| c == candidate);
    place.map_or(std::ptr::null(), |i| CANDIDATES[i].as_ptr())
}

/// Entry `index` of the report.
fn find(report: &FillReport, index: u64) -> Result<&HoleReport, Failure> {
    nth(&report.holes, index, "entry")
}

/// The whole report as JSON: one object, UTF-8. `buffer`, `capacity` and `length` as in `holefill_error_message`.
///
/// `holes` is a list with an entry for each hole, in the form of `holefill fill --report`: with the methods that were tried,
/// the candidate surfaces that were compared, and their scores. `index_seconds` and `fill_seconds` are those of
/// `HolefillSummary`. Later versions may add keys.
///
/// Statuses: `BUFFER_TOO_SMALL`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_json(
    report: HolefillReport,
    buffer: *mut c_char,
    capacity: u64,
    length: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(report, error, |report| {
        // SAFETY: the caller's promise.
        unsafe { write_text(&report.to_json(), buffer, capacity, length) }
    })
}

/// What happened to all holes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_summary(
    report: HolefillReport,
    summary: *mut HolefillSummary,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(report, error, |report| {
        let count = |status| report.count(status) as u64;
        let sum = |size: fn(&HoleReport) -> usize| report.holes.iter().map(size).sum::<usize>();
        let value = HolefillSummary {
            hole_count: report.holes.len() as u64,
            filled: count(HoleStatus::Filled),
            kept: count(HoleStatus::Kept),
            failed: count(HoleStatus::Failed),
            cancelled: count(HoleStatus::Cancelled),
            new_vertices: sum(|h| h.new_vertices.len()) as u64,
            new_triangles: sum(|h| h.new_triangles.len()) as u64,
            index_seconds: report.index_seconds,
            fill_seconds: report.fill_seconds,
            ..Default::default()
        };
        // SAFETY: the caller's promise.
        unsafe { write_struct(summary, &value, "summary") }
    })
}

/// What happened to one hole: entry `index` of the report, in the order of the loops' ids.
///
/// Statuses: `NOT_FOUND`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_hole(
    report: HolefillReport,
    index: u64,
    hole: *mut HolefillHole,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(report, error, |report| {
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
            ..Default::default()
        };
        // SAFETY: the caller's promise.
        unsafe { write_struct(hole, &value, "hole") }
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
    guard_with(report, error, |report| {
        // SAFETY: the caller's promise.
        unsafe { write_text(&find(report, index)?.reason, buffer, capacity, length) }
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
    guard_with(report, error, |report| {
        let tried = nth(&find(report, index)?.tried, attempt.into(), "attempt")?;
        not_null(method.cast_const(), "method")?;
        // SAFETY: the caller's promise.
        unsafe {
            write_text(&tried.reason, buffer, capacity, length)?;
            write(method, method_text(tried.method), "method")
        }
    })
}

/// How the missing surface was predicted for the filled hole of entry `index`. The methods `auto` and `curvature` predict
/// one; whether it stands is said by the hole's `method`. An island has none: it belongs to the hole that it lies in.
///
/// Statuses: `NOT_FOUND`, also when the entry has no prediction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_prediction(
    report: HolefillReport,
    index: u64,
    prediction: *mut HolefillPrediction,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard_with(report, error, |report| {
        let none = || not_found(format!("entry {index} has no prediction"));
        let found = find(report, index)?.prediction.as_ref().ok_or_else(none)?;
        let value = HolefillPrediction {
            chosen: candidate_text(found.chosen),
            noise: found.noise,
            score_count: found.scores.len() as u64,
            crease_count: found.crease_count as u64,
            crease_surface_count: found.crease_surfaces.len() as u64,
            is_tip: found.is_tip.into(),
            is_flat: found.is_flat.into(),
            ..Default::default()
        };
        // SAFETY: the caller's promise.
        unsafe { write_struct(prediction, &value, "prediction") }
    })
}

/// Frees a report. The handle 0 is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn holefill_report_free(report: HolefillReport) -> HolefillStatus {
    guard_free(report)
}
