//! Stopping: at every call of the callback, at any time, and after a time.

use super::*;
use std::time::{Duration, Instant};

/// A method that takes some time on the holes of `holed`, on threads and without.
fn slow(threads: u32) -> HolefillFillOptions {
    HolefillFillOptions {
        threads,
        density: 0.4,
        ..with_method(c"fair-c2")
    }
}

#[test]
fn a_callback_that_stops_at_its_nth_call_leaves_the_mesh_as_it_was() {
    let finished = holed_mesh();
    assert_eq!(fill_all(finished.0, &slow(1)), HOLEFILL_STATUS_OK);
    let finished = digest(finished.0);
    for threads in [1, 2] {
        let mut n = 0_i64;
        loop {
            let mesh = holed_mesh();
            let before = digest(mesh.0);
            let mut left = n;
            let options = HolefillFillOptions {
                progress: Some(stop_at),
                progress_data: (&raw mut left).cast(),
                ..slow(threads)
            };
            let mut report = HolefillReport::default();
            // SAFETY: all pointers are null or to living values.
            let status = unsafe {
                holefill_mesh_fill_selected(mesh.0, ptr::null(), &options, &mut report, nothing())
            };
            if left >= 0 {
                assert_eq!((status, digest(mesh.0)), (HOLEFILL_STATUS_OK, finished));
                holefill_report_free(report);
                break;
            }
            assert_eq!(status, HOLEFILL_STATUS_CANCELLED, "call {n}");
            assert_eq!((report.id, digest(mesh.0)), (0, before), "call {n}");
            // And the mesh is as good as before.
            if n == 0 {
                assert_eq!(fill_all(mesh.0, &slow(threads)), HOLEFILL_STATUS_OK);
                assert_eq!(digest(mesh.0), finished);
            }
            // Every call at first, then ever fewer: there may be hundreds on a slow machine.
            n += 1 + n / 3;
        }
        assert!(n > 2, "the callback is asked within holes too");
    }
}

#[test]
fn stopping_a_plan_or_an_apply_changes_nothing() {
    let mesh = holed_mesh();
    let before = digest(mesh.0);
    let mut left = 0_i64;
    let options = HolefillFillOptions {
        progress: Some(stop_at),
        progress_data: (&raw mut left).cast(),
        ..slow(1)
    };
    let mut plan = HolefillPlan::default();
    // SAFETY: all pointers are null or to living values.
    let status = unsafe { holefill_mesh_plan_loop(mesh.0, 0, &options, &mut plan, nothing()) };
    assert_eq!((status, plan.id), (HOLEFILL_STATUS_CANCELLED, 0));
    assert_eq!(digest(mesh.0), before);
}

#[test]
fn holes_whose_time_runs_out_stay_as_they_were_and_say_so() {
    let mesh = holed_mesh();
    let before = digest(mesh.0);
    let options = HolefillFillOptions {
        time_budget: 1e-9,
        ..slow(1)
    };
    let mut report = HolefillReport::default();
    // SAFETY: all pointers are null or to living values.
    let status = unsafe { holefill_mesh_fill_loop(mesh.0, 0, &options, &mut report, nothing()) };
    assert_eq!(status, HOLEFILL_STATUS_INCOMPLETE);
    assert_eq!(digest(mesh.0), before);
    let mut hole = memory::blank::<HolefillHole>();
    // SAFETY: the pointer is to a living value.
    unsafe { holefill_report_hole(report, 0, &mut hole, nothing()) };
    assert_eq!(
        (hole.status, hole.cause),
        (HOLEFILL_HOLE_FAILED, HOLEFILL_CAUSE_LIMIT)
    );
    // SAFETY: `text` gives room as it says.
    let reason = text(&|buffer, capacity, length| unsafe {
        holefill_report_reason(report, 0, buffer, capacity, length, nothing())
    });
    assert!(reason.contains("time budget"), "{reason}");
    holefill_report_free(report);
    // Enough time is no limit.
    let options = HolefillFillOptions {
        time_budget: 1e6,
        ..slow(1)
    };
    assert_eq!(fill_loop(mesh.0, 0, &options), HOLEFILL_STATUS_OK);
}

/// A band round a hole of 20,000 edges with five lobes.
fn wide() -> Arrays {
    fixtures::cylinder(20_000, 3).mapped(|[x, y, z]| {
        let angle = y.atan2(x);
        let theta = 1.0 + 0.15 * (5.0 * angle).cos() + z;
        let (sin, cos) = theta.sin_cos();
        [sin * angle.cos(), sin * angle.sin(), cos]
    })
}

/// Stops some time after its first call, and notes when it did.
struct Stopper {
    first: Option<Instant>,
    after: Duration,
    asked: Option<Instant>,
    longest: Duration,
    last: Option<Instant>,
}

unsafe extern "C" fn stop_later(_: *const HolefillProgress, user_data: *mut c_void) -> i32 {
    // SAFETY: the test hands its `Stopper` over; calls come one at a time.
    let stopper = unsafe { &mut *user_data.cast::<Stopper>() };
    let now = Instant::now();
    let first = *stopper.first.get_or_insert(now);
    if let Some(last) = stopper.last.replace(now) {
        stopper.longest = stopper.longest.max(now - last);
    }
    if now - first < stopper.after {
        return 0;
    }
    stopper.asked.get_or_insert(now);
    1
}

/// Stops at several moments, by every method: the time to answer, and the longest time between two questions. Prints what it
/// measures; only an order of magnitude is asserted, because other programs may hold the processors.
#[test]
#[ignore = "measures times: run it alone, in release, on an idle machine"]
fn a_stop_on_a_hole_of_twenty_thousand_edges_is_answered_soon() {
    let mesh = mesh_of(&wide());
    // SAFETY: no pointer but null.
    unsafe { holefill_mesh_prepare(mesh.0, nothing()) };
    let before = digest(mesh.0);
    for index in 0..holefill_method_count() {
        let method = holefill_method_name(index);
        let named = HolefillFillOptions {
            method,
            ..options()
        };
        let name = static_text(method).unwrap();
        for after in [0, 5, 20, 50, 100, 200, 400, 800, 1600, 3200] {
            let mut stopper = Stopper {
                first: None,
                after: Duration::from_millis(after),
                asked: None,
                longest: Duration::ZERO,
                last: None,
            };
            let options = HolefillFillOptions {
                progress: Some(stop_later),
                progress_data: (&raw mut stopper).cast(),
                ..named
            };
            let status = fill_loop(mesh.0, 0, &options);
            let returned = Instant::now();
            let Some(asked) = stopper.asked else {
                println!(
                    "{name}: done before {after} ms, longest gap {:?}",
                    stopper.longest
                );
                if status == HOLEFILL_STATUS_OK {
                    assert_eq!(undo(mesh.0), HOLEFILL_STATUS_OK);
                }
                break;
            };
            let answer = returned - asked;
            println!(
                "{name} stopped after {after} ms: answered in {answer:?}, longest gap {:?}",
                stopper.longest
            );
            let expected = (HOLEFILL_STATUS_CANCELLED, before);
            assert_eq!((status, digest(mesh.0)), expected, "{name}");
            assert!(answer < Duration::from_secs(1), "{name}");
        }
        for budget in [0.01, 0.1, 0.4, 1.6] {
            let options = HolefillFillOptions {
                time_budget: budget,
                ..named
            };
            let start = Instant::now();
            let status = fill_loop(mesh.0, 0, &options);
            println!(
                "{name} with {budget} s: {status} after {:?}",
                start.elapsed()
            );
            if status == HOLEFILL_STATUS_OK {
                undo(mesh.0);
                break;
            }
            assert_eq!(digest(mesh.0), before, "{name}");
        }
    }
}
