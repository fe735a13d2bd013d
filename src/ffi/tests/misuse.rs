//! What is answered to callers who do what they must not: a documented status, and nothing is changed.

use super::*;

/// Every way to name an object that is not there.
fn strangers(own_kind: u64) -> Vec<u64> {
    let mesh = holed_mesh();
    let freed = {
        let other = holed_mesh();
        other.0.id
    };
    let living = mesh.0.id;
    let mut all = vec![
        0,
        1,
        u64::MAX,
        freed,
        living + (1 << 24),
        living ^ (1 << 50),
    ];
    // The same place and generation as another kind.
    all.extend(
        (1..16)
            .filter(|&kind| kind != own_kind)
            .map(|kind| living << 4 >> 4 | kind << 60),
    );
    all
}

#[test]
fn handles_of_nothing_are_refused_by_every_function() {
    for id in strangers(1) {
        let (mesh, none) = (HolefillMesh { id }, nothing());
        let mut count = 0_u64;
        let input = rows(&[0_u32, 1, 2], HOLEFILL_TYPE_U32);
        let mut numbers = [[0.0_f64; 3]; 1];
        let output = place(&mut numbers, HOLEFILL_TYPE_F64);
        let text = c"x".as_ptr();
        let no: *mut c_void = ptr::null_mut();
        // SAFETY: all pointers are null or to living values.
        let statuses = unsafe {
            let mut a = memory::blank();
            let mut b = memory::blank();
            let mut c = memory::blank();
            let mut d = memory::blank();
            let mut plan = HolefillPlan::default();
            vec![
                holefill_mesh_info(mesh, &mut a, none),
                holefill_mesh_defects(mesh, &mut b, none),
                holefill_mesh_prepare(mesh, none),
                holefill_mesh_read_positions(mesh, 0, &output, none),
                holefill_mesh_read_triangles(mesh, 0, &output, none),
                holefill_mesh_add_attribute(mesh, 1, text, 1, &input, none),
                holefill_mesh_attribute_count(mesh, 1, &mut count, none),
                holefill_mesh_attribute_info(mesh, 1, 0, &mut c, none),
                holefill_mesh_attribute_name(mesh, 1, 0, no.cast(), 0, &mut count, none),
                holefill_mesh_read_attribute(mesh, 1, 0, 0, &output, none),
                holefill_mesh_loop_count(mesh, &mut count, none),
                holefill_mesh_loop_info(mesh, 0, &mut d, none),
                holefill_mesh_read_loop(mesh, 0, 0, &output, none),
                holefill_mesh_find_edge(mesh, 0, 1, &mut count, none),
                holefill_mesh_find_vertices(mesh, &input, no.cast(), 0, &mut count, none),
                holefill_mesh_select(mesh, ptr::null(), no.cast(), 0, &mut count, none),
                holefill_mesh_fill_loop(mesh, 0, ptr::null(), no.cast(), none),
                holefill_mesh_fill_edge(mesh, 0, 1, ptr::null(), no.cast(), none),
                holefill_mesh_fill_vertices(mesh, &input, ptr::null(), no.cast(), none),
                holefill_mesh_fill_loops(mesh, &input, ptr::null(), no.cast(), none),
                holefill_mesh_fill_selected(mesh, ptr::null(), ptr::null(), no.cast(), none),
                holefill_mesh_plan_loop(mesh, 0, ptr::null(), &mut plan, none),
                holefill_mesh_plan_edge(mesh, 0, 1, ptr::null(), &mut plan, none),
                holefill_mesh_plan_vertices(mesh, &input, ptr::null(), &mut plan, none),
                holefill_mesh_plan_loops(mesh, &input, ptr::null(), &mut plan, none),
                holefill_mesh_plan_selected(mesh, ptr::null(), ptr::null(), &mut plan, none),
                holefill_mesh_undo(mesh, none),
            ]
        };
        for (k, status) in statuses.into_iter().enumerate() {
            assert_eq!(
                status, HOLEFILL_STATUS_INVALID_HANDLE,
                "{id:x}, function {k}"
            );
        }
        let freed = holefill_mesh_free(mesh);
        assert_eq!(freed == HOLEFILL_STATUS_OK, id == 0);
    }
    for id in strangers(2) {
        let (plan, none) = (HolefillPlan { id }, nothing());
        let mesh = holed_mesh();
        let before = digest(mesh.0);
        let mut report = HolefillReport::default();
        let mut numbers = [[0.0_f64; 3]; 1];
        let output = place(&mut numbers, HOLEFILL_TYPE_F64);
        // SAFETY: all pointers are null or to living values.
        let statuses = unsafe {
            let mut a = memory::blank();
            [
                holefill_plan_apply(plan, mesh.0, ptr::null(), ptr::null_mut(), none),
                holefill_plan_report(plan, &mut report, none),
                holefill_plan_patch(plan, 0, &mut a, none),
                holefill_plan_read_positions(plan, 0, 0, &output, none),
                holefill_plan_read_triangles(plan, 0, 0, &output, none),
            ]
        };
        assert_eq!(statuses, [HOLEFILL_STATUS_INVALID_HANDLE; 5], "{id:x}");
        assert_eq!(digest(mesh.0), before);
        assert_eq!(holefill_plan_free(plan) == HOLEFILL_STATUS_OK, id == 0);
    }
    for id in strangers(3) {
        let (report, none) = (HolefillReport { id }, nothing());
        let (mut length, mut method) = (0_u64, ptr::null());
        let no: *mut c_char = ptr::null_mut();
        // SAFETY: all pointers are null or to living values.
        let statuses = unsafe {
            let mut a = memory::blank();
            let mut b = memory::blank();
            let (mut c, mut score) = (memory::blank(), 0.0);
            [
                holefill_report_summary(report, &mut a, none),
                holefill_report_hole(report, 0, &mut b, none),
                holefill_report_reason(report, 0, no, 0, &mut length, none),
                holefill_report_tried(report, 0, 0, &mut method, no, 0, &mut length, none),
                holefill_report_prediction(report, 0, &mut c, none),
                holefill_report_score(report, 0, 0, &mut method, &mut score, none),
                holefill_report_crease_surface(report, 0, 0, &mut method, none),
                holefill_report_without_creases(report, 0, no, 0, &mut length, none),
            ]
        };
        assert_eq!(statuses, [HOLEFILL_STATUS_INVALID_HANDLE; 8], "{id:x}");
        assert_eq!(holefill_report_free(report) == HOLEFILL_STATUS_OK, id == 0);
    }
    for id in strangers(4) {
        let parameters = HolefillParameters { id };
        let (mut length, text) = (0_u64, c"refine.density".as_ptr());
        let mesh = holed_mesh();
        // SAFETY: all pointers are null or to living values.
        unsafe {
            let status = holefill_parameters_set(parameters, text, text, nothing());
            assert_eq!(status, HOLEFILL_STATUS_INVALID_HANDLE);
            let no = ptr::null_mut();
            let status = holefill_parameters_get(parameters, text, no, 0, &mut length, nothing());
            assert_eq!(status, HOLEFILL_STATUS_INVALID_HANDLE);
        }
        let with_parameters = HolefillFillOptions {
            parameters,
            ..options()
        };
        let status = fill_loop(mesh.0, 0, &with_parameters);
        let expected = match id {
            0 => HOLEFILL_STATUS_OK,
            _ => HOLEFILL_STATUS_INVALID_HANDLE,
        };
        assert_eq!(status, expected);
        assert_eq!(
            holefill_parameters_free(parameters) == HOLEFILL_STATUS_OK,
            id == 0
        );
    }
    for id in strangers(5) {
        let (error, mut length, mut status) = (HolefillError { id }, 0_u64, 0);
        // SAFETY: all pointers are null or to living values.
        unsafe {
            let no = ptr::null_mut();
            assert_eq!(
                holefill_error_message(error, no, 0, &mut length),
                HOLEFILL_STATUS_INVALID_HANDLE
            );
            assert_eq!(
                holefill_error_status(error, &mut status),
                HOLEFILL_STATUS_INVALID_HANDLE
            );
        }
        assert_eq!(holefill_error_free(error) == HOLEFILL_STATUS_OK, id == 0);
    }
}

#[test]
fn everything_can_be_freed_once() {
    let mesh = holed_mesh();
    let plan = plan_loop(mesh.0, 0, &options());
    let (mut report, mut parameters, mut error) = Default::default();
    // SAFETY: all pointers are null or to living values.
    unsafe {
        holefill_plan_report(plan, &mut report, nothing());
        holefill_parameters_new(&mut parameters, nothing());
        holefill_mesh_fill_loop(mesh.0, 99, ptr::null(), ptr::null_mut(), &mut error);
    }
    let free = |k: usize| match k {
        0 => holefill_plan_free(plan),
        1 => holefill_report_free(report),
        2 => holefill_parameters_free(parameters),
        3 => holefill_error_free(error),
        _ => holefill_mesh_free(mesh.0),
    };
    for k in 0..5 {
        assert_eq!(free(k), HOLEFILL_STATUS_OK, "{k}");
        assert_eq!(free(k), HOLEFILL_STATUS_INVALID_HANDLE, "{k}");
    }
}

/// Makes a mesh of three points and one triangle from views that `change` has spoiled.
fn spoiled(change: impl Fn(&mut HolefillInput, &mut HolefillInput)) -> (HolefillStatus, String) {
    let points = [[0.0_f64, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let faces = [[0_u32, 1, 2]];
    let mut positions = rows(&points, HOLEFILL_TYPE_F64);
    let mut triangles = rows(&faces, HOLEFILL_TYPE_U32);
    change(&mut positions, &mut triangles);
    let mut mesh = HolefillMesh { id: 77 };
    let mut error = HolefillError::default();
    // SAFETY: what the views say is checked before it is read, and the first rows are there.
    let status =
        unsafe { holefill_mesh_from_arrays(&positions, &triangles, &mut mesh, &mut error) };
    if status == HOLEFILL_STATUS_OK {
        holefill_mesh_free(mesh);
        return (status, String::new());
    }
    assert_eq!(mesh.id, 77, "an output is written only on success");
    let mut stored = 0;
    // SAFETY: the pointer is to a living value.
    unsafe { holefill_error_status(error, &mut stored) };
    assert_eq!(stored, status);
    let message = message(error);
    holefill_error_free(error);
    assert!(!message.is_empty());
    (status, message)
}

#[test]
fn arrays_that_cannot_be_are_refused() {
    let status = |change: &dyn Fn(&mut HolefillInput, &mut HolefillInput)| spoiled(change).0;
    assert_eq!(status(&|_, _| {}), HOLEFILL_STATUS_OK);
    for huge in [u64::MAX, u64::MAX / 2, u64::MAX / 24, 1 << 60] {
        assert_eq!(
            status(&|p, _| p.count = huge),
            HOLEFILL_STATUS_OVERFLOW,
            "{huge}"
        );
        assert_eq!(
            status(&|p, _| p.stride = huge),
            HOLEFILL_STATUS_OVERFLOW,
            "{huge}"
        );
        assert_eq!(
            status(&|_, t| (t.count, t.stride) = (2, huge)),
            HOLEFILL_STATUS_OVERFLOW
        );
    }
    for huge in [u64::MAX, u64::MAX / 2, 1 << 60] {
        let found = status(&|_, t| t.count = huge);
        assert_eq!(found, HOLEFILL_STATUS_OVERFLOW, "{huge}");
    }
    // Within the address space, but beyond any memory.
    let found = status(&|_, t| t.count = (1 << 55) / 12);
    assert_eq!(found, HOLEFILL_STATUS_OUT_OF_MEMORY);
    for stride in 1..24 {
        assert_eq!(
            status(&|p, _| p.stride = stride),
            HOLEFILL_STATUS_INVALID_ARGUMENT
        );
    }
    assert_eq!(
        status(&|_, t| t.stride = 11),
        HOLEFILL_STATUS_INVALID_ARGUMENT
    );
    for scalar_type in (0..20).chain([u32::MAX]) {
        let is_number = [HOLEFILL_TYPE_F32, HOLEFILL_TYPE_F64].contains(&scalar_type);
        if !is_number {
            let found = status(&|p, _| p.scalar_type = scalar_type);
            assert_eq!(found, HOLEFILL_STATUS_INVALID_ARGUMENT, "{scalar_type}");
        }
        let is_index = [HOLEFILL_TYPE_U32, HOLEFILL_TYPE_U64].contains(&scalar_type);
        if !is_index {
            let found = status(&|_, t| t.scalar_type = scalar_type);
            assert_eq!(found, HOLEFILL_STATUS_INVALID_ARGUMENT, "{scalar_type}");
        }
    }
    assert_eq!(
        status(&|p, _| p.reserved = 1),
        HOLEFILL_STATUS_INVALID_STRUCT
    );
    assert_eq!(
        status(&|p, _| p.data = ptr::null()),
        HOLEFILL_STATUS_NULL_POINTER
    );
    assert_eq!(
        status(&|_, t| t.data = ptr::null()),
        HOLEFILL_STATUS_NULL_POINTER
    );
    // Nothing at all is a mesh; triangles of nothing are not.
    let empty = |v: &mut HolefillInput| (v.data, v.count) = (ptr::null(), 0);
    assert_eq!(status(&|p, t| (empty(p), empty(t)).0), HOLEFILL_STATUS_OK);
    assert_eq!(status(&|p, _| empty(p)), HOLEFILL_STATUS_INDEX_OUT_OF_RANGE);
}

#[test]
fn numbers_that_cannot_be_are_refused_with_their_place() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let points = [[0.0, 0.0, 0.0], [1.0, bad, 0.0], [0.0, 1.0, 0.0]];
        let singles = points.map(|p: [f64; 3]| p.map(|c| c as f32));
        let views = [
            rows(&points, HOLEFILL_TYPE_F64),
            rows(&singles, HOLEFILL_TYPE_F32),
        ];
        for view in views {
            let (status, message) = spoiled(|p, _| *p = view);
            assert_eq!(status, HOLEFILL_STATUS_NOT_FINITE);
            assert!(message.contains("row 1"), "{message}");
            let mut mesh = HolefillMesh::default();
            // SAFETY: the views describe living memory.
            let status = unsafe {
                let none = ptr::null();
                holefill_mesh_from_polyline(&view, none, &mut mesh, nothing())
            };
            assert_eq!(status, HOLEFILL_STATUS_NOT_FINITE);
        }
    }
    for bad in [3_u64, u64::from(u32::MAX), 1 << 32, u64::MAX] {
        let wide = [[0_u64, bad, 1]];
        let (status, message) = spoiled(|_, t| *t = rows(&wide, HOLEFILL_TYPE_U64));
        assert_eq!(status, HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, "{bad}");
        assert!(message.contains(&bad.to_string()), "{message}");
    }
}

#[test]
fn structs_of_a_wrong_size_or_version_are_refused() {
    #[repr(C)]
    struct Longer {
        options: HolefillFillOptions,
        tail: [u8; 24],
    }
    let mesh = holed_mesh();
    let before = digest(mesh.0);
    let mut given = Longer {
        options: options(),
        tail: [0; 24],
    };
    let exact = size_of::<HolefillFillOptions>() as u32;
    let try_it = |given: &Longer| fill_loop(mesh.0, 0, &given.options);
    for size in [0, 1, 8, exact - 1, 4097, u32::MAX] {
        given.options.struct_size = size;
        assert_eq!(try_it(&given), HOLEFILL_STATUS_INVALID_STRUCT, "{size}");
    }
    given.options.struct_size = exact;
    for version in [0, 2, u32::MAX] {
        given.options.version = version;
        assert_eq!(try_it(&given), HOLEFILL_STATUS_INVALID_STRUCT, "{version}");
    }
    given.options.version = 1;
    for larger in 1..=24 {
        given.options.struct_size = exact + larger;
        given.tail[larger as usize - 1] = 1;
        assert_eq!(try_it(&given), HOLEFILL_STATUS_INVALID_STRUCT, "{larger}");
        given.tail[larger as usize - 1] = 0;
    }
    assert_eq!(digest(mesh.0), before);
    assert_eq!(try_it(&given), HOLEFILL_STATUS_OK);
    assert_eq!(given.tail, [0; 24]);

    // What is written is written as far as the caller's struct goes, and zero beyond what is known.
    #[repr(C)]
    struct LongerInfo {
        info: HolefillMeshInfo,
        tail: [u8; 16],
    }
    let mut info = LongerInfo {
        info: memory::blank(),
        tail: [9; 16],
    };
    info.info.struct_size += 8;
    // SAFETY: the pointer is to a living value of the stated size.
    let status = unsafe { holefill_mesh_info(mesh.0, (&raw mut info).cast(), nothing()) };
    assert_eq!(status, HOLEFILL_STATUS_OK);
    assert_eq!(info.tail, [0, 0, 0, 0, 0, 0, 0, 0, 9, 9, 9, 9, 9, 9, 9, 9]);
    info.info.struct_size = 4;
    // SAFETY: as above.
    let status = unsafe { holefill_mesh_info(mesh.0, (&raw mut info).cast(), nothing()) };
    assert_eq!(status, HOLEFILL_STATUS_INVALID_STRUCT);
    // SAFETY: as above.
    let status = unsafe { holefill_fill_options_init(&mut given.options, exact - 1) };
    assert_eq!(status, HOLEFILL_STATUS_INVALID_STRUCT);
    let mut rules = memory::blank::<HolefillSelection>();
    rules.keep_largest = 3;
    // SAFETY: the pointers are to living values of the stated sizes.
    unsafe {
        holefill_selection_init(&mut rules, size_of::<HolefillSelection>() as u32);
        holefill_fill_options_init(&mut given.options, exact + 24);
    }
    assert_eq!(
        (rules.keep_largest, given.options.struct_size),
        (0, exact + 24)
    );
}

#[test]
fn options_out_of_their_range_are_refused_and_nothing_is_filled() {
    let mesh = holed_mesh();
    let before = digest(mesh.0);
    let bad_text = c"fa\xffir";
    let changes: [&dyn Fn(&mut HolefillFillOptions) -> HolefillStatus; 8] = [
        &|o| {
            o.method = c"no such".as_ptr();
            HOLEFILL_STATUS_INVALID_ARGUMENT
        },
        &|o| {
            o.method = bad_text.as_ptr();
            HOLEFILL_STATUS_INVALID_ARGUMENT
        },
        &|o| {
            o.density = -1.0;
            HOLEFILL_STATUS_INVALID_ARGUMENT
        },
        &|o| {
            o.density = f64::NAN;
            HOLEFILL_STATUS_INVALID_ARGUMENT
        },
        &|o| {
            o.time_budget = -1.0;
            HOLEFILL_STATUS_INVALID_ARGUMENT
        },
        &|o| {
            o.time_budget = f64::INFINITY;
            HOLEFILL_STATUS_INVALID_ARGUMENT
        },
        &|o| {
            o.max_new_vertices = u64::MAX;
            HOLEFILL_STATUS_INVALID_ARGUMENT
        },
        &|o| {
            o.threads = 1025;
            HOLEFILL_STATUS_LIMIT
        },
    ];
    for (k, change) in changes.iter().enumerate() {
        let mut given = options();
        let expected = change(&mut given);
        assert_eq!(fill_loop(mesh.0, 0, &given), expected, "{k}");
    }
    assert_eq!(digest(mesh.0), before);
}

#[test]
fn what_is_not_there_is_not_found() {
    let mesh = holed_mesh();
    let before = digest(mesh.0);
    let size = info(mesh.0);
    let mut numbers = [[0.0_f64; 3]; 2];
    let output = place(&mut numbers, HOLEFILL_TYPE_F64);
    let mut id = 0;
    for far in [2, u64::from(u32::MAX) + 1, u64::MAX] {
        assert_eq!(
            fill_loop(mesh.0, far, &options()),
            HOLEFILL_STATUS_NOT_FOUND
        );
    }
    // SAFETY: all pointers are null or to living values.
    unsafe {
        for first in [size.vertex_count - 1, size.vertex_count, u64::MAX] {
            let status = holefill_mesh_read_positions(mesh.0, first, &output, nothing());
            assert_eq!(status, HOLEFILL_STATUS_NOT_FOUND);
        }
        for (from, to) in [(size.vertex_count, 0), (0, u64::MAX)] {
            let status = holefill_mesh_find_edge(mesh.0, from, to, &mut id, nothing());
            assert_eq!(status, HOLEFILL_STATUS_INDEX_OUT_OF_RANGE);
        }
        let [from, to] = loop_info(mesh.0, 0).edge;
        let mut error = HolefillError::default();
        let status = holefill_mesh_find_edge(mesh.0, to, from, &mut id, &mut error);
        assert_eq!(status, HOLEFILL_STATUS_NOT_FOUND);
        assert!(message(error).contains("runs from"));
        holefill_error_free(error);
        let chain = rows(&[0_u32, 1, 2], HOLEFILL_TYPE_U32);
        let no = ptr::null_mut();
        let status = holefill_mesh_fill_vertices(mesh.0, &chain, ptr::null(), no, nothing());
        assert_eq!(status, HOLEFILL_STATUS_NOT_FOUND);
        let bad_edge = [[0_u32, 1]];
        let mut rules = memory::blank::<HolefillSelection>();
        rules.only = rows(&bad_edge, HOLEFILL_TYPE_U32);
        let status =
            holefill_mesh_fill_selected(mesh.0, &rules, ptr::null(), ptr::null_mut(), nothing());
        assert_eq!(status, HOLEFILL_STATUS_INVALID_ARGUMENT);
        for element in [0, 3, u32::MAX] {
            let status = holefill_mesh_attribute_count(mesh.0, element, &mut id, nothing());
            assert_eq!(status, HOLEFILL_STATUS_INVALID_ARGUMENT);
        }
    }
    assert_eq!(digest(mesh.0), before);
}

#[test]
fn a_loop_that_is_closed_or_cannot_be_filled_is_refused() {
    let mesh = holed_mesh();
    fill_loop(mesh.0, 0, &options());
    let before = digest(mesh.0);
    assert_eq!(
        fill_loop(mesh.0, 0, &options()),
        HOLEFILL_STATUS_INVALID_ARGUMENT
    );
    assert_eq!(digest(mesh.0), before);
    let turned = mesh_of(&fixtures::moebius(12));
    let twisted = (0..loop_count(turned.0))
        .find(|&id| loop_info(turned.0, id).loop_class >= HOLEFILL_CLASS_NOT_ORIENTED);
    if let Some(id) = twisted {
        assert_eq!(
            fill_loop(turned.0, id, &options()),
            HOLEFILL_STATUS_TOPOLOGY
        );
        assert_eq!(fill_all(turned.0, &options()), HOLEFILL_STATUS_INCOMPLETE);
    }
}

#[test]
fn plans_that_no_longer_fit_are_refused() {
    let mesh = holed_mesh();
    let other = holed_mesh();
    let plan = plan_loop(mesh.0, 0, &options());
    assert_eq!(apply(plan, other.0), HOLEFILL_STATUS_STALE_PLAN);
    // A fill elsewhere does not matter, nor does its undo.
    fill_loop(mesh.0, 1, &options());
    let late = plan_loop(mesh.0, 0, &options());
    undo(mesh.0);
    let before = digest(mesh.0);
    assert_eq!(apply(late, mesh.0), HOLEFILL_STATUS_STALE_PLAN);
    assert_eq!(digest(mesh.0), before);
    assert_eq!(apply(plan, mesh.0), HOLEFILL_STATUS_OK);
    undo(mesh.0);
    let labels = vec![0_u8; info(mesh.0).vertex_count as usize];
    // SAFETY: all pointers are null or to living values.
    unsafe {
        let values = rows(&labels, HOLEFILL_TYPE_U8);
        holefill_mesh_add_attribute(mesh.0, 1, c"label".as_ptr(), 1, &values, nothing());
    }
    assert_eq!(apply(plan, mesh.0), HOLEFILL_STATUS_STALE_PLAN);
    holefill_plan_free(plan);
    holefill_plan_free(late);
}

#[test]
fn one_error_object_serves_many_calls() {
    let mesh = holed_mesh();
    let mut error = HolefillError { id: 12345 };
    // SAFETY: all pointers are null or to living values.
    unsafe {
        let none = ptr::null_mut();
        holefill_mesh_fill_loop(mesh.0, 40, ptr::null(), none, &mut error);
        let first = error;
        assert_ne!(first.id, 12345);
        assert!(message(error).contains("40"));
        holefill_mesh_fill_loop(mesh.0, 50, ptr::null(), none, &mut error);
        assert_eq!(error, first);
        assert!(message(error).contains("50"));
        holefill_mesh_prepare(mesh.0, &mut error);
        assert!(message(error).contains("50"), "success leaves it alone");
    }
    assert_eq!(holefill_error_free(error), HOLEFILL_STATUS_OK);
}

#[test]
fn a_panic_becomes_a_status_and_poisons_the_mesh_that_was_in_use() {
    let mesh = holed_mesh();
    let mut error = HolefillError::default();
    let panicking = guard::guard(&mut error, || {
        objects::with_mesh(mesh.0.id, |_| panic!("on purpose"))
    });
    assert_eq!(panicking, HOLEFILL_STATUS_PANIC);
    assert!(message(error).contains("on purpose"));
    holefill_error_free(error);
    assert_eq!(fill_loop(mesh.0, 0, &options()), HOLEFILL_STATUS_POISONED);
    let mut count = 0;
    // SAFETY: the pointer is to a living value.
    let status = unsafe { holefill_mesh_loop_count(mesh.0, &mut count, nothing()) };
    assert_eq!(status, HOLEFILL_STATUS_POISONED);
    let other = holed_mesh();
    let panicking = guard::guard(nothing(), || {
        objects::with_mesh_mut(other.0.id, |_| panic!("on purpose"))
    });
    assert_eq!(panicking, HOLEFILL_STATUS_PANIC);
    assert_eq!(undo(other.0), HOLEFILL_STATUS_POISONED);
    assert_eq!(holefill_mesh_free(other.0), HOLEFILL_STATUS_OK);
}
