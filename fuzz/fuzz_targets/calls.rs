//! Random sequences of calls of the C interface with random arguments: right ones, wrong ones, freed ones.
//!
//! Pointers that are not null point to as much memory as the other arguments say: that is the caller's only promise. What
//! must hold: no report of the sanitizer, no `PANIC`, a status that is documented, and a mesh that a failing call leaves as
//! it was.
#![no_main]

use holefill::ffi::*;
use libfuzzer_sys::fuzz_target;
use std::ffi::{CString, c_char, c_void};
use std::ptr;

/// The input, byte by byte; zeros when it is used up.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        first
    }

    /// Small most of the time, and anything at all sometimes.
    fn number(&mut self) -> u64 {
        match self.byte() {
            byte @ 0..=247 => u64::from(byte) % 40,
            248..=250 => {
                let bytes: [u8; 8] = std::array::from_fn(|_| self.byte());
                u64::from_le_bytes(bytes)
            }
            251 => u64::MAX,
            252 => u64::from(u32::MAX),
            253 => 1 << 32,
            254 => i64::MAX as u64,
            _ => u64::MAX / 24,
        }
    }

    /// Null most of the time.
    fn or_null<T>(&mut self, value: &T) -> *const T {
        if self.byte() > 99 { ptr::null() } else { value }
    }

    fn coordinate(&mut self) -> f64 {
        match self.byte() {
            255 => f64::NAN,
            254 => f64::INFINITY,
            253 => 1e300,
            252 => 1e-300,
            byte => f64::from(byte as i8) / 16.0,
        }
    }
}

/// Everything that calls made, living and freed.
#[derive(Default)]
struct World {
    ids: Vec<u64>,
}

impl World {
    fn pick(&self, bytes: &mut Bytes<'_>) -> u64 {
        let k = bytes.byte() as usize;
        match (k, self.ids.is_empty()) {
            (255, _) => bytes.number(),
            (254, _) | (_, true) => 0,
            _ => self.ids[k % self.ids.len()],
        }
    }
}

/// A grid of squares, of which a mask leaves some out, with vertices displaced.
fn grid(bytes: &mut Bytes<'_>) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let n = 2 + u32::from(bytes.byte() % 8);
    let mut points = Vec::new();
    for y in 0..=n {
        for x in 0..=n {
            let z = f64::from(bytes.byte() % 16) / 16.0;
            points.push([f64::from(x), f64::from(y), z]);
        }
    }
    let mut triangles = Vec::new();
    for y in 0..n {
        for x in 0..n {
            let mask = bytes.byte();
            let [a, b] = [y * (n + 1) + x, y * (n + 1) + x + 1];
            let [c, d] = [a + n + 1, b + n + 1];
            if mask & 3 != 3 {
                triangles.push([a, b, d]);
            }
            if mask & 12 != 12 {
                triangles.push(if mask & 128 == 0 { [a, d, c] } else { [d, a, c] });
            }
        }
    }
    (points, triangles)
}

unsafe extern "C" fn stop(_: *const HolefillProgress, user_data: *mut c_void) -> i32 {
    let left: *mut i64 = user_data.cast();
    // SAFETY: a number of the caller; calls come one at a time.
    unsafe {
        *left -= 1;
        i32::from(*left < 0)
    }
}

unsafe extern "C" fn log(_: HolefillLogLevel, message: *const c_char, _: *mut c_void) {
    // SAFETY: the library's text ends with a zero byte.
    let text = unsafe { std::ffi::CStr::from_ptr(message) };
    assert!(text.to_str().is_ok());
}

fn info(mesh: HolefillMesh) -> Option<HolefillMeshInfo> {
    let mut info = HolefillMeshInfo::default();
    // SAFETY: the pointer is to a living value.
    let status = unsafe { holefill_mesh_info(mesh, &mut info, ptr::null_mut()) };
    (status == HOLEFILL_STATUS_OK).then_some(info)
}

/// Positions, triangles and number of fills of a mesh; nothing for a handle of none.
type State = Option<(Vec<u64>, Vec<u32>, u64)>;

fn state(mesh: HolefillMesh) -> State {
    let info = info(mesh)?;
    let (mut positions, mut triangles) = (vec![[0_u64; 3]; info.vertex_count as usize], vec![[0_u32; 3]; info.triangle_count as usize]);
    let to_positions = output(&view(&positions, HOLEFILL_TYPE_F64), positions.as_mut_ptr());
    let to_triangles = output(&view(&triangles, HOLEFILL_TYPE_U32), triangles.as_mut_ptr());
    // SAFETY: the outputs describe living memory.
    unsafe {
        let read = holefill_mesh_read_positions(mesh, 0, &to_positions, ptr::null_mut());
        assert_eq!(read, HOLEFILL_STATUS_OK);
        let read = holefill_mesh_read_triangles(mesh, 0, &to_triangles, ptr::null_mut());
        assert_eq!(read, HOLEFILL_STATUS_OK);
    }
    Some((positions.into_flattened(), triangles.into_flattened(), info.undo_count))
}

/// All of these rows.
fn view<T>(rows: &[T], scalar_type: HolefillType) -> HolefillInput {
    HolefillInput {
        data: rows.as_ptr().cast(),
        count: rows.len() as u64,
        scalar_type,
        ..NO_ROWS
    }
}

/// Room at `data` for the rows of a view.
fn output<T>(rows: &HolefillInput, data: *mut T) -> HolefillOutput {
    let &HolefillInput { count, stride, scalar_type, reserved, .. } = rows;
    HolefillOutput { data: data.cast(), count, stride, scalar_type, reserved }
}

const NO_ROWS: HolefillInput = HolefillInput {
    data: ptr::null(),
    count: 0,
    stride: 0,
    scalar_type: 0,
    reserved: 0,
};

/// Data that a call may read or write: views of it lie within.
struct Room {
    bytes: Vec<u8>,
}

impl Room {
    fn new(bytes: &mut Bytes<'_>) -> Self {
        let mut room = vec![0_u8; 2048];
        let count = bytes.byte() as usize;
        room.iter_mut().take(count).for_each(|b| *b = bytes.byte());
        Self { bytes: room }
    }

    /// A view that lies within the room, or that no memory could hold.
    fn view(&mut self, bytes: &mut Bytes<'_>) -> HolefillInput {
        let offset = bytes.byte() as usize % 16;
        let scalar_type = u32::from(bytes.byte() % 13);
        let (mut count, mut stride) = (bytes.number(), bytes.number());
        // At most 1024 components of 8 bytes: more than the room. Attributes of that many get no rows but few.
        let extent = count.saturating_mul(stride.max(24));
        let fits = extent < (self.bytes.len() - 16) as u64;
        let cannot_be = count.checked_mul(stride.max(1)).is_none_or(|e| e > i64::MAX as u64);
        if !fits && !cannot_be {
            count %= 8;
            stride %= 64;
        }
        HolefillInput {
            data: self.bytes[offset..].as_mut_ptr().cast_const().cast(),
            count,
            stride,
            scalar_type,
            reserved: u32::from(bytes.byte() == 200),
        }
    }

    fn output(&mut self, bytes: &mut Bytes<'_>) -> HolefillOutput {
        let view = self.view(bytes);
        output(&view, view.data.cast_mut())
    }
}

/// A struct as a newer header may have it, with a field that the library does not know.
#[repr(C)]
struct Longer<T> {
    known: T,
    beyond: u64,
}

fn options(bytes: &mut Bytes<'_>, world: &World, left: *mut i64, method: &CString) -> HolefillFillOptions {
    HolefillFillOptions {
        struct_size: size_of::<HolefillFillOptions>() as u32 + u32::from(bytes.byte() == 77),
        version: HOLEFILL_FILL_OPTIONS_VERSION + u32::from(bytes.byte() == 78),
        method: method.as_ptr(),
        parameters: HolefillParameters {
            id: match bytes.byte() {
                0..200 => 0,
                _ => world.pick(bytes),
            },
        },
        seed: bytes.number(),
        time_budget: match bytes.byte() {
            0..200 => 0.0,
            _ => bytes.coordinate(),
        },
        density: match bytes.byte() {
            0..200 => 0.0,
            _ => bytes.coordinate(),
        },
        // Bounded, so that a run takes its time for many calls and not for one.
        max_new_vertices: 1 + bytes.number() % 400,
        threads: u32::from(bytes.byte() % 3),
        log_level: u32::from(bytes.byte() % 5),
        progress: (bytes.byte() > 150).then_some(stop as unsafe extern "C" fn(_, _) -> _),
        progress_data: left.cast(),
        log: (bytes.byte() > 200).then_some(log as unsafe extern "C" fn(_, _, _)),
        log_data: ptr::null_mut(),
    }
}

fn call(bytes: &mut Bytes<'_>, world: &mut World, error: &mut HolefillError) {
    let mut room = Room::new(bytes);
    let mut other_room = Room::new(bytes);
    let mesh = HolefillMesh { id: world.pick(bytes) };
    let plan = HolefillPlan { id: world.pick(bytes) };
    let report = HolefillReport { id: world.pick(bytes) };
    let parameters = HolefillParameters { id: world.pick(bytes) };
    let mut left = bytes.number() as i64;
    let names = ["auto", "flat", "membrane", "fair-c1", "fair-c2", "none"];
    let method = match bytes.byte() as usize {
        k if k < 200 => names[k % names.len()].to_owned(),
        k => {
            let count = holefill_method_count() as usize;
            // SAFETY: the library's static texts end with a zero byte.
            let name = unsafe { std::ffi::CStr::from_ptr(holefill_method_name((k % count) as u64)) };
            name.to_string_lossy().into_owned()
        }
    };
    let method = CString::new(method).unwrap_or_default();
    let options = Longer {
        known: options(bytes, world, &raw mut left, &method),
        beyond: u64::from(bytes.byte() == 79),
    };
    let o: *const HolefillFillOptions =
        if bytes.byte() == 255 { ptr::null() } else { (&raw const options).cast() };
    let (mut new_mesh, mut new_plan, mut new_report, mut new_parameters) =
        <(HolefillMesh, HolefillPlan, HolefillReport, HolefillParameters)>::default();
    let (mut number, mut ids, mut text) = (0_u64, [0_u64; 16], [0 as c_char; 64]);
    let id = bytes.number();
    let (from, to) = (bytes.number(), bytes.number());
    let capacity = u64::from(bytes.byte()) % 16;
    let element = u32::from(bytes.byte() % 4);
    let name = CString::new(vec![b'a' + bytes.byte() % 26]).unwrap_or_default();
    let e = &raw mut *error;
    // The vertices of a loop, most of the time of this mesh.
    let mut chain = [0_u32; 64];
    // SAFETY: the pointers are to living values.
    let length = unsafe {
        let mut info = HolefillLoopInfo::default();
        holefill_mesh_loop_info(mesh, id, &mut info, ptr::null_mut());
        let length = info.vertex_count.min(64) as usize;
        let to_chain = output(&view(&chain[..length], HOLEFILL_TYPE_U32), chain.as_mut_ptr());
        holefill_mesh_read_loop(mesh, id, 0, &to_chain, ptr::null_mut());
        length
    };
    // A target of every kind, with rules, rows or a chain.
    let (ids_view, edges) = (room.view(bytes), room.view(bytes));
    let vertices = view(&chain[..length], HOLEFILL_TYPE_U32);
    let rules = HolefillSelection {
        only: if bytes.byte() > 128 { edges } else { NO_ROWS },
        max_edges: bytes.number(),
        max_perimeter: bytes.coordinate(),
        keep_largest: bytes.number(),
        ..HolefillSelection::default()
    };
    let target = Longer {
        known: HolefillTarget {
            struct_size: size_of::<HolefillTarget>() as u32 + u32::from(bytes.byte() == 77),
            kind: u32::from(bytes.byte() % 6),
            reserved: u32::from(bytes.byte() == 200),
            loop_id: id % 6,
            edge: [from, to],
            ids: match bytes.byte() {
                0..100 => &vertices,
                100..200 => &ids_view,
                _ => ptr::null(),
            },
            selection: if bytes.byte() > 99 { &rules } else { ptr::null() },
            ..HolefillTarget::default()
        },
        beyond: u64::from(bytes.byte() == 79),
    };
    let t: *const HolefillTarget =
        if bytes.byte() > 200 { ptr::null() } else { (&raw const target).cast() };
    let before = state(mesh);
    // SAFETY: every pointer is null, or to as much memory as is said beside it.
    let status = unsafe {
        match bytes.byte() % 44 {
            0..4 => {
                let (points, triangles) = grid(bytes);
                let triangles = view(&triangles, [HOLEFILL_TYPE_U32, HOLEFILL_TYPE_I32][bytes.byte() as usize % 2]);
                holefill_mesh_from_arrays(&view(&points, HOLEFILL_TYPE_F64), &triangles, &mut new_mesh, e)
            }
            4 => {
                let (p, t) = (room.view(bytes), other_room.view(bytes));
                holefill_mesh_from_arrays(&p, &t, &mut new_mesh, e)
            }
            5 => {
                let (p, n) = (room.view(bytes), other_room.view(bytes));
                let n = bytes.or_null(&n);
                holefill_mesh_from_polyline(&p, n, &mut new_mesh, e)
            }
            6 => {
                let count = 3 + bytes.byte() as usize % 20;
                let points: Vec<[f64; 3]> = (0..count)
                    .map(|_| [bytes.coordinate(), bytes.coordinate(), bytes.coordinate()])
                    .collect();
                let p = view(&points, HOLEFILL_TYPE_F64);
                let n = bytes.or_null(&p);
                holefill_mesh_from_polyline(&p, n, &mut new_mesh, e)
            }
            7 => holefill_mesh_free(mesh),
            8 => holefill_plan_free(plan),
            9 => holefill_report_free(report),
            10 => holefill_parameters_free(parameters),
            11 => holefill_error_free(HolefillError { id: world.pick(bytes) }),
            12 => holefill_mesh_prepare(mesh, e),
            13 => holefill_mesh_read_positions(mesh, id, &room.output(bytes), e),
            14 => holefill_mesh_read_triangles(mesh, id, &room.output(bytes), e),
            15 | 16 => {
                // One component, or as many as the room has for each row.
                let components = 1 + u32::from(bytes.byte() % 3);
                let view = match (info(mesh), bytes.byte() % 2) {
                    (Some(info), 0) if info.vertex_count < 80 => HolefillInput {
                        count: if element == 1 { info.vertex_count } else { info.triangle_count.min(80) },
                        ..view(&room.bytes, u32::from(bytes.byte() % 11))
                    },
                    _ => room.view(bytes),
                };
                holefill_mesh_add_attribute(mesh, element, name.as_ptr(), components, &view, e)
            }
            17 => holefill_mesh_attribute_count(mesh, element, &mut number, e),
            18 => holefill_mesh_attribute_name(mesh, element, id, text.as_mut_ptr(), capacity, &mut number, e),
            19 => {
                let mut output = room.output(bytes);
                output.count %= 20;
                output.stride = 0;
                holefill_mesh_read_attribute(mesh, element, id, from, &output, e)
            }
            20 => holefill_mesh_loop_count(mesh, &mut number, e),
            21 => holefill_mesh_read_loop(mesh, id, from, &room.output(bytes), e),
            22..25 => holefill_mesh_find_loops(mesh, t, ids.as_mut_ptr(), capacity, &mut number, e),
            25..30 => holefill_mesh_fill(mesh, t, o, &mut new_report, e),
            30 => holefill_mesh_fill_all(mesh, e),
            31..33 => holefill_mesh_plan(mesh, t, o, &mut new_plan, e),
            33 | 34 => holefill_plan_apply(plan, mesh, o, &mut new_report, e),
            35 => match bytes.byte() % 3 {
                0 => holefill_plan_report(plan, &mut new_report, e),
                1 => holefill_plan_read_positions(plan, id, from, &room.output(bytes), e),
                _ => holefill_plan_read_triangles(plan, id, from, &room.output(bytes), e),
            },
            36 => holefill_mesh_undo(mesh, e),
            37 => match bytes.byte() % 3 {
                0 => holefill_parameters_new(&mut new_parameters, e),
                1 => {
                    let k = bytes.byte() as u64 % holefill_parameter_count();
                    let value = CString::new(format!("{}", bytes.coordinate())).unwrap_or_default();
                    holefill_parameters_set(parameters, holefill_parameter_name(k), value.as_ptr(), e)
                }
                _ => holefill_parameters_get(parameters, name.as_ptr(), text.as_mut_ptr(), capacity, &mut number, e),
            },
            38 => holefill_report_reason(report, id, text.as_mut_ptr(), capacity, &mut number, e),
            39 => {
                let (p, n, c) = (room.view(bytes), other_room.view(bytes), room.view(bytes));
                let n = bytes.or_null(&n);
                let c = bytes.or_null(&c);
                holefill_mesh_from_points(&p, n, c, ptr::null(), &mut new_mesh, ptr::null_mut(), e)
            }
            40 => {
                let (points, _) = grid(bytes);
                let p = view(&points, HOLEFILL_TYPE_F64);
                let (n, c) = match bytes.byte() {
                    0..100 => (ptr::null(), ptr::null()),
                    _ => (&raw const p, &raw const p),
                };
                let point_options = HolefillPointOptions {
                    radius: if bytes.byte() < 200 { 0.0 } else { bytes.coordinate() },
                    neighbours: if bytes.byte() < 100 { 0 } else { bytes.number() as u32 },
                    threads: u32::from(bytes.byte() % 3),
                    time_budget: if bytes.byte() < 200 { 0.0 } else { bytes.coordinate() },
                    progress: options.known.progress,
                    progress_data: options.known.progress_data,
                    ..HolefillPointOptions::default()
                };
                holefill_mesh_from_points(&p, n, c, &point_options, &mut new_mesh, ptr::null_mut(), e)
            }
            41 => holefill_report_json(report, text.as_mut_ptr(), 64, &mut number, e),
            42 => {
                // A struct of any size, within its room.
                let mut prediction = Longer { known: HolefillPrediction::default(), beyond: u64::MAX };
                prediction.known.struct_size = u32::from(bytes.byte()) % (size_of::<Longer<HolefillPrediction>>() as u32 + 1);
                holefill_report_prediction(report, id, (&raw mut prediction).cast(), e)
            }
            _ => {
                let mut method = ptr::null();
                holefill_report_tried(report, id, from as u32, &mut method, text.as_mut_ptr(), capacity, &mut number, e)
            }
        }
    };
    assert_ne!(status, HOLEFILL_STATUS_PANIC);
    assert_ne!(status, HOLEFILL_STATUS_POISONED);
    assert!((0..=HOLEFILL_STATUS_PANIC).contains(&status));
    let is_done = status == HOLEFILL_STATUS_OK || status == HOLEFILL_STATUS_INCOMPLETE;
    if !is_done {
        assert_eq!(before, state(mesh), "a call that fails changes nothing");
        let made = [new_mesh.id, new_plan.id, new_report.id, new_parameters.id];
        assert_eq!(made, [0; 4], "a call that fails writes nothing");
    }
    if let (Some((old, faces, _)), Some((new, new_faces, _))) = (&before, &state(mesh)) {
        let kept = old.len().min(new.len());
        assert_eq!(old[..kept], new[..kept], "what is there keeps its bits");
        let kept = faces.len().min(new_faces.len());
        assert_eq!(faces[..kept], new_faces[..kept]);
    }
    world.ids.extend([new_mesh.id, new_plan.id, new_report.id, new_parameters.id].into_iter().filter(|&id| id != 0));
}

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes(data);
    let mut world = World::default();
    let mut error = HolefillError::default();
    for _ in 0..64 {
        if bytes.is_empty() {
            break;
        }
        call(&mut bytes, &mut world, &mut error);
    }
    for id in world.ids {
        holefill_mesh_free(HolefillMesh { id });
        holefill_plan_free(HolefillPlan { id });
        holefill_report_free(HolefillReport { id });
        holefill_parameters_free(HolefillParameters { id });
    }
    holefill_error_free(error);
    assert_eq!(holefill_handle_count(), 0, "everything was freed");
});
