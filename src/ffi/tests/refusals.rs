//! Wrong arguments for every function in turn: null for a pointer that must not be null, and a handle of nothing. Each has
//! its status, and then nothing is changed.
//!
//! The header says which functions there are, and which of their arguments are pointers and handles: none can be left out
//! here.

use super::*;

const HEADER: &str = include_str!("../../../include/holefill.h");

const HANDLES: [(&str, u8); 5] = [
    ("HolefillMesh", HolefillMesh::KIND),
    ("HolefillPlan", HolefillPlan::KIND),
    ("HolefillReport", HolefillReport::KIND),
    ("HolefillParameters", HolefillParameters::KIND),
    ("HolefillError", HolefillError::KIND),
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
    mesh: Owned<HolefillMesh>,
    plan: Owned<HolefillPlan>,
    report: Owned<HolefillReport>,
    predicted: Owned<HolefillReport>,
    parameters: Owned<HolefillParameters>,
    error: HolefillError,
    arrays: Arrays,
    heat: Vec<f32>,
    options: HolefillFillOptions,
    target: HolefillTarget,
    /// What calls write to: a handle, a number or rows in each.
    out: [[u64; 8]; 2],
    /// Room for a struct that begins with its size.
    room: [u64; 64],
    text: Vec<c_char>,
}

impl World {
    fn new() -> Self {
        let arrays = holed();
        let (mesh, predicted) = (mesh_of(&arrays), holed_mesh());
        let heat = vec![0.5_f32; arrays.positions.len()];
        // A method that refuses the hole, so that the report has an attempt to tell of: there are too many vertices.
        let small = HolefillFillOptions {
            max_new_vertices: 1,
            ..with_method(c"fair-c2")
        };
        ok!(holefill_mesh_add_attribute: mesh.0, 1, c"heat".as_ptr(), 1, &rows(&heat));
        let (_, report) = report_of(mesh.0, &at_loop(0), &small);
        undo(mesh.0);
        let mut error = HolefillError::default();
        let (far, none, no) = (at_loop(99), ptr::null(), ptr::null_mut());
        // SAFETY: all pointers are null or to living values.
        unsafe { holefill_mesh_fill(mesh.0, &far, none, no, &mut error) };
        Self {
            plan: plan_loop(mesh.0, 0, &options()),
            options: options(),
            target: at_loop(0),
            out: [[77; 8]; 2],
            room: [0; 64],
            text: vec![77; 4096],
            mesh,
            report,
            predicted: report_of(predicted.0, &at_loop(0), &with_method(c"auto")).1,
            parameters: parameters(c"refine.density", c"1"),
            error,
            arrays,
            heat,
        }
    }

    /// Everything that a call may change.
    fn state(&self) -> (u64, [[u64; 8]; 2], Vec<u64>, Vec<c_char>) {
        let room = self.room[1..].to_vec();
        (digest(self.mesh.0), self.out, room, self.text.clone())
    }

    /// Every handle that lives.
    fn living(&self) -> [(u8, u64); 5] {
        [
            (HolefillMesh::KIND, self.mesh.0.id),
            (HolefillPlan::KIND, self.plan.0.id),
            (HolefillReport::KIND, self.report.0.id),
            (HolefillParameters::KIND, self.parameters.0.id),
            (HolefillError::KIND, self.error.id),
        ]
    }

    /// Every way to name an object of this kind that is not there.
    fn strangers(&self, kind: u8) -> Vec<u64> {
        let (freed, living) = (holed_mesh().0.id, self.mesh.0.id);
        let mut wrong = vec![
            0,
            1,
            u64::MAX,
            freed,
            living + (1 << 24),
            living ^ (1 << 50),
        ];
        // The same place and generation as another kind.
        let others = (1..16).filter(|&other| other != kind);
        wrong.extend(others.map(|other| living << 4 >> 4 | u64::from(other) << 60));
        let others = self
            .living()
            .into_iter()
            .filter(|&(other, _)| other != kind);
        wrong.extend(others.map(|(_, id)| id));
        wrong
    }

    fn points(&self) -> HolefillInput {
        rows(&self.arrays.positions)
    }

    /// Where a call writes its `k`-th output.
    fn out<T>(&mut self, k: usize) -> *mut T {
        self.out[k].as_mut_ptr().cast()
    }

    /// Where a call writes a struct.
    fn blank<T: structs::CStruct>(&mut self) -> *mut T {
        let place: *mut T = self.room.as_mut_ptr().cast();
        // SAFETY: every struct is smaller than the room.
        unsafe { place.write(Default::default()) };
        place
    }

    /// Room for one row of three numbers.
    fn row<T: Numbers>(&mut self) -> HolefillOutput {
        HolefillOutput {
            data: self.out(0),
            count: 1,
            stride: 0,
            scalar_type: T::TYPE,
            reserved: 0,
        }
    }

    fn text(&mut self) -> *mut c_char {
        self.text.as_mut_ptr()
    }

    /// The mesh, with a hole filled.
    fn filled(&self) -> HolefillMesh {
        fill_loop(self.mesh.0, 0, &options());
        self.mesh.0
    }
}

/// Frees an object of any kind.
fn free(kind: u8, id: u64) -> HolefillStatus {
    match kind {
        HolefillMesh::KIND => holefill_mesh_free(HolefillMesh { id }),
        HolefillPlan::KIND => holefill_plan_free(HolefillPlan { id }),
        HolefillReport::KIND => holefill_report_free(HolefillReport { id }),
        HolefillParameters::KIND => holefill_parameters_free(HolefillParameters { id }),
        _ => holefill_error_free(HolefillError { id }),
    }
}

impl Drop for World {
    fn drop(&mut self) {
        holefill_error_free(self.error);
        // Whatever a call has made.
        for (_, kind) in HANDLES {
            free(kind, self.out[0][0]);
        }
    }
}

/// What a call takes as a pointer: what it points to lives until the call is over.
trait Pointer {
    type Raw;

    fn or_null(self, is_null: bool) -> Self::Raw;
}

macro_rules! pointers {
    ($($given:ty => $raw:ty, $null:expr;)*) => {
        $(impl<T> Pointer for $given {
            type Raw = $raw;

            fn or_null(self, is_null: bool) -> $raw {
                if is_null { $null } else { self }
            }
        })*
    };
}
pointers! {
    &T => *const T, ptr::null();
    *const T => *const T, ptr::null();
    *mut T => *mut T, ptr::null_mut();
}

/// What is wrong in a call: the pointer that is null, or the handle of a kind that is that of nothing.
#[derive(Clone, Copy, Debug, Default)]
struct Wrong {
    null: Option<&'static str>,
    handle: Option<(u8, u64)>,
}

/// An argument: a plain one in parentheses; a handle in braces, with its type; a pointer in brackets, with its name in the
/// header and the status for null, which is `NULL` if it is left out; `!` for the error object.
macro_rules! argument {
    ($w:ident, $wrong:ident, ($plain:expr)) => {
        $plain
    };
    ($w:ident, $wrong:ident, !) => {
        argument!($w, $wrong, ["error", &raw mut $w.error])
    };
    ($w:ident, $wrong:ident, [$name:literal, $pointer:expr $(, $status:expr)?]) => {
        Pointer::or_null($pointer, $wrong.null == Some($name))
    };
    ($w:ident, $wrong:ident, {$handle:ident $known:expr}) => {
        match $wrong.handle {
            Some((kind, id)) if kind == $handle::KIND => $handle { id },
            _ => $known,
        }
    };
}

/// The name of an argument to get wrong, which is the type of a handle, and the status for it.
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
        Some((stringify!($handle), INVALID_HANDLE))
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
            let $w = &mut *world;
            let before = $w.state();
            // SAFETY: all pointers are null or to living values.
            let status = unsafe { $function($(argument!($w, wrong, $argument)),+) };
            assert_eq!(status, expected, "{name} with {wrong:x?}");
            if status != OK {
                assert_eq!($w.state(), before, "{name} with {wrong:x?}");
            }
        };
        call(&mut World::new(), Wrong::default(), OK);
        for &(argument, status) in &checked {
            let Some(&(_, kind)) = HANDLES.iter().find(|h| h.0 == argument) else {
                let null = Some(argument);
                call(&mut World::new(), Wrong { null, handle: None }, status);
                continue;
            };
            let mut world = World::new();
            for id in world.strangers(kind) {
                let handle = Some((kind, id));
                call(&mut world, Wrong { null: None, handle }, status);
            }
        }
        let names: Vec<String> = checked.iter().map(|&(name, _)| name.to_owned()).collect();
        (name.to_owned(), names)
    }};
}

/// [`refuses`] for functions that begin with a handle and end with an error object: `mesh`, `plan`, `report` or
/// `parameters`.
macro_rules! all_refuse {
    ($w:ident: $($own:ident $function:ident($($argument:tt),*);)+) => {
        vec![$(all_refuse!(@ $w $own $function $($argument)*)),+]
    };
    (@ $w:ident mesh $function:ident $($argument:tt)*) => {
        refuses!($w: $function, {HolefillMesh $w.mesh.0} $(, $argument)*, !)
    };
    (@ $w:ident plan $function:ident $($argument:tt)*) => {
        refuses!($w: $function, {HolefillPlan $w.plan.0} $(, $argument)*, !)
    };
    (@ $w:ident report $function:ident $($argument:tt)*) => {
        refuses!($w: $function, {HolefillReport $w.report.0} $(, $argument)*, !)
    };
    (@ $w:ident parameters $function:ident $($argument:tt)*) => {
        refuses!($w: $function, {HolefillParameters $w.parameters.0} $(, $argument)*, !)
    };
    (@ $w:ident new $function:ident $($argument:tt)*) => {
        refuses!($w: $function $(, $argument)*, !)
    };
    (@ $w:ident error $function:ident $($argument:tt)*) => {
        refuses!($w: $function, {HolefillError $w.error} $(, $argument)*)
    };
}

#[test]
fn wrong_pointers_and_handles_are_refused_by_every_function() {
    let density = c"refine.density".as_ptr();
    let mut tested = all_refuse! { w:
        error holefill_error_status(["status", w.out(0)]);
        error holefill_error_message(["buffer", w.text()], (4096), ["length", w.out(0)]);
        new holefill_mesh_from_arrays(["positions", &w.points()],
            ["triangles", &rows(&w.arrays.triangles)], ["mesh", w.out(0)]);
        new holefill_mesh_from_polyline(["points", &w.points()], ["normals", &w.points(), OK],
            ["mesh", w.out(0)]);
        new holefill_mesh_from_points(["points", &w.points()], ["normals", &w.points(), OK],
            ["colors", &w.points(), OK], ["options", &Default::default(), OK], ["mesh", w.out(0)],
            ["summary", w.blank(), OK]);
        mesh holefill_mesh_info(["info", w.blank()]);
        mesh holefill_mesh_defects(["defects", w.blank()]);
        mesh holefill_mesh_prepare();
        mesh holefill_mesh_read_positions((0), ["output", &w.row::<f64>()]);
        mesh holefill_mesh_read_triangles((0), ["output", &w.row::<u32>()]);
        mesh holefill_mesh_add_attribute((1), ["name", c"cold".as_ptr()], (1), ["values", &rows(&w.heat)]);
        mesh holefill_mesh_attribute_count((1), ["count", w.out(0)]);
        mesh holefill_mesh_attribute_info((1), (0), ["info", w.blank()]);
        mesh holefill_mesh_attribute_name((1), (0), ["buffer", w.text()], (4096), ["length", w.out(0)]);
        mesh holefill_mesh_read_attribute((1), (0), (0), ["output", &w.row::<f32>()]);
        mesh holefill_mesh_loop_count(["count", w.out(0)]);
        mesh holefill_mesh_loop_info((0), ["info", w.blank()]);
        mesh holefill_mesh_read_loop((0), (0), ["output", &w.row::<u32>()]);
        mesh holefill_mesh_find_loops(["target", &w.target, OK], ["ids", w.out(1)], (8), ["count", w.out(0)]);
        new holefill_parameters_new(["parameters", w.out(0)]);
        parameters holefill_parameters_set(["name", density], ["value", c"0.5".as_ptr()]);
        parameters holefill_parameters_get(["name", density], ["buffer", w.text()], (4096), ["length", w.out(0)]);
        new holefill_mesh_undo({HolefillMesh w.filled()});
        plan holefill_plan_apply({HolefillMesh w.mesh.0}, ["options", &w.options, OK],
            ["report", w.out(0), OK]);
        plan holefill_plan_report(["report", w.out(0)]);
        plan holefill_plan_patch((0), ["info", w.blank()]);
        plan holefill_plan_read_positions((0), (0), ["output", &w.row::<f64>()]);
        plan holefill_plan_read_triangles((0), (0), ["output", &w.row::<u32>()]);
        report holefill_report_summary(["summary", w.blank()]);
        report holefill_report_hole((0), ["hole", w.blank()]);
        report holefill_report_reason((0), ["buffer", w.text()], (4096), ["length", w.out(0)]);
        report holefill_report_tried((0), (0), ["method", w.out(1)], ["buffer", w.text()], (4096),
            ["length", w.out(0)]);
        report holefill_report_json(["buffer", w.text()], (4096), ["length", w.out(0)]);
        new holefill_report_prediction({HolefillReport w.predicted.0}, (0), ["prediction", w.blank()]);
        mesh holefill_mesh_fill(["target", &w.target, OK], ["options", &w.options, OK],
            ["report", w.out(0), OK]);
        mesh holefill_mesh_plan(["target", &w.target, OK], ["options", &w.options, OK],
            ["plan", w.out(0)]);
        mesh holefill_mesh_fill_all();
    };
    let mut expected = declared();
    assert!(expected.len() >= 50, "{}", expected.len());
    expected.retain(|(_, arguments)| !arguments.is_empty());
    expected.sort();
    tested.sort();
    assert_eq!(tested, expected, "here, and in the header");
}

#[test]
fn a_handle_is_freed_once_and_as_what_it_is() {
    for (_, kind) in HANDLES {
        let world = World::new();
        for id in world.strangers(kind) {
            let expected = match id {
                0 => OK,
                _ => INVALID_HANDLE,
            };
            assert_eq!(free(kind, id), expected, "{kind} {id:x}");
        }
        let (_, id) = world.living()[usize::from(kind) - 1];
        assert_eq!(free(kind, id), OK, "{kind}");
        assert_eq!(free(kind, id), INVALID_HANDLE, "{kind}");
    }
}

/// Makes the rows of a call wrong.
type Spoil<'a> = &'a dyn Fn(HolefillInput) -> HolefillInput;

/// Where a call takes rows of numbers.
struct Place {
    name: &'static str,
    /// Bytes of a row.
    row: u64,
    allowed: &'static [HolefillType],
    /// A number of rows that is wrong here, from the right one, and its status.
    count: fn(u64) -> u64,
    miscounted: HolefillStatus,
    /// Calls with the rows spoiled.
    call: fn(&Arrays, Spoil<'_>) -> HolefillStatus,
}

/// The status of a call that makes a mesh.
fn makes(call: impl FnOnce(*mut HolefillMesh) -> HolefillStatus) -> HolefillStatus {
    let mut mesh = HolefillMesh { id: 77 };
    let status = call(&mut mesh);
    match status {
        OK => assert_eq!(holefill_mesh_free(mesh), OK),
        _ => assert_eq!(mesh.id, 77, "an output is written only on success"),
    }
    status
}

fn makes_from_points(
    points: HolefillInput,
    normals: HolefillInput,
    colors: HolefillInput,
) -> HolefillStatus {
    let (no, none) = (ptr::null(), ptr::null_mut());
    makes(|m| call!(holefill_mesh_from_points: &points, &normals, &colors, no, m, none))
}

macro_rules! places {
    ($($name:literal $row:literal $allowed:ident $count:expr, $miscounted:ident, ($a:ident, $s:ident) $call:expr;)*) => {
        const PLACES: &[Place] = &[$(Place {
            name: $name,
            row: $row,
            allowed: rows::$allowed,
            count: $count,
            miscounted: $miscounted,
            call: |$a, $s| $call,
        }),*];
    };
}
/// Rows within the address space, but beyond any memory.
const TOO_MANY: u64 = (1 << 55) / 24;
places! {
    "positions" 24 POINT_TYPES |_| TOO_MANY, NO_MEMORY, (a, s)
        makes(|m| call!(holefill_mesh_from_arrays: &s(rows(&a.positions)), &rows(&a.triangles), m));
    "triangles" 12 INDEX_TYPES |_| TOO_MANY, NO_MEMORY, (a, s)
        makes(|m| call!(holefill_mesh_from_arrays: &rows(&a.positions), &s(rows(&a.triangles)), m));
    "polyline" 24 POINT_TYPES |_| 2, INVALID, (a, s)
        makes(|m| call!(holefill_mesh_from_polyline: &s(rows(&a.positions)), &rows(&a.positions), m));
    "normals of a polyline" 24 POINT_TYPES |n| n - 1, INVALID, (a, s)
        makes(|m| call!(holefill_mesh_from_polyline: &rows(&a.positions), &s(rows(&a.positions)), m));
    "points" 24 POINT_TYPES |_| TOO_MANY, NO_MEMORY, (a, s)
        makes_from_points(s(rows(&a.positions)), rows(&a.positions), rows(&a.positions));
    "normals of points" 24 POINT_TYPES |n| n - 1, INVALID, (a, s)
        makes_from_points(rows(&a.positions), s(rows(&a.positions)), rows(&a.positions));
    "colors" 24 ATTRIBUTE_TYPES |n| n - 1, INVALID, (a, s)
        makes_from_points(rows(&a.positions), rows(&a.positions), s(rows(&a.positions)));
    "chain" 4 INDEX_TYPES |n| n - 1, NOT_FOUND, (a, s) {
        let mesh = mesh_of(a);
        let chain: Vec<u32> = loop_vertices(mesh.0, 0).iter().map(|&v| v as u32).collect();
        found(mesh.0, &at_ids(HOLEFILL_TARGET_VERTICES, &s(rows(&chain)))).err().unwrap_or(OK)
    };
    "output" 24 POINT_TYPES |n| n + 1, NOT_FOUND, (a, s) {
        let mut room = a.positions.clone();
        let HolefillInput { data, count, stride, scalar_type, reserved } = s(rows(&room));
        let data = if data.is_null() { ptr::null_mut() } else { room.as_mut_ptr().cast() };
        let output = HolefillOutput { data, count, stride, scalar_type, reserved };
        call!(holefill_mesh_read_positions: mesh_of(a).0, 0, &output)
    };
}

fn place(name: &str) -> &'static Place {
    let found = PLACES.iter().find(|p| p.name == name);
    found.expect("a name of the table")
}

#[test]
fn rows_that_cannot_be_are_refused_in_every_place() {
    let arrays = fixtures::sphere(4).cut(|c| c[2] > 0.75);
    for place in PLACES {
        let check = |expected: HolefillStatus, spoil: &dyn Fn(&mut HolefillInput)| {
            let spoiled = |mut view: HolefillInput| {
                spoil(&mut view);
                view
            };
            assert_eq!((place.call)(&arrays, &spoiled), expected, "{}", place.name);
        };
        check(OK, &|_| {});
        check(NULL, &|v| v.data = ptr::null());
        check(INVALID_STRUCT, &|v| v.reserved = 1);
        for huge in [u64::MAX, u64::MAX / 2, 1 << 60] {
            check(OVERFLOW, &|v| v.count = huge);
            check(OVERFLOW, &|v| (v.count, v.stride) = (2, huge));
        }
        for stride in 1..place.row {
            check(INVALID, &|v| v.stride = stride);
        }
        for wrong in (0..20).chain([u32::MAX]) {
            if !place.allowed.contains(&wrong) {
                check(INVALID, &|v| v.scalar_type = wrong);
            }
        }
        check(place.miscounted, &|v| v.count = (place.count)(v.count));
    }
    // Nothing at all needs no place.
    for (name, expected) in [
        ("output", OK),
        ("triangles", OK),
        ("positions", OUT_OF_RANGE),
    ] {
        let empty = |view: HolefillInput| HolefillInput {
            data: ptr::null(),
            count: 0,
            ..view
        };
        assert_eq!((place(name).call)(&arrays, &empty), expected, "{name}");
    }
}

#[test]
fn numbers_that_cannot_be_are_refused_with_their_place() {
    let made = |positions: &HolefillInput, triangles: &HolefillInput| {
        let mut mesh = Owned(HolefillMesh::default());
        said!(holefill_mesh_from_arrays: positions, triangles, &mut mesh.0)
    };
    let small = Arrays {
        positions: vec![[0.0_f64, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2]],
    };
    let good = [0, 1, 2].map(|i| small.positions[i]);
    let faces = rows(&small.triangles);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut points = good;
        points[1][1] = bad;
        let singles = points.map(|p| p.map(|c| c as f32));
        for view in [rows(&points), rows(&singles)] {
            let (status, text) = made(&view, &faces);
            assert_eq!(status, NOT_FINITE);
            assert!(text.contains("row 1"), "{text}");
            for name in [
                "polyline",
                "normals of a polyline",
                "points",
                "normals of points",
            ] {
                let status = (place(name).call)(&small, &|_| view);
                assert_eq!(status, NOT_FINITE, "{name}");
            }
        }
    }
    let points = rows(&good);
    let wide = u64::from(u32::MAX);
    for bad in [3, wide, 1 << 32, i64::MAX as u64, u64::MAX] {
        let (status, text) = made(&points, &rows(&[[0, bad, 1]]));
        assert_eq!(status, OUT_OF_RANGE, "{bad}");
        assert!(text.contains(&bad.to_string()), "{text}");
    }
    for bad in [-1, i32::MIN] {
        // A gap between the rows takes the other way to read them.
        let apart = [[0, bad, 1, 9]];
        let gap = HolefillInput {
            stride: 16,
            ..rows(&apart)
        };
        let wide = [[0, i64::from(bad), 1]];
        for view in [rows(&[[0, bad, 1]]), gap, rows(&wide)] {
            let (status, text) = made(&points, &view);
            assert_eq!(status, INVALID, "{bad}");
            let expected = format!("row 0 of triangles has the negative index {bad}");
            assert_eq!(text, expected);
        }
    }
}
