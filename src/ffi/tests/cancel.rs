//! Stopping: at every call of the callback, and after a time.

use super::*;

/// A method that takes some time on the holes of `holed`, on threads and without.
fn slow(threads: u32) -> HolefillFillOptions {
    HolefillFillOptions {
        threads,
        density: 0.15,
        ..with_method(c"fair-c2")
    }
}

#[test]
fn a_callback_that_stops_at_its_nth_call_leaves_the_mesh_as_it_was() {
    let finished = holed_mesh();
    assert_eq!(fill_all(finished.0, &slow(1)), OK);
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
            let (status, report) = report_of(mesh.0, &every_loop(), &options);
            if left >= 0 {
                assert_eq!((status, digest(mesh.0)), (OK, finished));
                break;
            }
            assert_eq!(status, CANCELLED, "call {n}");
            assert_eq!((report.0.id, digest(mesh.0)), (0, before), "call {n}");
            // And the mesh is as good as before.
            if n == 0 {
                assert_eq!(fill_all(mesh.0, &slow(threads)), OK);
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
    let status = call!(holefill_mesh_plan: mesh.0, &at_loop(0), &options, &mut plan);
    assert_eq!((status, plan.id), (CANCELLED, 0));
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
    let (status, report) = report_of(mesh.0, &at_loop(0), &options);
    assert_eq!(status, INCOMPLETE);
    assert_eq!(digest(mesh.0), before);
    let hole = hole(&report, 0);
    assert_eq!(
        (hole.status, hole.cause),
        (HOLEFILL_HOLE_FAILED, HOLEFILL_CAUSE_LIMIT)
    );
    let reason = reason(&report, 0);
    assert!(reason.contains("time budget"), "{reason}");
    // Enough time is no limit.
    let options = HolefillFillOptions {
        time_budget: 1e6,
        ..slow(1)
    };
    assert_eq!(fill_loop(mesh.0, 0, &options), OK);
}
