//! The C interface as C sees it: every function, every status, every kind of misuse.

/// The status of a call without an error object. Pointers are null or to living values.
macro_rules! call {
    ($function:ident: $($argument:expr),*) => {
        // SAFETY: as said above.
        unsafe { $function($($argument,)* nothing()) }
    };
}

/// Makes a call that must succeed.
macro_rules! ok {
    ($function:ident: $($argument:expr),*) => {
        assert_eq!(call!($function: $($argument),*), OK)
    };
}

/// The status of a call, and what its error object says then.
macro_rules! said {
    ($function:ident: $($argument:expr),*) => {
        // SAFETY: as said above.
        explained(|error| unsafe { $function($($argument,)* error) })
    };
}

/// The struct that a call writes, which must succeed.
macro_rules! got {
    ($function:ident: $($argument:expr),*) => {{
        let mut value = Default::default();
        ok!($function: $($argument,)* &mut value);
        value
    }};
}

/// The text that a function writes to a buffer of the caller.
macro_rules! told {
    ($function:ident: $($argument:expr),*) => {
        text(&|buffer, capacity, length| call!($function: $($argument),*, buffer, capacity, length))
    };
}

mod calls;
mod cancel;
mod cost;
#[cfg(unix)]
mod latency;
mod misuse;
mod points;
mod reach;
mod refusals;
mod sessions;
mod threads;

use super::objects::Handle;
use super::status::{
    HOLEFILL_STATUS_BUFFER_TOO_SMALL as TOO_SMALL, HOLEFILL_STATUS_BUSY as BUSY,
    HOLEFILL_STATUS_CANCELLED as CANCELLED, HOLEFILL_STATUS_INCOMPLETE as INCOMPLETE,
    HOLEFILL_STATUS_INDEX_OUT_OF_RANGE as OUT_OF_RANGE,
    HOLEFILL_STATUS_INVALID_ARGUMENT as INVALID, HOLEFILL_STATUS_INVALID_HANDLE as INVALID_HANDLE,
    HOLEFILL_STATUS_INVALID_STRUCT as INVALID_STRUCT, HOLEFILL_STATUS_LIMIT as LIMIT,
    HOLEFILL_STATUS_NOT_FINITE as NOT_FINITE, HOLEFILL_STATUS_NOT_FOUND as NOT_FOUND,
    HOLEFILL_STATUS_NOTHING_TO_UNDO as NOTHING_TO_UNDO, HOLEFILL_STATUS_NULL_POINTER as NULL,
    HOLEFILL_STATUS_OK as OK, HOLEFILL_STATUS_OUT_OF_MEMORY as NO_MEMORY,
    HOLEFILL_STATUS_OVERFLOW as OVERFLOW, HOLEFILL_STATUS_PANIC as PANIC,
    HOLEFILL_STATUS_POISONED as POISONED, HOLEFILL_STATUS_STALE_PLAN as STALE_PLAN,
    HOLEFILL_STATUS_TOPOLOGY as TOPOLOGY,
};
use super::*;
use crate::fixtures::{self, Arrays};
use std::ffi::{CStr, CString, c_char, c_void};
use std::ptr;

/// A handle that is freed at the end.
struct Owned<H: Handle>(H);

impl<H: Handle> Drop for Owned<H> {
    fn drop(&mut self) {
        // The handle may have been freed before.
        let _ = objects::free(self.0);
    }
}

/// Numbers, and rows of them, that C has a type for.
trait Numbers {
    const TYPE: HolefillType;
}

macro_rules! numbers {
    ($($number:ident $scalar_type:ident)*) => {
        $(impl Numbers for $number {
            const TYPE: HolefillType = $scalar_type;
        })*
    };
}
numbers! {
    i8 HOLEFILL_TYPE_I8 u8 HOLEFILL_TYPE_U8 i16 HOLEFILL_TYPE_I16
    i32 HOLEFILL_TYPE_I32 u32 HOLEFILL_TYPE_U32 i64 HOLEFILL_TYPE_I64 u64 HOLEFILL_TYPE_U64
    f32 HOLEFILL_TYPE_F32 f64 HOLEFILL_TYPE_F64
}

impl<T: Numbers, const N: usize> Numbers for [T; N] {
    const TYPE: HolefillType = T::TYPE;
}

fn rows<T: Numbers>(rows: &[T]) -> HolefillInput {
    HolefillInput {
        data: rows.as_ptr().cast(),
        count: rows.len() as u64,
        stride: 0,
        scalar_type: T::TYPE,
        reserved: 0,
    }
}

fn place<T: Numbers>(rows: &mut [T]) -> HolefillOutput {
    HolefillOutput {
        data: rows.as_mut_ptr().cast(),
        count: rows.len() as u64,
        stride: 0,
        scalar_type: T::TYPE,
        reserved: 0,
    }
}

/// So many rows, read by a call that must succeed.
fn read<T: Numbers + Clone>(
    count: u64,
    zero: T,
    call: impl FnOnce(&HolefillOutput) -> HolefillStatus,
) -> Vec<T> {
    let mut values = vec![zero; count as usize];
    assert_eq!(call(&place(&mut values)), OK);
    values
}

/// A change of options, and how a call with them ends.
type Change<T> = (fn(&mut T), HolefillStatus);

fn nothing() -> *mut HolefillError {
    ptr::null_mut()
}

fn mesh_of(arrays: &Arrays) -> Owned<HolefillMesh> {
    let mut mesh = HolefillMesh::default();
    let positions = rows(&arrays.positions);
    let triangles = rows(&arrays.triangles);
    ok!(holefill_mesh_from_arrays: &positions, &triangles, &mut mesh);
    Owned(mesh)
}

/// A sphere with two holes of some 20 and 30 edges.
fn holed() -> Arrays {
    fixtures::sphere(14).cut(|c| c[2] > 0.75 || c[2] < -0.8)
}

fn holed_mesh() -> Owned<HolefillMesh> {
    mesh_of(&holed())
}

fn info(mesh: HolefillMesh) -> HolefillMeshInfo {
    got!(holefill_mesh_info: mesh)
}

fn positions(mesh: HolefillMesh) -> Vec<[f64; 3]> {
    let count = info(mesh).vertex_count;
    read(
        count,
        [0.0; 3],
        |to| call!(holefill_mesh_read_positions: mesh, 0, to),
    )
}

fn triangles(mesh: HolefillMesh) -> Vec<[u32; 3]> {
    let count = info(mesh).triangle_count;
    read(
        count,
        [0; 3],
        |to| call!(holefill_mesh_read_triangles: mesh, 0, to),
    )
}

fn loop_count(mesh: HolefillMesh) -> u64 {
    let mut count = 0;
    ok!(holefill_mesh_loop_count: mesh, &mut count);
    count
}

fn loop_info(mesh: HolefillMesh, id: u64) -> HolefillLoopInfo {
    got!(holefill_mesh_loop_info: mesh, id)
}

fn loop_vertices(mesh: HolefillMesh, id: u64) -> Vec<u64> {
    let count = loop_info(mesh, id).vertex_count;
    read(
        count,
        0,
        |to| call!(holefill_mesh_read_loop: mesh, id, 0, to),
    )
}

/// A number for everything that a mesh holds and that can be read (FNV-1a).
fn digest(mesh: HolefillMesh) -> u64 {
    let mut bytes: Vec<u8> = bytemuck::cast_slice(&positions(mesh)).to_vec();
    bytes.extend_from_slice(bytemuck::cast_slice(&triangles(mesh)));
    bytes.extend(info(mesh).undo_count.to_ne_bytes());
    for id in 0..loop_count(mesh) {
        bytes.extend(loop_info(mesh, id).is_open.to_ne_bytes());
    }
    for element in [HOLEFILL_ELEMENT_VERTEX, HOLEFILL_ELEMENT_TRIANGLE] {
        let mut count = 0;
        call!(holefill_mesh_attribute_count: mesh, element, &mut count);
        for index in 0..count {
            let info: HolefillAttributeInfo =
                got!(holefill_mesh_attribute_info: mesh, element, index);
            let mut values = vec![0.0_f64; (info.count * u64::from(info.components)) as usize];
            let mut output = place(&mut values);
            output.count = info.count;
            ok!(holefill_mesh_read_attribute: mesh, element, index, 0, &output);
            bytes.extend_from_slice(bytemuck::cast_slice(&values));
        }
    }
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// What a function writes that hands out a text.
type Writer<'a> = &'a dyn Fn(*mut c_char, u64, *mut u64) -> HolefillStatus;

/// Reads a text by two calls, and checks what happens when it does not fit.
fn text(write: Writer<'_>) -> String {
    let mut length = u64::MAX;
    assert_eq!(write(ptr::null_mut(), 0, &mut length), OK);
    let size = length as usize;
    let mut buffer = vec![0x55_u8; size + 2];
    if size > 0 {
        let status = write(buffer.as_mut_ptr().cast(), size as u64, &mut length);
        assert_eq!(status, TOO_SMALL);
        assert!(buffer.iter().all(|&b| b == 0x55), "nothing is written");
    }
    let status = write(buffer.as_mut_ptr().cast(), size as u64 + 1, &mut length);
    assert_eq!(status, OK);
    assert_eq!(
        (length as usize, buffer[size], buffer[size + 1]),
        (size, 0, 0x55)
    );
    String::from_utf8(buffer[..size].to_vec()).unwrap()
}

fn static_text(text: *const c_char) -> Option<&'static str> {
    if text.is_null() {
        return None;
    }
    // SAFETY: the library's static texts end with a zero byte.
    unsafe { CStr::from_ptr(text) }.to_str().ok()
}

fn message(error: HolefillError) -> String {
    // SAFETY: `text` gives room as it says.
    text(&|buffer, capacity, length| unsafe {
        holefill_error_message(error, buffer, capacity, length)
    })
}

fn explained(call: impl FnOnce(*mut HolefillError) -> HolefillStatus) -> (HolefillStatus, String) {
    let mut error = Owned(HolefillError::default());
    let status = call(&mut error.0);
    if status == OK {
        assert_eq!(error.0.id, 0, "success leaves it alone");
        return (OK, String::new());
    }
    let mut stored = OK;
    // SAFETY: the pointer is to a living value.
    assert_eq!(unsafe { holefill_error_status(error.0, &mut stored) }, OK);
    assert_eq!(stored, status);
    (status, message(error.0))
}

fn options() -> HolefillFillOptions {
    HolefillFillOptions {
        threads: 1,
        ..Default::default()
    }
}

fn with_method(method: &'static CStr) -> HolefillFillOptions {
    HolefillFillOptions {
        method: method.as_ptr(),
        ..options()
    }
}

/// A target of this kind, and nothing else.
fn target(kind: HolefillTargetKind) -> HolefillTarget {
    HolefillTarget {
        kind,
        ..Default::default()
    }
}

fn at_loop(loop_id: u64) -> HolefillTarget {
    HolefillTarget {
        loop_id,
        ..target(HOLEFILL_TARGET_LOOP)
    }
}

fn at_edge(edge: [u64; 2]) -> HolefillTarget {
    HolefillTarget {
        edge,
        ..target(HOLEFILL_TARGET_EDGE)
    }
}

/// Loops or vertices by their numbers.
fn at_ids(kind: HolefillTargetKind, ids: &HolefillInput) -> HolefillTarget {
    HolefillTarget {
        ids,
        ..target(kind)
    }
}

fn selected(selection: &HolefillSelection) -> HolefillTarget {
    HolefillTarget {
        selection,
        ..target(HOLEFILL_TARGET_SELECTED)
    }
}

fn every_loop() -> HolefillTarget {
    target(HOLEFILL_TARGET_SELECTED)
}

/// The loops that a target names.
fn found(mesh: HolefillMesh, target: &HolefillTarget) -> Result<Vec<u64>, HolefillStatus> {
    let (mut ids, mut count) = ([u64::MAX; 8], 0);
    let status = call!(holefill_mesh_find_loops: mesh, target, ids.as_mut_ptr(), 8, &mut count);
    match status {
        OK => Ok(ids[..count as usize].to_vec()),
        _ => Err(status),
    }
}

fn fill(
    mesh: HolefillMesh,
    target: &HolefillTarget,
    options: &HolefillFillOptions,
) -> HolefillStatus {
    call!(holefill_mesh_fill: mesh, target, options, ptr::null_mut())
}

fn fill_loop(mesh: HolefillMesh, id: u64, options: &HolefillFillOptions) -> HolefillStatus {
    fill(mesh, &at_loop(id), options)
}

fn fill_all(mesh: HolefillMesh, options: &HolefillFillOptions) -> HolefillStatus {
    fill(mesh, &every_loop(), options)
}

/// Fills, and returns the report too.
fn report_of(
    mesh: HolefillMesh,
    target: &HolefillTarget,
    options: &HolefillFillOptions,
) -> (HolefillStatus, Owned<HolefillReport>) {
    let mut report = HolefillReport::default();
    let status = call!(holefill_mesh_fill: mesh, target, options, &mut report);
    (status, Owned(report))
}

fn hole(report: &Owned<HolefillReport>, index: u64) -> HolefillHole {
    let hole: HolefillHole = got!(holefill_report_hole: report.0, index);
    hole
}

fn reason(report: &Owned<HolefillReport>, index: u64) -> String {
    told!(holefill_report_reason: report.0, index)
}

/// Makes a set of parameters with one of them set.
fn parameters(name: &CStr, value: &CStr) -> Owned<HolefillParameters> {
    let mut made = HolefillParameters::default();
    call!(holefill_parameters_new: &mut made);
    ok!(holefill_parameters_set: made, name.as_ptr(), value.as_ptr());
    Owned(made)
}

fn undo(mesh: HolefillMesh) -> HolefillStatus {
    call!(holefill_mesh_undo: mesh)
}

fn plan_loop(mesh: HolefillMesh, id: u64, options: &HolefillFillOptions) -> Owned<HolefillPlan> {
    let mut plan = HolefillPlan::default();
    ok!(holefill_mesh_plan: mesh, &at_loop(id), options, &mut plan);
    Owned(plan)
}

fn apply(plan: &Owned<HolefillPlan>, mesh: HolefillMesh) -> HolefillStatus {
    call!(holefill_plan_apply: plan.0, mesh, ptr::null(), ptr::null_mut())
}

/// New vertices and triangles of the patch for a loop.
fn patch(plan: &Owned<HolefillPlan>, id: u64) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let info: HolefillPatchInfo = got!(holefill_plan_patch: plan.0, id);
    let (vertices, triangles) = (info.vertex_count, info.triangle_count);
    (
        read(
            vertices,
            [0.0; 3],
            |to| call!(holefill_plan_read_positions: plan.0, id, 0, to),
        ),
        read(
            triangles,
            [0; 3],
            |to| call!(holefill_plan_read_triangles: plan.0, id, 0, to),
        ),
    )
}

/// A callback that stops at its `n`-th call; `user_data` is the number of calls that are left.
unsafe extern "C" fn stop_at(_: *const HolefillProgress, user_data: *mut c_void) -> i32 {
    let left: *mut i64 = user_data.cast();
    // SAFETY: the tests hand a number over; calls come one at a time.
    unsafe {
        *left -= 1;
        i32::from(*left < 0)
    }
}
