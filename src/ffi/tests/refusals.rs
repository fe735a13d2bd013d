//! Wrong arguments for every function in turn: null for a pointer that must not be null, and a handle of nothing. Each has
//! its status, and then nothing is changed.
//!
//! The header says which functions there are, and which of their arguments are pointers and handles: none can be left out
//! here.

use super::objects::{ERROR, MESH, PARAMETERS, PLAN, REPORT};
use super::*;

const HEADER: &str = include_str!("../../../include/holefill.h");

const OK: HolefillStatus = HOLEFILL_STATUS_OK;
const NULL: HolefillStatus = HOLEFILL_STATUS_NULL_POINTER;

const HANDLES: [(&str, u8); 5] = [
    ("HolefillMesh", MESH),
    ("HolefillPlan", PLAN),
    ("HolefillReport", REPORT),
    ("HolefillParameters", PARAMETERS),
    ("HolefillError", ERROR),
];

/// The functions that the header declares, each with the names of its pointers and the types of its handles. Those that
/// free are left out: they take the handle 0.
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
        let Some(name) = name.filter(|n| n.starts_with("holefill_") && !n.ends_with("_free"))
        else {
            continue;
        };
        let checked = |argument: &str| match argument.rsplit_once('*') {
            Some((_, name)) => Some(name.trim().trim_end_matches(')').to_owned()),
            None => {
                let is_handle = |word: &&str| HANDLES.iter().any(|h| h.0 == *word);
                argument
                    .split_whitespace()
                    .find(is_handle)
                    .map(str::to_owned)
            }
        };
        functions.push((
            name.to_owned(),
            arguments.split(',').filter_map(checked).collect(),
        ));
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
    target: HolefillTarget,
    out: Outputs,
    /// Room for a long text.
    long: Vec<c_char>,
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
}

impl World {
    fn new() -> Self {
        let arrays = holed();
        let (mesh, predicted) = (mesh_of(&arrays), holed_mesh());
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
            holefill_mesh_fill(mesh.0, &at_loop(0), &small, &mut report, nothing());
            holefill_mesh_undo(mesh.0, nothing());
            holefill_parameters_new(&mut parameters, nothing());
            holefill_mesh_fill(
                mesh.0,
                &at_loop(99),
                ptr::null(),
                ptr::null_mut(),
                &mut error,
            );
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
            mesh_info: structs::blank(),
            defects: structs::blank(),
            attribute_info: structs::blank(),
            loop_info: structs::blank(),
            selection: structs::blank(),
            fill_options: structs::blank(),
            point_options: structs::blank(),
            point_summary: structs::blank(),
            patch_info: structs::blank(),
            hole: structs::blank(),
            summary: structs::blank(),
            prediction: structs::blank(),
        };
        Self {
            plan: plan_loop(mesh.0, 0, &options()),
            chain: loop_vertices(mesh.0, 0),
            options: options(),
            target: at_loop(0),
            numbers: [77.0; 3],
            long: vec![77; 4096],
            mesh,
            report,
            predicted: report_of(predicted.0, &at_loop(0), &with_method(c"auto")).1,
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
        format!("{mesh} {:?} {:?} {:?}", self.out, self.numbers, self.long)
    }

    /// Every way to name an object of this kind that is not there.
    fn strangers(&self, kind: u8) -> Vec<u64> {
        let freed = holed_mesh().0.id;
        let living = self.mesh.0.id;
        let others = (1..16).filter(|&other| other != kind);
        // The same place and generation as another kind.
        let others = others.map(|other| living << 4 >> 4 | u64::from(other) << 60);
        let of_others = [
            (MESH, living),
            (PLAN, self.plan.id),
            (REPORT, self.report.id),
            (PARAMETERS, self.parameters.id),
            (ERROR, self.error.id),
        ];
        let of_others = of_others.into_iter().filter(|&(other, _)| other != kind);
        let wrong = [
            0,
            1,
            u64::MAX,
            freed,
            living + (1 << 24),
            living ^ (1 << 50),
        ];
        let all = wrong.into_iter().chain(others);
        all.chain(of_others.map(|(_, id)| id)).collect()
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

/// What is wrong in a call: the pointer that is null, or the handle of a type that is that of nothing.
#[derive(Clone, Copy, Debug, Default)]
struct Wrong {
    null: Option<&'static str>,
    handle: Option<(&'static str, u64)>,
}

/// An argument: a plain one in parentheses; a handle in braces, with its type; a pointer in brackets, with its name in the
/// header and the status for null, which is `NULL` if it is left out; `!` for the error object.
macro_rules! argument {
    ($w:ident, $wrong:ident, ($plain:expr)) => {
        $plain
    };
    ($w:ident, $wrong:ident, !) => {
        (&raw mut $w.error).or_null($wrong.null == Some("error"))
    };
    ($w:ident, $wrong:ident, [$name:literal, $pointer:expr $(, $status:expr)?]) => {
        $pointer.or_null($wrong.null == Some($name))
    };
    ($w:ident, $wrong:ident, {$handle:ident $known:expr}) => {
        match $wrong.handle {
            Some((kind, id)) if kind == stringify!($handle) => $handle { id },
            _ => $known,
        }
    };
}

/// The name of an argument to get wrong, and the status for null. That of a handle is its type.
macro_rules! checked {
    (($plain:expr)) => {
        None
    };
    (!) => {
        Some(("error", OK))
    };
    ([$name:literal, $pointer:expr]) => {
        Some(($name, NULL))
    };
    ([$name:literal, $pointer:expr, $status:expr]) => {
        Some(($name, $status))
    };
    ({$handle:ident $known:expr}) => {
        Some((stringify!($handle), HOLEFILL_STATUS_INVALID_HANDLE))
    };
}

/// Calls `$function` as it should be called, with each of its pointers null, and with handles of nothing. Returns its name
/// and those of its arguments that were checked.
macro_rules! refuses {
    ($w:ident: $function:ident, $($argument:tt),+) => {{
        let name = stringify!($function);
        let checked: Vec<(&'static str, HolefillStatus)> =
            [$(checked!($argument)),+].into_iter().flatten().collect();
        let call = |world: &mut World, wrong: Wrong, expected: HolefillStatus| {
            let before = world.state();
            let $w = &mut *world;
            // SAFETY: all pointers are null or to living values.
            let status = unsafe { $function($(argument!($w, wrong, $argument)),+) };
            assert_eq!(status, expected, "{name} with {wrong:x?}");
            if status != OK {
                assert_eq!(world.state(), before, "{name} with {wrong:x?}");
            }
        };
        call(&mut World::new(), Wrong::default(), OK);
        for &(argument, status) in &checked {
            let Some(&(kind, number)) = HANDLES.iter().find(|h| h.0 == argument) else {
                let null = Some(argument);
                call(&mut World::new(), Wrong { null, handle: None }, status);
                continue;
            };
            let mut world = World::new();
            for id in world.strangers(number) {
                let handle = Some((kind, id));
                call(&mut world, Wrong { null: None, handle }, status);
            }
        }
        let names: Vec<String> = checked.iter().map(|&(name, _)| name.to_owned()).collect();
        (name.to_owned(), names)
    }};
}

#[test]
fn wrong_pointers_and_handles_are_refused_by_every_function() {
    const P: HolefillType = HOLEFILL_TYPE_F64;
    const I: HolefillType = HOLEFILL_TYPE_U32;
    let density = c"refine.density".as_ptr();
    let mut tested = vec![
        refuses!(w: holefill_error_status, {HolefillError w.error}, ["status", &raw mut w.out.status]),
        refuses!(w: holefill_error_message, {HolefillError w.error}, ["buffer", w.out.text.as_mut_ptr()], (256),
            ["length", &raw mut w.out.number]),
        refuses!(w: holefill_mesh_from_arrays, ["positions", ptr::from_ref(&w.positions())], ["triangles",
            ptr::from_ref(&w.triangles())], ["mesh", &raw mut w.out.mesh], !),
        refuses!(w: holefill_mesh_from_polyline, ["points", ptr::from_ref(&w.positions())], ["normals",
            ptr::from_ref(&w.positions()), OK], ["mesh", &raw mut w.out.mesh], !),
        refuses!(w: holefill_mesh_from_points, ["points", ptr::from_ref(&w.positions())], ["normals",
            ptr::from_ref(&w.positions()), OK], ["colors", ptr::from_ref(&w.positions()), OK], ["options", &raw const
            w.out.point_options, OK], ["mesh", &raw mut w.out.mesh], ["summary", &raw mut w.out.point_summary, OK],
            !),
        refuses!(w: holefill_mesh_info, {HolefillMesh w.mesh.0}, ["info", &raw mut w.out.mesh_info], !),
        refuses!(w: holefill_mesh_defects, {HolefillMesh w.mesh.0}, ["defects", &raw mut w.out.defects], !),
        refuses!(w: holefill_mesh_prepare, {HolefillMesh w.mesh.0}, !),
        refuses!(w: holefill_mesh_read_positions, {HolefillMesh w.mesh.0}, (0), ["output", ptr::from_ref(&w.row(P))],
            !),
        refuses!(w: holefill_mesh_read_triangles, {HolefillMesh w.mesh.0}, (0), ["output", ptr::from_ref(&w.row(I))],
            !),
        refuses!(w: holefill_mesh_add_attribute, {HolefillMesh w.mesh.0}, (1), ["name", c"cold".as_ptr()], (1),
            ["values", ptr::from_ref(&w.heat())], !),
        refuses!(w: holefill_mesh_attribute_count, {HolefillMesh w.mesh.0}, (1), ["count", &raw mut w.out.number], !),
        refuses!(w: holefill_mesh_attribute_info, {HolefillMesh w.mesh.0}, (1), (0), ["info", &raw mut
            w.out.attribute_info], !),
        refuses!(w: holefill_mesh_attribute_name, {HolefillMesh w.mesh.0}, (1), (0), ["buffer",
            w.out.text.as_mut_ptr()], (256), ["length", &raw mut w.out.number], !),
        refuses!(w: holefill_mesh_read_attribute, {HolefillMesh w.mesh.0}, (1), (0), (0), ["output",
            ptr::from_ref(&w.row(HOLEFILL_TYPE_F32))], !),
        refuses!(w: holefill_mesh_loop_count, {HolefillMesh w.mesh.0}, ["count", &raw mut w.out.number], !),
        refuses!(w: holefill_mesh_loop_info, {HolefillMesh w.mesh.0}, (0), ["info", &raw mut w.out.loop_info], !),
        refuses!(w: holefill_mesh_read_loop, {HolefillMesh w.mesh.0}, (0), (0), ["output", ptr::from_ref(&w.row(I))],
            !),
        refuses!(w: holefill_mesh_find_edge, {HolefillMesh w.mesh.0}, (w.chain[0]), (w.chain[1]), ["loop_id", &raw mut
            w.out.number], !),
        refuses!(w: holefill_mesh_find_vertices, {HolefillMesh w.mesh.0}, ["vertices", ptr::from_ref(&w.chain())],
            ["ids", w.out.ids.as_mut_ptr()], (8), ["count", &raw mut w.out.number], !),
        refuses!(w: holefill_mesh_select, {HolefillMesh w.mesh.0}, ["selection", &raw const w.out.selection, OK],
            ["ids", w.out.ids.as_mut_ptr()], (8), ["count", &raw mut w.out.number], !),
        refuses!(w: holefill_selection_init, ["selection", &raw mut w.out.selection], (size_of::<HolefillSelection>()
            as u32)),
        refuses!(w: holefill_fill_options_init, ["options", &raw mut w.out.fill_options],
            (size_of::<HolefillFillOptions>() as u32)),
        refuses!(w: holefill_parameters_new, ["parameters", &raw mut w.out.parameters], !),
        refuses!(w: holefill_parameters_set, {HolefillParameters w.parameters}, ["name", density], ["value",
            c"0.5".as_ptr()], !),
        refuses!(w: holefill_parameters_get, {HolefillParameters w.parameters}, ["name", density], ["buffer",
            w.out.text.as_mut_ptr()], (256), ["length", &raw mut w.out.number], !),
        refuses!(w: holefill_mesh_undo, {HolefillMesh filled(w)}, !),
        refuses!(w: holefill_plan_apply, {HolefillPlan w.plan}, {HolefillMesh w.mesh.0}, ["options", &raw const
            w.options, OK], ["report", &raw mut w.out.report, OK], !),
        refuses!(w: holefill_plan_report, {HolefillPlan w.plan}, ["report", &raw mut w.out.report], !),
        refuses!(w: holefill_plan_patch, {HolefillPlan w.plan}, (0), ["info", &raw mut w.out.patch_info], !),
        refuses!(w: holefill_plan_read_positions, {HolefillPlan w.plan}, (0), (0), ["output",
            ptr::from_ref(&w.row(P))], !),
        refuses!(w: holefill_plan_read_triangles, {HolefillPlan w.plan}, (0), (0), ["output",
            ptr::from_ref(&w.row(I))], !),
        refuses!(w: holefill_report_summary, {HolefillReport w.report}, ["summary", &raw mut w.out.summary], !),
        refuses!(w: holefill_report_hole, {HolefillReport w.report}, (0), ["hole", &raw mut w.out.hole], !),
        refuses!(w: holefill_report_reason, {HolefillReport w.report}, (0), ["buffer", w.out.text.as_mut_ptr()],
            (256), ["length", &raw mut w.out.number], !),
        refuses!(w: holefill_report_tried, {HolefillReport w.report}, (0), (0), ["method", &raw mut w.out.method],
            ["buffer", w.out.text.as_mut_ptr()], (256), ["length", &raw mut w.out.number], !),
        refuses!(w: holefill_report_json, {HolefillReport w.report}, ["buffer", w.long.as_mut_ptr()], (4096),
            ["length", &raw mut w.out.number], !),
        refuses!(w: holefill_report_prediction, {HolefillReport w.predicted}, (0), ["prediction", &raw mut
            w.out.prediction], !),
        refuses!(w: holefill_mesh_fill, {HolefillMesh w.mesh.0}, ["target", &raw const w.target, OK], ["options", &raw
            const w.options, OK], ["report", &raw mut w.out.report, OK], !),
        refuses!(w: holefill_mesh_plan, {HolefillMesh w.mesh.0}, ["target", &raw const w.target, OK], ["options", &raw
            const w.options, OK], ["plan", &raw mut w.out.plan], !),
        refuses!(w: holefill_mesh_fill_all, {HolefillMesh w.mesh.0}, !),
    ];
    let mut expected = declared();
    assert!(expected.len() > 50, "{}", expected.len());
    expected.retain(|(_, arguments)| !arguments.is_empty());
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
fn a_handle_is_freed_once_and_as_what_it_is() {
    type Free = fn(u64) -> HolefillStatus;
    let frees: [(u8, Free); 5] = [
        (MESH, |id| holefill_mesh_free(HolefillMesh { id })),
        (PLAN, |id| holefill_plan_free(HolefillPlan { id })),
        (REPORT, |id| holefill_report_free(HolefillReport { id })),
        (PARAMETERS, |id| {
            holefill_parameters_free(HolefillParameters { id })
        }),
        (ERROR, |id| holefill_error_free(HolefillError { id })),
    ];
    for (kind, free) in frees {
        let world = World::new();
        for id in world.strangers(kind) {
            let expected = match id {
                0 => OK,
                _ => HOLEFILL_STATUS_INVALID_HANDLE,
            };
            assert_eq!(free(id), expected, "{kind} {id:x}");
        }
        let own = [
            0,
            world.mesh.0.id,
            world.plan.id,
            world.report.id,
            world.parameters.id,
            world.error.id,
        ];
        let id = own[usize::from(kind)];
        assert_eq!(free(id), OK, "{kind}");
        assert_eq!(free(id), HOLEFILL_STATUS_INVALID_HANDLE, "{kind}");
    }
}

/// Where a call takes rows of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Positions,
    Triangles,
    PolylinePoints,
    PolylineNormals,
    Points,
    Normals,
    Colors,
    Vertices,
    Output,
}

const PLACES: [Place; 9] = [
    Place::Positions,
    Place::Triangles,
    Place::PolylinePoints,
    Place::PolylineNormals,
    Place::Points,
    Place::Normals,
    Place::Colors,
    Place::Vertices,
    Place::Output,
];

/// Makes a call on `arrays` with one view spoiled by `spoil`.
fn spoiled(arrays: &Arrays, place: Place, spoil: &dyn Fn(&mut HolefillInput)) -> HolefillStatus {
    let points = &arrays.positions;
    let mut room = points.clone();
    let change = |is_it: bool, mut view: HolefillInput| {
        if is_it {
            spoil(&mut view);
        }
        view
    };
    let view = |wanted: Place| change(place == wanted, rows(points, HOLEFILL_TYPE_F64));
    let triangles = rows(&arrays.triangles, HOLEFILL_TYPE_U32);
    let triangles = change(place == Place::Triangles, triangles);
    let (mut mesh, mut count) = (HolefillMesh { id: 77 }, 0);
    // SAFETY: what the views say is checked before it is read, and the first rows are there.
    let status = unsafe {
        match place {
            Place::Positions | Place::Triangles => {
                holefill_mesh_from_arrays(&view(Place::Positions), &triangles, &mut mesh, nothing())
            }
            Place::PolylinePoints | Place::PolylineNormals => holefill_mesh_from_polyline(
                &view(Place::PolylinePoints),
                &view(Place::PolylineNormals),
                &mut mesh,
                nothing(),
            ),
            Place::Points | Place::Normals | Place::Colors => holefill_mesh_from_points(
                &view(Place::Points),
                &view(Place::Normals),
                &view(Place::Colors),
                ptr::null(),
                &mut mesh,
                ptr::null_mut(),
                nothing(),
            ),
            Place::Vertices | Place::Output => {
                let owned = mesh_of(arrays);
                if place == Place::Vertices {
                    let chain: Vec<u32> = loop_vertices(owned.0, 0)
                        .iter()
                        .map(|&v| v as u32)
                        .collect();
                    let (chain, no) = (
                        change(true, rows(&chain, HOLEFILL_TYPE_U32)),
                        ptr::null_mut(),
                    );
                    return holefill_mesh_find_vertices(
                        owned.0,
                        &chain,
                        no,
                        0,
                        &mut count,
                        nothing(),
                    );
                }
                let output = view(Place::Output);
                let output = HolefillOutput {
                    data: match output.data.is_null() {
                        true => ptr::null_mut(),
                        false => room.as_mut_ptr().cast(),
                    },
                    count: output.count,
                    stride: output.stride,
                    scalar_type: output.scalar_type,
                    reserved: output.reserved,
                };
                return holefill_mesh_read_positions(owned.0, 0, &output, nothing());
            }
        }
    };
    match status {
        OK => assert_eq!(holefill_mesh_free(mesh), OK),
        _ => assert_eq!(mesh.id, 77, "an output is written only on success"),
    }
    status
}

#[test]
fn rows_that_cannot_be_are_refused_in_every_place() {
    use HOLEFILL_STATUS_INVALID_ARGUMENT as INVALID;
    let arrays = fixtures::sphere(4).cut(|c| c[2] > 0.75);
    for place in PLACES {
        let check = |expected: HolefillStatus, spoil: &dyn Fn(&mut HolefillInput)| {
            assert_eq!(spoiled(&arrays, place, spoil), expected, "{place:?}");
        };
        let takes_indices = [Place::Triangles, Place::Vertices].contains(&place);
        check(OK, &|_| {});
        check(NULL, &|v| v.data = ptr::null());
        check(HOLEFILL_STATUS_INVALID_STRUCT, &|v| v.reserved = 1);
        for huge in [u64::MAX, u64::MAX / 2, 1 << 60] {
            check(HOLEFILL_STATUS_OVERFLOW, &|v| v.count = huge);
            check(HOLEFILL_STATUS_OVERFLOW, &|v| {
                (v.count, v.stride) = (2, huge)
            });
        }
        let row = match place {
            Place::Triangles => 12,
            Place::Vertices => 4,
            _ => 24,
        };
        for stride in 1..row {
            check(INVALID, &|v| v.stride = stride);
        }
        let allowed: &[HolefillType] = match place {
            _ if takes_indices => rows::INDEX_TYPES,
            Place::Colors => rows::ATTRIBUTE_TYPES,
            _ => rows::POINT_TYPES,
        };
        for scalar_type in (0..20).chain([u32::MAX]).filter(|t| !allowed.contains(t)) {
            check(INVALID, &|v| v.scalar_type = scalar_type);
        }
        match place {
            // Within the address space, but beyond any memory.
            Place::Positions | Place::Triangles | Place::Points => {
                check(HOLEFILL_STATUS_OUT_OF_MEMORY, &|v| v.count = (1 << 55) / 24);
            }
            Place::Normals | Place::Colors | Place::PolylineNormals => {
                check(INVALID, &|v| v.count -= 1)
            }
            Place::Output => check(HOLEFILL_STATUS_NOT_FOUND, &|v| v.count += 1),
            Place::Vertices => check(HOLEFILL_STATUS_NOT_FOUND, &|v| v.count -= 1),
            Place::PolylinePoints => check(INVALID, &|v| v.count = 2),
        }
    }
    // Nothing at all needs no place.
    let empty = |v: &mut HolefillInput| (v.data, v.count) = (ptr::null(), 0);
    assert_eq!(spoiled(&arrays, Place::Output, &empty), OK);
    assert_eq!(spoiled(&arrays, Place::Triangles, &empty), OK);
    assert_eq!(
        spoiled(&arrays, Place::Positions, &empty),
        HOLEFILL_STATUS_INDEX_OUT_OF_RANGE
    );
}

#[test]
fn numbers_that_cannot_be_are_refused_with_their_place() {
    let made = |positions: &HolefillInput, triangles: &HolefillInput| {
        let (mut mesh, mut error) = (HolefillMesh::default(), HolefillError::default());
        // SAFETY: the views describe living memory.
        let status =
            unsafe { holefill_mesh_from_arrays(positions, triangles, &mut mesh, &mut error) };
        let mut stored = OK;
        // SAFETY: the pointer is to a living value.
        unsafe { holefill_error_status(error, &mut stored) };
        assert_eq!(stored, status);
        let text = message(error);
        holefill_error_free(error);
        (status, text)
    };
    let small = Arrays {
        positions: vec![[0.0_f64, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2]],
    };
    let good = [0, 1, 2].map(|i| small.positions[i]);
    let faces = rows(&[[0_u32, 1, 2]], HOLEFILL_TYPE_U32);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut points = good;
        points[1][1] = bad;
        let singles = points.map(|p| p.map(|c| c as f32));
        let views = [
            rows(&points, HOLEFILL_TYPE_F64),
            rows(&singles, HOLEFILL_TYPE_F32),
        ];
        for view in views {
            let (status, text) = made(&view, &faces);
            assert_eq!(status, HOLEFILL_STATUS_NOT_FINITE);
            assert!(text.contains("row 1"), "{text}");
            for place in [
                Place::PolylinePoints,
                Place::PolylineNormals,
                Place::Points,
                Place::Normals,
            ] {
                let status = spoiled(&small, place, &|v| *v = view);
                assert_eq!(status, HOLEFILL_STATUS_NOT_FINITE, "{place:?}");
            }
        }
    }
    let points = rows(&good, HOLEFILL_TYPE_F64);
    for bad in [
        3_u64,
        u64::from(u32::MAX),
        1 << 32,
        i64::MAX as u64,
        u64::MAX,
    ] {
        let (status, text) = made(&points, &rows(&[[0, bad, 1]], HOLEFILL_TYPE_U64));
        assert_eq!(status, HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, "{bad}");
        assert!(text.contains(&bad.to_string()), "{text}");
    }
    for bad in [-1, i32::MIN] {
        // A gap between the rows takes the other way to read them.
        let narrow = [0, bad, 1, 9];
        let wide = narrow.map(i64::from);
        let gap = HolefillInput {
            stride: 16,
            ..rows(&narrow[..1], HOLEFILL_TYPE_I32)
        };
        for view in [
            rows(&[narrow], HOLEFILL_TYPE_I32),
            gap,
            rows(&[wide], HOLEFILL_TYPE_I64),
        ] {
            let (status, text) = made(&points, &view);
            assert_eq!(status, HOLEFILL_STATUS_INVALID_ARGUMENT, "{bad}");
            let expected = format!("row 0 of triangles has the negative index {bad}");
            assert_eq!(text, expected);
        }
    }
}
