//! What handles stand for, and the one table of them.

use super::guard::Failure;
use super::handles::Table;
use super::mesh::MeshObject;
use super::plan::PlanObject;
use super::shared::{Reader, Refusal, Shared, Writer};
use super::status::{
    HOLEFILL_STATUS_BUSY, HOLEFILL_STATUS_INVALID_HANDLE, HOLEFILL_STATUS_LIMIT,
    HOLEFILL_STATUS_POISONED,
};
use crate::fill::options::FillOptions;
use crate::fill::report::FillReport;
use std::sync::{Arc, LazyLock, Mutex};

pub(super) const MESH: u8 = 1;
pub(super) const PLAN: u8 = 2;
pub(super) const REPORT: u8 = 3;
pub(super) const PARAMETERS: u8 = 4;
pub(super) const ERROR: u8 = 5;

/// An object that C holds a handle of; its kind is that of the handle.
pub(super) enum Object {
    Mesh(Box<Shared<MeshObject>>),
    Plan(PlanObject),
    Report(FillReport),
    Parameters(Mutex<FillOptions>),
    Error(Mutex<Failure>),
}

impl Object {
    pub(super) fn mesh(mesh: MeshObject) -> Self {
        Self::Mesh(Box::new(Shared::new(mesh)))
    }

    fn kind(&self) -> u8 {
        match self {
            Self::Mesh(_) => MESH,
            Self::Plan(_) => PLAN,
            Self::Report(_) => REPORT,
            Self::Parameters(_) => PARAMETERS,
            Self::Error(_) => ERROR,
        }
    }
}

/// The only state of the library that calls share.
pub(super) static TABLE: LazyLock<Table<Object>> = LazyLock::new(|| {
    // The process, and where this copy of the library was loaded; nothing but the handles depends on it. The
    // multiplication (by 2^64 over the golden ratio) brings all bits into the upper ones.
    let place = std::ptr::from_ref(&TABLE).addr() as u64;
    let mixed = (place ^ u64::from(std::process::id())).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    Table::new(mixed >> 52)
});

/// The words for the objects of a kind.
fn noun(kind: u8) -> &'static str {
    match kind {
        MESH => "mesh",
        PLAN => "plan",
        REPORT => "report",
        PARAMETERS => "set of parameters",
        _ => "error",
    }
}

/// Keeps an object and returns its handle.
pub(super) fn keep(object: Object) -> Result<u64, Failure> {
    TABLE
        .insert(object.kind(), object)
        .map_err(|_| Failure::new(HOLEFILL_STATUS_LIMIT, "there are too many handles"))
}

/// The living object of a handle.
pub(super) fn find(kind: u8, handle: u64) -> Result<Arc<Object>, Failure> {
    TABLE.get(kind, handle).ok_or_else(|| invalid_handle(kind))
}

/// Ends the life of an object. The handle 0 is none, and may be freed.
pub(super) fn free(kind: u8, handle: u64) -> Result<(), Failure> {
    if handle == 0 {
        return Ok(());
    }
    match TABLE.remove(kind, handle) {
        Some(_) => Ok(()),
        None => Err(invalid_handle(kind)),
    }
}

pub(super) fn invalid_handle(kind: u8) -> Failure {
    Failure::new(
        HOLEFILL_STATUS_INVALID_HANDLE,
        format!("the handle is that of no living {}", noun(kind)),
    )
}

/// Calls `body` with a mesh to read.
pub(super) fn with_mesh<R>(
    handle: u64,
    body: impl FnOnce(&MeshObject) -> Result<R, Failure>,
) -> Result<R, Failure> {
    match &*find(MESH, handle)? {
        Object::Mesh(mesh) => {
            let mesh: Reader<'_, MeshObject> = mesh.read().map_err(refused)?;
            body(&mesh)
        }
        _ => Err(invalid_handle(MESH)),
    }
}

/// Calls `body` with a mesh to change.
pub(super) fn with_mesh_mut<R>(
    handle: u64,
    body: impl FnOnce(&mut MeshObject) -> Result<R, Failure>,
) -> Result<R, Failure> {
    match &*find(MESH, handle)? {
        Object::Mesh(mesh) => {
            let mut mesh: Writer<'_, MeshObject> = mesh.write().map_err(refused)?;
            body(&mut mesh)
        }
        _ => Err(invalid_handle(MESH)),
    }
}

/// Calls `body` with a plan.
pub(super) fn with_plan<R>(
    handle: u64,
    body: impl FnOnce(&PlanObject) -> Result<R, Failure>,
) -> Result<R, Failure> {
    match &*find(PLAN, handle)? {
        Object::Plan(plan) => body(plan),
        _ => Err(invalid_handle(PLAN)),
    }
}

/// Calls `body` with a report.
pub(super) fn with_report<R>(
    handle: u64,
    body: impl FnOnce(&FillReport) -> Result<R, Failure>,
) -> Result<R, Failure> {
    match &*find(REPORT, handle)? {
        Object::Report(report) => body(report),
        _ => Err(invalid_handle(REPORT)),
    }
}

/// Calls `body` with a set of parameters; other threads wait for that moment.
pub(super) fn with_parameters<R>(
    handle: u64,
    body: impl FnOnce(&mut FillOptions) -> Result<R, Failure>,
) -> Result<R, Failure> {
    match &*find(PARAMETERS, handle)? {
        Object::Parameters(options) => body(&mut options.lock().unwrap_or_else(|e| e.into_inner())),
        _ => Err(invalid_handle(PARAMETERS)),
    }
}

fn refused(refusal: Refusal) -> Failure {
    Failure::of(match refusal {
        Refusal::Busy => HOLEFILL_STATUS_BUSY,
        Refusal::Poisoned => HOLEFILL_STATUS_POISONED,
    })
}
