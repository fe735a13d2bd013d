//! Many threads on the same and on their own meshes.

use super::*;
use crate::fixtures::Noise;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

const THREADS: usize = 8;

/// Calls of each thread: `HOLEFILL_HAMMER` in the environment, or few.
fn call_count() -> usize {
    let text = std::env::var("HOLEFILL_HAMMER").unwrap_or_default();
    text.parse().unwrap_or(150)
}

fn small() -> Arrays {
    fixtures::sphere(6).cut(|c| c[2] > 0.75 || c[2] < -0.8)
}

/// One random call on a mesh; the statuses that it may have.
fn random_call(
    mesh: HolefillMesh,
    noise: &mut Noise,
) -> (HolefillStatus, &'static [HolefillStatus]) {
    const READS: &[HolefillStatus] = &[OK, BUSY];
    const FILLS: &[HolefillStatus] = &[OK, BUSY, INVALID];
    const UNDOES: &[HolefillStatus] = &[OK, BUSY, NOTHING_TO_UNDO];
    const APPLIES: &[HolefillStatus] = &[OK, INCOMPLETE, BUSY, INVALID, STALE_PLAN];
    let id = u64::from(noise.below(2));
    let options = with_method([c"flat", c"membrane", c"fair-c1"][noise.below(3) as usize]);
    let mut number = 0;
    let mut point = [[0.0_f64; 3]; 3];
    let output = place(&mut point);
    match noise.below(12) {
        0..3 => (call!(holefill_mesh_loop_count: mesh, &mut number), READS),
        3..6 => (call!(holefill_mesh_read_positions: mesh, 1, &output), READS),
        6 => (
            call!(holefill_mesh_loop_info: mesh, id, &mut Default::default()),
            READS,
        ),
        7..9 => (fill_loop(mesh, id, &options), FILLS),
        9 => (undo(mesh), UNDOES),
        planned => {
            let mut plan = Owned(HolefillPlan::default());
            let status = call!(holefill_mesh_plan: mesh, &at_loop(id), &options, &mut plan.0);
            if status == OK && planned == 10 {
                return (apply(&plan, mesh), APPLIES);
            }
            (status, FILLS)
        }
    }
}

/// Undoes everything and fills with `fair-c1`.
fn settle(mesh: HolefillMesh) -> u64 {
    while undo(mesh) == OK {}
    assert_eq!(fill_all(mesh, &with_method(c"fair-c1")), OK);
    digest(mesh)
}

#[test]
fn eight_threads_on_shared_and_own_meshes_leave_what_one_thread_leaves() {
    let arrays = small();
    let keep: Vec<Owned<HolefillMesh>> = (0..3).map(|_| mesh_of(&arrays)).collect();
    let ids: Vec<HolefillMesh> = keep.iter().map(|m| m.0).collect();
    let run = |seed: usize| {
        let own = mesh_of(&arrays);
        let mut noise = Noise(seed as u64);
        let mut trace = Vec::new();
        for _ in 0..call_count() {
            if noise.below(2) == 0 {
                let mesh = ids[noise.below(3) as usize];
                let (status, allowed) = random_call(mesh, &mut noise);
                assert!(allowed.contains(&status), "{status} on a shared mesh");
            } else {
                // Nobody else uses it: the same statuses and states in every run.
                let (status, allowed) = random_call(own.0, &mut noise);
                assert!(allowed.contains(&status), "{status} on an own mesh");
                assert_ne!(status, BUSY);
                trace.push(status);
            }
        }
        (trace, digest(own.0))
    };
    let alone: Vec<_> = (0..THREADS).map(run).collect();
    let together: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS)
            .map(|seed| scope.spawn(move || run(seed)))
            .collect();
        threads.into_iter().map(|t| t.join().unwrap()).collect()
    });
    assert_eq!(alone, together);
    let fresh = mesh_of(&arrays);
    let expected = settle(fresh.0);
    for mesh in ids {
        assert_eq!(settle(mesh), expected);
    }
}

#[test]
fn a_mesh_may_be_freed_while_it_is_filled() {
    let arrays = holed();
    for turn in 0..6 {
        let owned = mesh_of(&arrays);
        let mesh = owned.0;
        let (is_running, wait) = (AtomicBool::new(false), turn * 300);
        unsafe extern "C" fn note(_: *const HolefillProgress, data: *mut c_void) -> i32 {
            // SAFETY: the test hands its flag over.
            unsafe { &*data.cast::<AtomicBool>() }.store(true, Ordering::Relaxed);
            0
        }
        let status = std::thread::scope(|scope| {
            let flag = &is_running;
            let filling = scope.spawn(move || {
                let options = HolefillFillOptions {
                    progress: Some(note),
                    progress_data: std::ptr::from_ref(flag).cast_mut().cast(),
                    density: 0.2,
                    ..with_method(c"fair-c2")
                };
                fill_all(mesh, &options)
            });
            while !is_running.load(Ordering::Relaxed) && !filling.is_finished() {
                std::thread::yield_now();
            }
            std::thread::sleep(std::time::Duration::from_micros(wait));
            assert_eq!(holefill_mesh_free(mesh), OK);
            filling.join().unwrap()
        });
        assert_eq!(status, OK);
        assert_eq!(undo(mesh), INVALID_HANDLE);
    }
}

/// From within a callback the mesh that is being filled is busy, one that is being planned can be read, others are free,
/// and even the mesh itself may be freed.
#[test]
fn callbacks_may_call_the_library() {
    struct Seen {
        mesh: HolefillMesh,
        other: HolefillMesh,
        calls: AtomicUsize,
        read: HolefillStatus,
        written: HolefillStatus,
        elsewhere: HolefillStatus,
    }
    unsafe extern "C" fn call(_: *const HolefillProgress, data: *mut c_void) -> i32 {
        // SAFETY: the test hands its record over; calls come one at a time.
        let seen = unsafe { &mut *data.cast::<Seen>() };
        let mut count = 0;
        // SAFETY: the pointer is to a living value.
        seen.read = unsafe { holefill_mesh_loop_count(seen.mesh, &mut count, nothing()) };
        seen.written = undo(seen.mesh);
        if seen.calls.fetch_add(1, Ordering::Relaxed) == 0 {
            seen.elsewhere = fill_loop(seen.other, 0, &options());
        }
        0
    }
    let (mesh, other) = (holed_mesh(), holed_mesh());
    let mut seen = Seen {
        mesh: mesh.0,
        other: other.0,
        calls: AtomicUsize::new(0),
        read: -1,
        written: -1,
        elsewhere: -1,
    };
    let options = HolefillFillOptions {
        progress: Some(call),
        progress_data: (&raw mut seen).cast(),
        ..options()
    };
    let _plan = plan_loop(mesh.0, 0, &options);
    assert_eq!((seen.read, seen.written, seen.elsewhere), (OK, BUSY, OK));
    assert_eq!(fill_loop(mesh.0, 0, &options), OK);
    assert_eq!((seen.read, seen.written), (BUSY, BUSY));
}
