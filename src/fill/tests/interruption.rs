//! How soon a fill answers when it is asked to stop.

use super::{mesh_of, with_method};
use crate::boundary::loops::BoundaryLoops;
use crate::boundary::opening::Opening;
use crate::fill::index::MeshIndex;
use crate::fill::plan::{Planner, chain};
use crate::fixtures::{self, Arrays};
use crate::job::Job;
use crate::methods::method::Method;
use std::sync::Mutex;

/// Seconds of processor time that may pass between two questions.
const LONGEST_GAP: f64 = 0.05;

/// A band round a hole of `edges` edges with five lobes.
fn wide_rim(edges: usize) -> Arrays {
    fixtures::cylinder(edges, 10).mapped(|[x, y, z]| {
        let angle = y.atan2(x);
        let theta = 1.0 + 0.15 * (5.0 * angle).cos() + z;
        [
            theta.sin() * angle.cos(),
            theta.sin() * angle.sin(),
            theta.cos(),
        ]
    })
}

/// Seconds that this thread has spent on a processor, which other programs do not prolong; `None` where the
/// system does not tell.
fn processor_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split(' ').next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

/// The longest processor time between two questions while the hole in `arrays` is planned on one thread, the work before
/// the first and after the last one included.
fn longest_gap(arrays: &Arrays, method: Method) -> f64 {
    let mesh = mesh_of(arrays);
    let boundary = BoundaryLoops::find(&mesh);
    let index = MeshIndex::build(&mesh, &Job::unlimited()).unwrap();
    let options = with_method(method);
    let gaps = Mutex::new((None, 0.0_f64));
    let ask = || {
        let now = processor_seconds();
        let mut gaps = gaps.lock().unwrap();
        if let (Some(now), (Some(last), longest)) = (now, *gaps) {
            gaps.1 = longest.max(now - last);
        }
        gaps.0 = now;
        false
    };
    let planner = Planner {
        loops: &boundary.loops,
        index: &index,
        polyline: None,
        options: &options,
    };
    let (opening, job) = (Opening::of_loop(0), Job::new(&ask));
    let one_thread = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    one_thread.install(|| {
        ask();
        let plan = planner.plan(&mesh, &opening, &chain(&options)[..1], &job);
        assert!(plan.is_ok());
        ask();
    });
    gaps.into_inner().unwrap().1
}

#[test]
fn the_question_whether_to_stop_is_asked_often() {
    let smooth = wide_rim(20_000);
    let detailed = smooth.clone().jittered(5e-6, 1);
    for (method, arrays) in [
        (Method::Flat, &smooth),
        (Method::FairC2, &smooth),
        (Method::Auto, &detailed),
    ] {
        // The same work every time: what only one run shows is another program's use of the caches.
        let mut gap = f64::INFINITY;
        for _ in 0..3 {
            gap = gap.min(longest_gap(arrays, method));
            if gap < LONGEST_GAP {
                break;
            }
        }
        assert!(gap < LONGEST_GAP, "{method}: {gap:.3} s without a question");
    }
}
