//! Reading how the missing surface of a hole was predicted.

use super::guard::{Failure, guard};
use super::memory::{blank, null, write, write_struct, write_text};
use super::objects::with_report;
use super::report::{find, nth};
use super::status::{HOLEFILL_STATUS_NOT_FOUND, HOLEFILL_STATUS_OK, HolefillStatus};
use super::types::{HolefillError, HolefillPrediction, HolefillReport};
use crate::fill::report::{FillReport, Prediction};
use crate::predict::surface::candidates::Candidate;
use std::ffi::{CString, c_char};
use std::sync::LazyLock;

/// The names of `Candidate::ALL`.
static CANDIDATES: LazyLock<Vec<CString>> = LazyLock::new(|| {
    let text = |c: Candidate| CString::new(c.name()).unwrap_or_default();
    Candidate::ALL.into_iter().map(text).collect()
});

fn candidate_text(candidate: Candidate) -> *const c_char {
    let place = Candidate::ALL.iter().position(|&c| c == candidate);
    place.map_or(std::ptr::null(), |i| CANDIDATES[i].as_ptr())
}

fn find_prediction(report: &FillReport, index: u64) -> Result<&Prediction, Failure> {
    find(report, index)?.prediction.as_ref().ok_or_else(|| {
        let message = format!("entry {index} has no prediction");
        Failure::new(HOLEFILL_STATUS_NOT_FOUND, message)
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
    guard(error, || {
        with_report(report.id, |report| {
            let found = find_prediction(report, index)?;
            let value = HolefillPrediction {
                chosen: candidate_text(found.chosen),
                noise: found.noise,
                score_count: found.scores.len() as u64,
                crease_count: found.crease_count as u64,
                crease_surface_count: found.crease_surfaces.len() as u64,
                is_tip: found.is_tip.into(),
                is_flat: found.is_flat.into(),
                ..blank()
            };
            // SAFETY: the caller's promise.
            unsafe { write_struct(prediction, &value, "prediction")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// The `place`-th candidate surface that was compared for the hole of entry `index`: its name as static text that is
/// never freed, and its score, which is about the distance in mean rim edges at which the candidate misses rings round
/// the hole that it has not seen. The smallest is best; `docs/methods/auto.md` says what enters it.
///
/// Statuses: `NOT_FOUND`, also when the entry has no prediction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_score(
    report: HolefillReport,
    index: u64,
    place: u64,
    candidate: *mut *const c_char,
    score: *mut f64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_report(report.id, |report| {
            let scores = &find_prediction(report, index)?.scores;
            let &(scored, value) = nth(scores, place, "score")?;
            if candidate.is_null() {
                return Err(null("candidate"));
            }
            // SAFETY: the caller's promise.
            unsafe { write(score, value, "score")? };
            // SAFETY: not null, and the caller's promise.
            unsafe { write(candidate, candidate_text(scored), "candidate")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// The `place`-th surface between the creases in the patch for the hole of entry `index`, in the order in which the rim
/// meets them: its name as static text that is never freed.
///
/// Statuses: `NOT_FOUND`, also when the entry has no prediction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_crease_surface(
    report: HolefillReport,
    index: u64,
    place: u64,
    candidate: *mut *const c_char,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_report(report.id, |report| {
            let surfaces = &find_prediction(report, index)?.crease_surfaces;
            let &found = nth(surfaces, place, "surface")?;
            // SAFETY: the caller's promise.
            unsafe { write(candidate, candidate_text(found), "candidate")? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}

/// Why creases that run into the hole of entry `index` were not continued; empty when they were, or when there are none.
/// `buffer`, `capacity` and `length` as in `holefill_error_message`.
///
/// Statuses: `NOT_FOUND`, also when the entry has no prediction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_report_without_creases(
    report: HolefillReport,
    index: u64,
    buffer: *mut c_char,
    capacity: u64,
    length: *mut u64,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        with_report(report.id, |report| {
            let found = find_prediction(report, index)?;
            let reason = found.without_creases.as_deref().unwrap_or_default();
            // SAFETY: the caller's promise.
            unsafe { write_text(reason, buffer, capacity, length)? };
            Ok(HOLEFILL_STATUS_OK)
        })
    })
}
