//! Null for every pointer in turn: refused where it is not allowed, and then nothing is changed.

use super::*;

/// Calls `$function` with its arguments, of which those after `;` are pointers: with null for each of them in turn. The
/// list says which of them may be null.
macro_rules! with_nulls {
    ($mesh:expr, $function:ident($($plain:expr),* ; $($pointer:expr => $status:expr),* $(,)?)) => {{
        let expected = [$($status),*];
        for (turn, &expected) in expected.iter().enumerate() {
            let before = digest($mesh);
            let mut place = 0;
            // SAFETY: all pointers are null or to living values.
            #[allow(unused_assignments)]
            let status = unsafe {
                $function($($plain,)* $({
                    place += 1;
                    if place == turn + 1 { ptr::null_mut() } else { $pointer }
                }),*)
            };
            let name = stringify!($function);
            assert_eq!(status, expected, "{name}, pointer {turn}");
            assert_eq!(digest($mesh), before, "{name}, pointer {turn}");
        }
    }};
}

const OK: HolefillStatus = HOLEFILL_STATUS_OK;
const NULL: HolefillStatus = HOLEFILL_STATUS_NULL_POINTER;

#[test]
fn null_for_every_pointer_of_the_functions_that_read() {
    let owned = holed_mesh();
    let mesh = owned.0;
    let mut error = HolefillError::default();
    let e = &raw mut error;
    let mut number = 0_u64;
    let n = &raw mut number;
    let mut numbers = [[0.0_f64; 3]; 1];
    let mut output = place(&mut numbers, HOLEFILL_TYPE_F64);
    let o = &raw mut output;
    let mut indices = [[0_u32; 3]; 1];
    let mut index_output = place(&mut indices, HOLEFILL_TYPE_U32);
    let io = &raw mut index_output;
    let mut ids = [0_u64; 8];
    let mut chain = loop_vertices(mesh, 0);
    let mut vertices = rows(&chain, HOLEFILL_TYPE_U64);
    chain.rotate_left(1);
    let v = &raw mut vertices;
    let mut values = vec![0.5_f32; info(mesh).vertex_count as usize];
    let mut input = rows(&values, HOLEFILL_TYPE_F32);
    values[0] = 0.25;
    let i = &raw mut input;
    let name = c"heat".as_ptr().cast_mut();
    let mut buffer = [0 as c_char; 64];
    let b = buffer.as_mut_ptr();
    // SAFETY: all pointers are null or to living values.
    let added = unsafe { holefill_mesh_add_attribute(mesh, 1, name, 1, i, e) };
    assert_eq!(added, OK);
    let mut mesh_info = memory::blank::<HolefillMeshInfo>();
    let mut defects = memory::blank::<HolefillDefects>();
    let mut attribute = memory::blank::<HolefillAttributeInfo>();
    let mut l = memory::blank::<HolefillLoopInfo>();
    let mut rules = memory::blank::<HolefillSelection>();
    with_nulls!(mesh, holefill_mesh_info(mesh; &raw mut mesh_info => NULL, e => OK));
    with_nulls!(mesh, holefill_mesh_defects(mesh; &raw mut defects => NULL, e => OK));
    with_nulls!(mesh, holefill_mesh_prepare(mesh; e => OK));
    with_nulls!(mesh, holefill_mesh_read_positions(mesh, 0; o => NULL, e => OK));
    with_nulls!(mesh, holefill_mesh_read_triangles(mesh, 0; io => NULL, e => OK));
    with_nulls!(mesh, holefill_mesh_attribute_count(mesh, 1; n => NULL, e => OK));
    with_nulls!(mesh, holefill_mesh_attribute_info(mesh, 1, 0; &raw mut attribute => NULL, e => OK));
    with_nulls!(mesh, holefill_mesh_loop_count(mesh; n => NULL, e => OK));
    with_nulls!(mesh, holefill_mesh_loop_info(mesh, 0; &raw mut l => NULL, e => OK));
    with_nulls!(mesh, holefill_mesh_find_edge(mesh, loop_info(mesh, 0).edge[0], loop_info(mesh, 0).edge[1]; n => NULL, e => OK));
    // SAFETY: all pointers are null or to living values.
    let wrap = |v, ids, n, e| unsafe { holefill_mesh_find_vertices(mesh, v, ids, 8, n, e) };
    assert_eq!(wrap(ptr::null(), ids.as_mut_ptr(), n, e), NULL);
    assert_eq!(wrap(v, ptr::null_mut(), n, e), NULL);
    assert_eq!(wrap(v, ids.as_mut_ptr(), ptr::null_mut(), e), NULL);
    assert_eq!(wrap(v, ids.as_mut_ptr(), n, ptr::null_mut()), OK);
    // SAFETY: all pointers are null or to living values.
    let wrap = |r, ids, n, e| unsafe { holefill_mesh_select(mesh, r, ids, 8, n, e) };
    let r = &raw mut rules;
    assert_eq!(wrap(ptr::null(), ids.as_mut_ptr(), n, e), OK);
    assert_eq!(wrap(r, ptr::null_mut(), n, e), NULL);
    assert_eq!(wrap(r, ids.as_mut_ptr(), ptr::null_mut(), e), NULL);
    assert_eq!(wrap(r, ids.as_mut_ptr(), n, ptr::null_mut()), OK);
    // SAFETY: all pointers are null or to living values.
    let wrap = |b, n, e| unsafe { holefill_mesh_attribute_name(mesh, 1, 0, b, 64, n, e) };
    assert_eq!(wrap(ptr::null_mut(), n, e), NULL);
    assert_eq!(wrap(b, ptr::null_mut(), e), NULL);
    assert_eq!(wrap(b, n, ptr::null_mut()), OK);
    let mut heat = [[0_f32; 1]; 1];
    let mut heat_output = place(&mut heat, HOLEFILL_TYPE_F32);
    with_nulls!(mesh, holefill_mesh_read_attribute(mesh, 1, 0, 0; &raw mut heat_output => NULL, e => OK));
    let mut single = [0_u32; 1];
    let mut loop_output = place(&mut single, HOLEFILL_TYPE_U32);
    with_nulls!(mesh, holefill_mesh_read_loop(mesh, 0, 0; &raw mut loop_output => NULL, e => OK));
    // SAFETY: all pointers are null or to living values.
    let wrap = |name, i, e| unsafe { holefill_mesh_add_attribute(mesh, 1, name, 1, i, e) };
    assert_eq!(wrap(ptr::null(), i, e), NULL);
    assert_eq!(wrap(name, ptr::null(), e), NULL);
    holefill_error_free(error);
}

#[test]
fn null_for_every_pointer_of_the_functions_that_make_and_fill() {
    let arrays = holed();
    let owned = mesh_of(&arrays);
    let mesh = owned.0;
    let mut error = HolefillError::default();
    let e = &raw mut error;
    let mut positions = rows(&arrays.positions, HOLEFILL_TYPE_F64);
    let mut triangles = rows(&arrays.triangles, HOLEFILL_TYPE_U32);
    let (p, t) = (&raw mut positions, &raw mut triangles);
    let mut made = HolefillMesh::default();
    let mut parameters = HolefillParameters::default();
    // SAFETY: all pointers are null or to living values.
    unsafe {
        let none = ptr::null();
        let m = &raw mut made;
        assert_eq!(holefill_mesh_from_arrays(none, t, m, e), NULL);
        assert_eq!(holefill_mesh_from_arrays(p, none, m, e), NULL);
        assert_eq!(holefill_mesh_from_arrays(p, t, ptr::null_mut(), e), NULL);
        assert_eq!(holefill_mesh_from_polyline(none, none, m, e), NULL);
        assert_eq!(holefill_mesh_from_polyline(p, p, ptr::null_mut(), e), NULL);
        assert_eq!(holefill_parameters_new(ptr::null_mut(), e), NULL);
    }
    assert_eq!((made.id, parameters.id), (0, 0));
    // SAFETY: all pointers are null or to living values.
    unsafe {
        holefill_parameters_new(&mut parameters, e);
        let (text, none) = (c"refine.density".as_ptr(), ptr::null());
        assert_eq!(holefill_parameters_set(parameters, none, text, e), NULL);
        assert_eq!(holefill_parameters_set(parameters, text, none, e), NULL);
        let (mut length, no) = (0, ptr::null_mut());
        assert_eq!(
            holefill_parameters_get(parameters, none, no, 0, &mut length, e),
            NULL
        );
        assert_eq!(
            holefill_parameters_get(parameters, text, no, 1, &mut length, e),
            NULL
        );
        assert_eq!(
            holefill_parameters_get(parameters, text, no, 0, ptr::null_mut(), e),
            NULL
        );
        assert_eq!(holefill_fill_options_init(ptr::null_mut(), 112), NULL);
        assert_eq!(holefill_selection_init(ptr::null_mut(), 112), NULL);
        let mut plan = HolefillPlan::default();
        let options = options();
        let o = &raw const options;
        let before = digest(mesh);
        assert_eq!(
            holefill_mesh_plan_loop(mesh, 0, o, ptr::null_mut(), e),
            NULL
        );
        assert_eq!(
            holefill_mesh_plan_loops(mesh, ptr::null(), o, &mut plan, e),
            NULL
        );
        assert_eq!(
            holefill_mesh_plan_vertices(mesh, ptr::null(), o, &mut plan, e),
            NULL
        );
        assert_eq!(
            holefill_mesh_fill_loops(mesh, ptr::null(), o, ptr::null_mut(), e),
            NULL
        );
        assert_eq!(
            holefill_mesh_fill_vertices(mesh, ptr::null(), o, ptr::null_mut(), e),
            NULL
        );
        assert_eq!(plan.id, 0);
        assert_eq!(
            holefill_mesh_plan_loop(mesh, 0, ptr::null(), &mut plan, ptr::null_mut()),
            OK
        );
        let mut report = HolefillReport::default();
        assert_eq!(holefill_plan_report(plan, ptr::null_mut(), e), NULL);
        assert_eq!(holefill_plan_report(plan, &mut report, ptr::null_mut()), OK);
        assert_eq!(holefill_plan_patch(plan, 0, ptr::null_mut(), e), NULL);
        assert_eq!(
            holefill_plan_read_positions(plan, 0, 0, ptr::null(), e),
            NULL
        );
        assert_eq!(
            holefill_plan_read_triangles(plan, 0, 0, ptr::null(), e),
            NULL
        );
        assert_eq!(holefill_report_summary(report, ptr::null_mut(), e), NULL);
        assert_eq!(holefill_report_hole(report, 0, ptr::null_mut(), e), NULL);
        assert_eq!(
            holefill_report_reason(report, 0, no, 5, &mut length, e),
            NULL
        );
        assert_eq!(
            holefill_report_reason(report, 0, no, 0, ptr::null_mut(), e),
            NULL
        );
        assert_eq!(holefill_error_message(error, no, 1, &mut length), NULL);
        assert_eq!(holefill_error_message(error, no, 0, ptr::null_mut()), NULL);
        assert_eq!(holefill_error_status(error, ptr::null_mut()), NULL);
        assert_eq!(digest(mesh), before);
        holefill_report_free(report);
        holefill_plan_free(plan);
    }
    holefill_parameters_free(parameters);
    holefill_error_free(error);
}

#[test]
fn a_view_whose_data_is_null_is_refused_unless_it_is_empty() {
    let mesh = holed_mesh();
    let empty = HolefillOutput {
        data: ptr::null_mut(),
        count: 0,
        stride: 0,
        scalar_type: HOLEFILL_TYPE_F64,
        reserved: 0,
    };
    let one = HolefillOutput { count: 1, ..empty };
    let huge = HolefillOutput {
        count: u64::MAX / 12,
        ..empty
    };
    // SAFETY: all pointers are null or to living values.
    unsafe {
        let read = |o: &HolefillOutput| holefill_mesh_read_positions(mesh.0, 0, o, nothing());
        assert_eq!(read(&empty), OK);
        assert_eq!(read(&one), NULL);
        assert_eq!(read(&huge), HOLEFILL_STATUS_OVERFLOW);
    }
}
