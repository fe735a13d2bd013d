//! Null for every pointer argument in turn: refused where it is not allowed, and then nothing is changed.
//!
//! The header says which functions there are and which of their arguments are pointers: none can be left out here.

use super::*;

const HEADER: &str = include_str!("../../../include/holefill.h");

const OK: HolefillStatus = HOLEFILL_STATUS_OK;
const NULL: HolefillStatus = HOLEFILL_STATUS_NULL_POINTER;

/// The functions that the header declares, each with the names of its pointer arguments.
fn declared() -> Vec<(String, Vec<String>)> {
    let code: String = HEADER
        .lines()
        .filter(|line| !line.trim_start().starts_with(['*', '/', '#']))
        .flat_map(|line| [line, "\n"])
        .collect();
    let mut functions = Vec::new();
    for statement in code.split(';') {
        let Some((head, arguments)) = statement.split_once('(') else {
            continue;
        };
        let name = head.rsplit(|c: char| c.is_whitespace() || c == '*').next();
        let Some(name) = name.filter(|n| n.starts_with("holefill_")) else {
            continue;
        };
        let pointers = arguments
            .split(',')
            .filter_map(|argument| argument.rsplit_once('*'))
            .map(|(_, name)| name.trim().trim_end_matches(')').to_owned())
            .collect();
        functions.push((name.to_owned(), pointers));
    }
    functions
}

/// Everything that calls need, new for each of them.
struct World {
    mesh: Owned,
    plan: HolefillPlan,
    report: HolefillReport,
    predicted: HolefillReport,
    parameters: HolefillParameters,
    error: HolefillError,
    arrays: Arrays,
    chain: Vec<u64>,
    heat: Vec<f32>,
    options: HolefillFillOptions,
    out: Outputs,
    /// What `positions`, `triangles` and `row` write to.
    numbers: [f64; 3],
}

/// What calls write to.
#[derive(Debug)]
struct Outputs {
    mesh: HolefillMesh,
    plan: HolefillPlan,
    report: HolefillReport,
    parameters: HolefillParameters,
    number: u64,
    ids: [u64; 8],
    text: [c_char; 256],
    method: *const c_char,
    status: HolefillStatus,
    mesh_info: HolefillMeshInfo,
    defects: HolefillDefects,
    attribute_info: HolefillAttributeInfo,
    loop_info: HolefillLoopInfo,
    selection: HolefillSelection,
    fill_options: HolefillFillOptions,
    point_options: HolefillPointOptions,
    point_summary: HolefillPointSummary,
    patch_info: HolefillPatchInfo,
    hole: HolefillHole,
    summary: HolefillSummary,
    prediction: HolefillPrediction,
    score: f64,
}

impl World {
    fn new() -> Self {
        let arrays = holed();
        let mesh = mesh_of(&arrays);
        let heat = vec![0.5_f32; arrays.positions.len()];
        let values = rows(&heat, HOLEFILL_TYPE_F32);
        // A method that refuses the hole, so that the report has an attempt to tell of: there are too many vertices.
        let mut small = options();
        small.max_new_vertices = 1;
        small.method = c"fair-c2".as_ptr();
        let (mut report, mut parameters, mut error) = Default::default();
        // SAFETY: all pointers are null or to living values.
        unsafe {
            holefill_mesh_add_attribute(mesh.0, 1, c"heat".as_ptr(), 1, &values, nothing());
            holefill_mesh_fill_loop(mesh.0, 0, &small, &mut report, nothing());
            holefill_mesh_undo(mesh.0, nothing());
            holefill_parameters_new(&mut parameters, nothing());
            holefill_mesh_fill_loop(mesh.0, 99, ptr::null(), ptr::null_mut(), &mut error);
        }
        let out = Outputs {
            mesh: HolefillMesh::default(),
            plan: HolefillPlan::default(),
            report: HolefillReport::default(),
            parameters: HolefillParameters::default(),
            number: 77,
            ids: [77; 8],
            text: [77; 256],
            method: ptr::null(),
            status: -77,
            mesh_info: memory::blank(),
            defects: memory::blank(),
            attribute_info: memory::blank(),
            loop_info: memory::blank(),
            selection: memory::blank(),
            fill_options: memory::blank(),
            point_options: memory::blank(),
            point_summary: memory::blank(),
            patch_info: memory::blank(),
            hole: memory::blank(),
            summary: memory::blank(),
            prediction: memory::blank(),
            score: 77.0,
        };
        Self {
            plan: plan_loop(mesh.0, 0, &options()),
            chain: loop_vertices(mesh.0, 0),
            options: options(),
            numbers: [77.0; 3],
            mesh,
            report,
            predicted: report_of_creased(),
            parameters,
            error,
            arrays,
            heat,
            out,
        }
    }

    /// Everything that a call may change.
    fn state(&self) -> String {
        let mesh = digest(self.mesh.0);
        format!("{mesh} {:?} {:?}", self.out, self.numbers)
    }

    fn positions(&self) -> HolefillInput {
        rows(&self.arrays.positions, HOLEFILL_TYPE_F64)
    }

    fn triangles(&self) -> HolefillInput {
        rows(&self.arrays.triangles, HOLEFILL_TYPE_U32)
    }

    fn chain(&self) -> HolefillInput {
        rows(&self.chain, HOLEFILL_TYPE_U64)
    }

    fn heat(&self) -> HolefillInput {
        rows(&self.heat, HOLEFILL_TYPE_F32)
    }

    /// Room for one row.
    fn row(&mut self, scalar_type: HolefillType) -> HolefillOutput {
        HolefillOutput {
            count: 1,
            ..place(&mut self.numbers, scalar_type)
        }
    }
}

impl Drop for World {
    fn drop(&mut self) {
        holefill_mesh_free(self.out.mesh);
        holefill_plan_free(self.out.plan);
        holefill_plan_free(self.plan);
        holefill_report_free(self.out.report);
        holefill_report_free(self.report);
        holefill_report_free(self.predicted);
        holefill_parameters_free(self.out.parameters);
        holefill_parameters_free(self.parameters);
        holefill_error_free(self.error);
    }
}

trait Pointer: Sized {
    fn or_null(self, is_null: bool) -> Self;
}

impl<T> Pointer for *const T {
    fn or_null(self, is_null: bool) -> Self {
        if is_null { ptr::null() } else { self }
    }
}

impl<T> Pointer for *mut T {
    fn or_null(self, is_null: bool) -> Self {
        if is_null { ptr::null_mut() } else { self }
    }
}

/// A plain argument stands in parentheses; a pointer in brackets, with its name in the header and the status for null.
macro_rules! argument {
    ($null:expr, ($plain:expr)) => {
        $plain
    };
    ($null:expr, [$name:literal, $pointer:expr, $status:expr]) => {
        $pointer.or_null($null == Some($name))
    };
}

macro_rules! pointer {
    (($plain:expr)) => {
        None
    };
    ([$name:literal, $pointer:expr, $status:expr]) => {
        Some(($name, $status))
    };
}

/// Calls `$function` with none of its pointers null, and with each of them in turn. Returns its name and theirs.
macro_rules! with_nulls {
    ($w:ident: $function:ident, $($argument:tt),+) => {{
        let name = stringify!($function);
        let pointers: Vec<(&str, HolefillStatus)> =
            [$(pointer!($argument)),+].into_iter().flatten().collect();
        let turns = pointers.iter().map(|&(pointer, status)| (Some(pointer), status));
        for (null, expected) in std::iter::once((None, OK)).chain(turns) {
            let mut world = World::new();
            let $w = &mut world;
            let before = $w.state();
            // SAFETY: all pointers are null or to living values.
            let status = unsafe { $function($(argument!(null, $argument)),+) };
            assert_eq!(status, expected, "{name} with null for {null:?}");
            if status != OK {
                assert_eq!(world.state(), before, "{name} with null for {null:?}");
            }
        }
        let names: Vec<String> = pointers.iter().map(|&(name, _)| name.to_owned()).collect();
        (name.to_owned(), names)
    }};
}

#[test]
fn null_for_every_pointer_of_every_function() {
    const P: HolefillType = HOLEFILL_TYPE_F64;
    const I: HolefillType = HOLEFILL_TYPE_U32;
    const LOOPS: [u32; 1] = [0];
    let density = c"refine.density".as_ptr();
    let loops = rows(&LOOPS, HOLEFILL_TYPE_U32);
    let l = &raw const loops;
    let mut tested = vec![
        with_nulls!(w: holefill_error_status, (w.error), ["status", &raw mut w.out.status, NULL]),
        with_nulls!(w: holefill_error_message, (w.error), ["buffer", w.out.text.as_mut_ptr(), NULL], (256),
            ["length", &raw mut w.out.number, NULL]),
        with_nulls!(w: holefill_mesh_from_arrays, ["positions", ptr::from_ref(&w.positions()), NULL],
            ["triangles", ptr::from_ref(&w.triangles()), NULL], ["mesh", &raw mut w.out.mesh, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_from_polyline, ["points", ptr::from_ref(&w.positions()), NULL],
            ["normals", ptr::from_ref(&w.positions()), OK], ["mesh", &raw mut w.out.mesh, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_from_points, ["points", ptr::from_ref(&w.positions()), NULL],
            ["normals", ptr::from_ref(&w.positions()), OK], ["colors", ptr::from_ref(&w.positions()), OK],
            ["options", &raw const w.out.point_options, OK], ["mesh", &raw mut w.out.mesh, NULL],
            ["summary", &raw mut w.out.point_summary, OK], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_info, (w.mesh.0), ["info", &raw mut w.out.mesh_info, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_defects, (w.mesh.0), ["defects", &raw mut w.out.defects, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_prepare, (w.mesh.0), ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_read_positions, (w.mesh.0), (0), ["output", ptr::from_ref(&w.row(P)), NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_read_triangles, (w.mesh.0), (0), ["output", ptr::from_ref(&w.row(I)), NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_add_attribute, (w.mesh.0), (1), ["name", c"cold".as_ptr(), NULL], (1),
            ["values", ptr::from_ref(&w.heat()), NULL], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_attribute_count, (w.mesh.0), (1), ["count", &raw mut w.out.number, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_attribute_info, (w.mesh.0), (1), (0),
            ["info", &raw mut w.out.attribute_info, NULL], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_attribute_name, (w.mesh.0), (1), (0),
            ["buffer", w.out.text.as_mut_ptr(), NULL], (256), ["length", &raw mut w.out.number, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_read_attribute, (w.mesh.0), (1), (0), (0),
            ["output", ptr::from_ref(&w.row(HOLEFILL_TYPE_F32)), NULL], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_loop_count, (w.mesh.0), ["count", &raw mut w.out.number, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_loop_info, (w.mesh.0), (0), ["info", &raw mut w.out.loop_info, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_read_loop, (w.mesh.0), (0), (0), ["output", ptr::from_ref(&w.row(I)), NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_find_edge, (w.mesh.0), (w.chain[0]), (w.chain[1]),
            ["loop_id", &raw mut w.out.number, NULL], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_find_vertices, (w.mesh.0), ["vertices", ptr::from_ref(&w.chain()), NULL],
            ["ids", w.out.ids.as_mut_ptr(), NULL], (8), ["count", &raw mut w.out.number, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_select, (w.mesh.0), ["selection", &raw const w.out.selection, OK],
            ["ids", w.out.ids.as_mut_ptr(), NULL], (8), ["count", &raw mut w.out.number, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_selection_init, ["selection", &raw mut w.out.selection, NULL],
            (size_of::<HolefillSelection>() as u32)),
        with_nulls!(w: holefill_fill_options_init, ["options", &raw mut w.out.fill_options, NULL],
            (size_of::<HolefillFillOptions>() as u32)),
        with_nulls!(w: holefill_parameters_new, ["parameters", &raw mut w.out.parameters, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_parameters_set, (w.parameters), ["name", density, NULL],
            ["value", c"0.5".as_ptr(), NULL], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_parameters_get, (w.parameters), ["name", density, NULL],
            ["buffer", w.out.text.as_mut_ptr(), NULL], (256), ["length", &raw mut w.out.number, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_mesh_undo, (filled(w)), ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_plan_apply, (w.plan), (w.mesh.0), ["options", &raw const w.options, OK],
            ["report", &raw mut w.out.report, OK], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_plan_report, (w.plan), ["report", &raw mut w.out.report, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_plan_patch, (w.plan), (0), ["info", &raw mut w.out.patch_info, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_plan_read_positions, (w.plan), (0), (0), ["output", ptr::from_ref(&w.row(P)), NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_plan_read_triangles, (w.plan), (0), (0), ["output", ptr::from_ref(&w.row(I)), NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_report_summary, (w.report), ["summary", &raw mut w.out.summary, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_report_hole, (w.report), (0), ["hole", &raw mut w.out.hole, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_report_reason, (w.report), (0), ["buffer", w.out.text.as_mut_ptr(), NULL], (256),
            ["length", &raw mut w.out.number, NULL], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_report_tried, (w.report), (0), (0), ["method", &raw mut w.out.method, NULL],
            ["buffer", w.out.text.as_mut_ptr(), NULL], (256), ["length", &raw mut w.out.number, NULL],
            ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_report_prediction, (w.predicted), (0),
            ["prediction", &raw mut w.out.prediction, NULL], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_report_score, (w.predicted), (0), (0), ["candidate", &raw mut w.out.method, NULL],
            ["score", &raw mut w.out.score, NULL], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_report_crease_surface, (w.predicted), (0), (0),
            ["candidate", &raw mut w.out.method, NULL], ["error", &raw mut w.error, OK]),
        with_nulls!(w: holefill_report_without_creases, (w.predicted), (0), ["buffer", w.out.text.as_mut_ptr(), NULL],
            (256), ["length", &raw mut w.out.number, NULL], ["error", &raw mut w.error, OK]),
    ];
    // The fills, and the plans: alike but for what they hand out.
    macro_rules! fills_and_plans {
        ($($fill:ident, $plan:ident ($($argument:tt),*)),+ $(,)?) => {$(
            tested.push(with_nulls!(w: $fill, (w.mesh.0), $($argument,)* ["options", &raw const w.options, OK],
                ["report", &raw mut w.out.report, OK], ["error", &raw mut w.error, OK]));
            tested.push(with_nulls!(w: $plan, (w.mesh.0), $($argument,)* ["options", &raw const w.options, OK],
                ["plan", &raw mut w.out.plan, NULL], ["error", &raw mut w.error, OK]));
        )+};
    }
    let edge = loop_info(holed_mesh().0, 0).edge;
    let chain = loop_vertices(holed_mesh().0, 0);
    let chain = rows(&chain, HOLEFILL_TYPE_U64);
    let c = &raw const chain;
    let selection = memory::blank::<HolefillSelection>();
    let s = &raw const selection;
    fills_and_plans!(
        holefill_mesh_fill_loop,
        holefill_mesh_plan_loop((0)),
        holefill_mesh_fill_edge,
        holefill_mesh_plan_edge((edge[0]), (edge[1])),
        holefill_mesh_fill_vertices,
        holefill_mesh_plan_vertices(["vertices", c, NULL]),
        holefill_mesh_fill_loops,
        holefill_mesh_plan_loops(["loops", l, NULL]),
        holefill_mesh_fill_selected,
        holefill_mesh_plan_selected(["selection", s, OK]),
    );
    let mut expected = declared();
    assert!(expected.len() > 60, "{}", expected.len());
    expected.retain(|(_, pointers)| !pointers.is_empty());
    expected.sort();
    tested.sort();
    assert_eq!(tested, expected, "here, and in the header");
}

/// The mesh of `world`, with a hole filled.
fn filled(world: &World) -> HolefillMesh {
    let status = fill_loop(world.mesh.0, 0, &options());
    assert_eq!(status, OK);
    world.mesh.0
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
