//! What is answered to callers who do what they must not: a documented status, and nothing is changed. Wrong pointers,
//! handles and rows of numbers are in `refusals`.

use super::*;

/// What calls with a struct of the caller need.
struct World {
    mesh: Owned<HolefillMesh>,
    report: Owned<HolefillReport>,
    plan: Owned<HolefillPlan>,
    points: Vec<[f64; 3]>,
}

impl World {
    fn new() -> Self {
        let mesh = holed_mesh();
        let labels = vec![7_u8; info(mesh.0).vertex_count as usize];
        let values = rows(&labels);
        call!(holefill_mesh_add_attribute: mesh.0, 1, c"label".as_ptr(), 1, &values);
        Self {
            report: report_of(mesh.0, &at_loop(0), &with_method(c"auto")).1,
            plan: plan_loop(mesh.0, 1, &with_method(c"flat")),
            points: holed().positions,
            mesh,
        }
    }

    /// Makes a mesh from points.
    fn points(
        &self,
        options: *const HolefillPointOptions,
        summary: *mut HolefillPointSummary,
    ) -> HolefillStatus {
        let points = rows(&self.points);
        let (none, mut mesh) = (ptr::null(), Owned(HolefillMesh::default()));
        let place = &mut mesh.0;
        call!(holefill_mesh_from_points: &points, none, none, options, place, summary)
    }

    /// Finds the loops that rules choose.
    fn find(&self, selection: *const HolefillSelection) -> HolefillStatus {
        let target = HolefillTarget {
            selection,
            ..every_loop()
        };
        call!(holefill_mesh_find_loops: self.mesh.0, &target, ptr::null_mut(), 0, &mut 0)
    }

    /// Plans the second loop.
    fn plan(
        &self,
        target: *const HolefillTarget,
        options: *const HolefillFillOptions,
    ) -> HolefillStatus {
        let mut plan = Owned(HolefillPlan::default());
        call!(holefill_mesh_plan: self.mesh.0, target, options, &mut plan.0)
    }
}

/// A struct that begins with its size: its name, its size in the first header that had it, whether the library writes it,
/// and a call with one.
type Case = (
    &'static str,
    u32,
    bool,
    fn(&World, *mut u64) -> HolefillStatus,
);

macro_rules! structs {
    ($($name:literal $size:literal $is_written:literal ($w:ident, $room:ident) $call:expr;)*) => {
        const STRUCTS: &[Case] = &[$(($name, $size, $is_written, |$w, $room| $call)),*];
    };
}
// The sizes are numbers on purpose: programs were compiled with them.
structs! {
    "mesh info" 56 true (w, room) call!(holefill_mesh_info: w.mesh.0, room.cast());
    "defects" 48 true (w, room) call!(holefill_mesh_defects: w.mesh.0, room.cast());
    "attribute info" 24 true (w, room) call!(holefill_mesh_attribute_info: w.mesh.0, 1, 0, room.cast());
    "loop info" 104 true (w, room) call!(holefill_mesh_loop_info: w.mesh.0, 1, room.cast());
    "selection" 96 false (w, room) w.find(room.cast());
    "target" 56 false (w, room) w.plan(room.cast(), ptr::null());
    "fill options" 96 false (w, room) w.plan(&at_loop(1), room.cast());
    "point options" 48 false (w, room) w.points(room.cast(), ptr::null_mut());
    "point summary" 80 true (w, room) w.points(ptr::null(), room.cast());
    "patch info" 32 true (w, room) call!(holefill_plan_patch: w.plan.0, 1, room.cast());
    "hole" 128 true (w, room) call!(holefill_report_hole: w.report.0, 0, room.cast());
    "prediction" 56 true (w, room) call!(holefill_report_prediction: w.report.0, 0, room.cast());
    "summary" 80 true (w, room) call!(holefill_report_summary: w.report.0, room.cast());
}

#[test]
fn structs_of_older_and_newer_headers_are_read_and_written_as_far_as_they_go() {
    const MARK: u64 = 0x5555_5555_5555_5555;
    let world = World::new();
    for &(name, size, is_written, call) in STRUCTS {
        let rest = if is_written { MARK } else { 0 };
        // The two numbers are the first word: the size and the version. `beyond` is what follows the size.
        let check = |size: u32, version: u32, beyond: u64, expected| {
            let known = (size as usize / 8).clamp(1, 64);
            let mut room = [rest; 64];
            room[known..].fill(beyond);
            room[0] = u64::from(size) | u64::from(version) << 32;
            let before = room;
            let what = format!("{name} of {size} bytes and version {version}");
            assert_eq!(call(&world, room.as_mut_ptr()), expected, "{what}");
            assert!(expected == OK || room == before, "{what}");
            // What lies behind the struct is neither read nor written.
            assert_eq!(room[known..], before[known..], "{what}");
            room
        };
        let full = check(size, 1, rest, OK);
        for wrong in [0, 1, 4, 7, size - 4, size - 1, 4097, u32::MAX] {
            check(wrong, 1, rest, INVALID_STRUCT);
        }
        for version in [0, 2, u32::MAX] {
            check(size, version, rest, INVALID_STRUCT);
        }
        let words = size as usize / 8;
        for given in 1..=words + 8 {
            let room = check(8 * given as u32, 1, MARK, OK);
            if is_written {
                let known = given.min(words);
                assert_eq!(room[1..known], full[1..known], "{name} of {given} words");
                assert!(room[known..given].iter().all(|&w| w == 0), "{name}");
            } else if given > words {
                let mut room = room;
                room[given - 1] = 1;
                assert_eq!(call(&world, room.as_mut_ptr()), INVALID_STRUCT, "{name}");
            }
        }
    }
}

#[test]
fn options_out_of_their_range_are_refused_and_nothing_is_filled() {
    let mesh = holed_mesh();
    let before = digest(mesh.0);
    let changes: [Change<HolefillFillOptions>; 10] = [
        (|o| o.method = c"no such".as_ptr(), INVALID),
        (|o| o.method = c"fa\xffir".as_ptr(), INVALID),
        (|o| o.density = -1.0, INVALID),
        (|o| o.density = f64::NAN, INVALID),
        (|o| o.time_budget = -1.0, INVALID),
        (|o| o.time_budget = f64::NAN, INVALID),
        (|o| o.time_budget = f64::INFINITY, INVALID),
        (|o| o.max_new_vertices = u64::MAX, INVALID),
        (|o| o.threads = 1025, LIMIT),
        (|o| o.parameters.id = 99, INVALID_HANDLE),
    ];
    for (k, (change, expected)) in changes.into_iter().enumerate() {
        let mut given = options();
        change(&mut given);
        assert_eq!(fill_loop(mesh.0, 0, &given), expected, "{k}");
    }
    assert_eq!(digest(mesh.0), before);
}

#[test]
fn what_is_not_there_is_not_found() {
    let mesh = holed_mesh();
    let before = digest(mesh.0);
    let count = info(mesh.0).vertex_count;
    let [from, to] = loop_info(mesh.0, 0).edge;
    let chain = rows(&[0_u32, 1, 2]);
    let far = rows(&[0_u64, u64::MAX - 9]);
    let none = rows(&[0_u32, 2]);
    let negative = rows(&[-1_i32]);
    let edge = [[0_u32, 1]];
    let bad_edge = HolefillSelection {
        only: rows(&edge),
        ..Default::default()
    };
    let reserved = HolefillTarget {
        reserved: 1,
        ..every_loop()
    };
    for (target, expected) in [
        (at_loop(2), NOT_FOUND),
        (at_loop(u64::from(u32::MAX) + 1), NOT_FOUND),
        (at_loop(u64::MAX), NOT_FOUND),
        (at_edge([to, from]), NOT_FOUND),
        (at_edge([from, from]), NOT_FOUND),
        (at_edge([count, 0]), OUT_OF_RANGE),
        (at_edge([0, u64::MAX]), OUT_OF_RANGE),
        (at_ids(HOLEFILL_TARGET_VERTICES, &chain), NOT_FOUND),
        (at_ids(HOLEFILL_TARGET_LOOPS, &none), NOT_FOUND),
        (at_ids(HOLEFILL_TARGET_LOOPS, &far), OUT_OF_RANGE),
        (at_ids(HOLEFILL_TARGET_LOOPS, &negative), INVALID),
        (target(HOLEFILL_TARGET_LOOPS), NULL),
        (target(HOLEFILL_TARGET_VERTICES), NULL),
        (selected(&bad_edge), INVALID),
        (target(5), INVALID),
        (target(u32::MAX), INVALID),
        (reserved, INVALID_STRUCT),
    ] {
        let (status, report) = report_of(mesh.0, &target, &options());
        assert_eq!((status, report.0.id), (expected, 0), "{target:?}");
        let mut plan = HolefillPlan::default();
        let status = call!(holefill_mesh_plan: mesh.0, &target, ptr::null(), &mut plan);
        assert_eq!((status, plan.id), (expected, 0), "{target:?}");
        assert_eq!(found(mesh.0, &target), Err(expected), "{target:?}");
    }
    let mut numbers = [[0.0_f64; 3]; 2];
    let output = place(&mut numbers);
    let mut id = 0;
    for first in [count - 1, count, u64::MAX] {
        let status = call!(holefill_mesh_read_positions: mesh.0, first, &output);
        assert_eq!(status, NOT_FOUND);
    }
    let (turned, no) = (at_edge([to, from]), ptr::null_mut());
    let (_, text) = said!(holefill_mesh_find_loops: mesh.0, &turned, no, 0, &mut id);
    assert!(text.contains("runs from"), "{text}");
    for element in [0, 3, u32::MAX] {
        let status = call!(holefill_mesh_attribute_count: mesh.0, element, &mut id);
        assert_eq!(status, INVALID);
    }
    assert_eq!(digest(mesh.0), before);
}

#[test]
fn a_loop_that_is_closed_or_cannot_be_filled_is_refused() {
    let mesh = holed_mesh();
    fill_loop(mesh.0, 0, &options());
    let before = digest(mesh.0);
    assert_eq!(fill_loop(mesh.0, 0, &options()), INVALID);
    assert_eq!(digest(mesh.0), before);
    let turned = mesh_of(&fixtures::moebius(12));
    let twisted = (0..loop_count(turned.0))
        .find(|&id| loop_info(turned.0, id).loop_class >= HOLEFILL_CLASS_NOT_ORIENTED);
    if let Some(id) = twisted {
        assert_eq!(fill_loop(turned.0, id, &options()), TOPOLOGY);
        assert_eq!(fill_all(turned.0, &options()), INCOMPLETE);
    }
}

#[test]
fn plans_that_no_longer_fit_are_refused() {
    let mesh = holed_mesh();
    let other = holed_mesh();
    let plan = plan_loop(mesh.0, 0, &options());
    assert_eq!(apply(&plan, other.0), STALE_PLAN);
    // A fill elsewhere does not matter, nor does its undo.
    fill_loop(mesh.0, 1, &options());
    let late = plan_loop(mesh.0, 0, &options());
    undo(mesh.0);
    let before = digest(mesh.0);
    assert_eq!(apply(&late, mesh.0), STALE_PLAN);
    assert_eq!(digest(mesh.0), before);
    assert_eq!(apply(&plan, mesh.0), OK);
    undo(mesh.0);
    let labels = vec![0_u8; info(mesh.0).vertex_count as usize];
    let values = rows(&labels);
    call!(holefill_mesh_add_attribute: mesh.0, 1, c"label".as_ptr(), 1, &values);
    assert_eq!(apply(&plan, mesh.0), STALE_PLAN);
}

#[test]
fn one_error_object_serves_many_calls() {
    let mesh = holed_mesh();
    let mut error = HolefillError { id: 12345 };
    // SAFETY: all pointers are null or to living values.
    unsafe {
        let none = ptr::null_mut();
        holefill_mesh_fill(mesh.0, &at_loop(40), ptr::null(), none, &mut error);
        let first = error;
        assert_ne!(first.id, 12345);
        assert!(message(error).contains("40"));
        holefill_mesh_fill(mesh.0, &at_loop(50), ptr::null(), none, &mut error);
        assert_eq!(error, first);
        assert!(message(error).contains("50"));
        holefill_mesh_prepare(mesh.0, &mut error);
        assert!(message(error).contains("50"), "success leaves it alone");
    }
    assert_eq!(holefill_error_free(error), OK);
}

#[test]
fn a_panic_becomes_a_status_and_poisons_the_mesh_that_was_in_use() {
    let mesh = holed_mesh();
    let mut error = HolefillError::default();
    let panicking = guard::guard(&mut error, || {
        mesh.0.with(|_| -> Result<(), _> { panic!("on purpose") })
    });
    assert_eq!(panicking, PANIC);
    assert!(message(error).contains("on purpose"));
    holefill_error_free(error);
    assert_eq!(fill_loop(mesh.0, 0, &options()), POISONED);
    let mut count = 0;
    let status = call!(holefill_mesh_loop_count: mesh.0, &mut count);
    assert_eq!(status, POISONED);
    let other = holed_mesh();
    let panicking = guard::guard(nothing(), || {
        objects::with_mesh_mut::<()>(other.0, |_| panic!("on purpose"))
    });
    assert_eq!(panicking, PANIC);
    assert_eq!(undo(other.0), POISONED);
    assert_eq!(holefill_mesh_free(other.0), OK);
}
