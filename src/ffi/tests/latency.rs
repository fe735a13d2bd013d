//! How soon a fill of a large hole stops.

use super::*;
use rustix::time::{ClockId, clock_gettime};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// A band round a hole of 20,000 edges with five lobes.
fn wide() -> Arrays {
    fixtures::cylinder(20_000, 10).mapped(|[x, y, z]| {
        let angle = y.atan2(x);
        let theta = 1.0 + 0.15 * (5.0 * angle).cos() + z;
        let (sin, cos) = theta.sin_cos();
        [sin * angle.cos(), sin * angle.sin(), cos]
    })
}

/// Stops some time after its first call, and notes when it did and how long the gaps between its calls are.
struct Stopper {
    after: Duration,
    first: Option<Instant>,
    asked: Option<Instant>,
    last: Option<Moment>,
    longest: Span,
}

/// A time by the clock, and the processor time that the calling thread has used till then.
#[derive(Clone, Copy)]
struct Moment {
    elapsed: Instant,
    used: Duration,
    thread: ThreadId,
}

#[derive(Clone, Copy, Debug, Default)]
struct Span {
    elapsed: Duration,
    used: Duration,
}

impl Moment {
    fn now() -> Self {
        let used = clock_gettime(ClockId::ThreadCPUTime);
        Self {
            elapsed: Instant::now(),
            used: Duration::new(used.tv_sec as u64, used.tv_nsec as u32),
            thread: thread::current().id(),
        }
    }
}

impl Stopper {
    fn new(after: Duration) -> Self {
        Self {
            after,
            first: None,
            asked: None,
            last: None,
            longest: Span::default(),
        }
    }

    fn note_gap(&mut self, now: Moment) {
        if let Some(last) = self.last.replace(now) {
            self.longest.elapsed = self.longest.elapsed.max(now.elapsed - last.elapsed);
            // What one thread used says nothing to another.
            if now.thread == last.thread {
                self.longest.used = self.longest.used.max(now.used - last.used);
            }
        }
    }
}

unsafe extern "C" fn stop_later(_: *const HolefillProgress, user_data: *mut c_void) -> i32 {
    // SAFETY: the test hands its `Stopper` over; calls come one at a time.
    let stopper = unsafe { &mut *user_data.cast::<Stopper>() };
    let now = Moment::now();
    stopper.note_gap(now);
    let first = *stopper.first.get_or_insert(now.elapsed);
    if now.elapsed - first < stopper.after {
        return 0;
    }
    stopper.asked.get_or_insert(now.elapsed);
    1
}

/// Processor time that a fill may use between two questions whether to stop. Twice the 50 ms that are the aim: a
/// processor that others use too is slower.
const LONGEST_GAP: Duration = Duration::from_millis(100);
/// Median time by the clock from the request to the return, which does nothing but give memory back: other programs may
/// hold the processors.
const SLOWEST_RETURN: Duration = Duration::from_millis(500);

/// Milliseconds after which fills are stopped at the latest: `HOLEFILL_LATEST_STOP` in the environment, or few.
fn latest_stop() -> u64 {
    let text = std::env::var("HOLEFILL_LATEST_STOP").unwrap_or_default();
    text.parse().unwrap_or(100)
}

/// Stops at several moments, by every method. Prints the time from the request to the return, and the longest time
/// between two questions.
#[test]
fn a_stop_on_a_hole_of_twenty_thousand_edges_is_answered_soon() {
    let latest = latest_stop();
    let mesh = mesh_of(&wide());
    call!(holefill_mesh_prepare: mesh.0);
    let before = digest(mesh.0);
    for index in 0..holefill_method_count() {
        let method = holefill_method_name(index);
        let named = HolefillFillOptions {
            method,
            ..options()
        };
        let name = static_text(method).unwrap();
        let mut answers = Vec::new();
        for after in [0, 20, 100, 400, 1600, u64::MAX]
            .into_iter()
            .filter(|&after| after <= latest)
        {
            let mut stopper = Stopper::new(Duration::from_millis(after));
            let options = HolefillFillOptions {
                progress: Some(stop_later),
                progress_data: (&raw mut stopper).cast(),
                ..named
            };
            let status = fill_loop(mesh.0, 0, &options);
            let returned = Instant::now();
            let longest = stopper.longest;
            assert!(longest.used < LONGEST_GAP, "{name}: {longest:?}");
            let Some(asked) = stopper.asked else {
                println!("{name}: to its end, longest gap {longest:?}");
                assert_ne!(status, CANCELLED, "{name}");
                if status == OK {
                    assert_eq!(undo(mesh.0), OK);
                }
                break;
            };
            let answer = returned - asked;
            answers.push(answer);
            println!("{name} stopped after {after} ms: {answer:?}, longest gap {longest:?}");
            let expected = (CANCELLED, before);
            assert_eq!((status, digest(mesh.0)), expected, "{name}");
        }
        answers.sort_unstable();
        let median = answers[answers.len() / 2];
        assert!(median < SLOWEST_RETURN, "{name}: {answers:?}");
        for budget in [10, 100, 400, 1600]
            .into_iter()
            .filter(|&budget| budget <= latest)
        {
            let options = HolefillFillOptions {
                time_budget: budget as f64 * 1e-3,
                ..named
            };
            let start = Instant::now();
            let status = fill_loop(mesh.0, 0, &options);
            println!(
                "{name} with {budget} ms: {status} after {:?}",
                start.elapsed()
            );
            if status == OK {
                undo(mesh.0);
                break;
            }
            assert_eq!(digest(mesh.0), before, "{name}");
        }
    }
}
