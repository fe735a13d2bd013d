//! What handles stand for, and the one table of them.

use super::failure::{Failure, not_found};
use super::handles::HandleTable;
use super::shared::{Refusal, Shared};
use super::status::{
    HOLEFILL_STATUS_BUSY, HOLEFILL_STATUS_INVALID_HANDLE, HOLEFILL_STATUS_LIMIT,
    HOLEFILL_STATUS_POISONED,
};
use super::types::HolefillType;
use crate::fill::report::FillReport;
use crate::fill::session::{FillPlan, FillSession, PlannedPatch};
use crate::options::FillOptions;
use std::sync::{Arc, LazyLock, Mutex, OnceLock};

/// A mesh that C has a handle of.
pub(super) struct MeshObject {
    pub(super) session: FillSession,
    /// Vertices and triangles that it was made with.
    pub(super) input: [usize; 2],
    /// The attributes of the vertices and of the triangles.
    pub(super) attributes: [Vec<NamedColumns>; 2],
}

impl MeshObject {
    pub(super) fn new(session: FillSession) -> Self {
        let mesh = session.mesh();
        Self {
            input: [mesh.positions().len(), mesh.triangles().len()],
            attributes: [Vec::new(), Vec::new()],
            session,
        }
    }
}

/// An attribute as C knows it.
pub(super) struct NamedColumns {
    pub(super) name: String,
    pub(super) scalar_type: HolefillType,
    /// The names of its columns, one for each component.
    pub(super) columns: Vec<String>,
}

/// A plan that C has a handle of.
pub(super) struct PlanObject {
    pub(super) plan: FillPlan,
    /// Its patches as C reads them, by the ids of their loops. They are made at the first use.
    patches: OnceLock<Vec<PlannedPatch>>,
}

impl PlanObject {
    pub(super) fn new(plan: FillPlan) -> Self {
        Self {
            plan,
            patches: OnceLock::new(),
        }
    }

    pub(super) fn patch(&self, loop_id: u64) -> Result<&PlannedPatch, Failure> {
        let patches = self.patches.get_or_init(|| {
            let ids = self.plan.report().holes.iter().map(|h| h.id);
            ids.filter_map(|id| self.plan.patch(id)).collect()
        });
        let found = patches.iter().find(|p| p.loop_id as u64 == loop_id);
        found.ok_or_else(|| not_found(format!("the plan has no patch for loop {loop_id}")))
    }
}

pub(super) const MESH: u8 = 1;
pub(super) const PLAN: u8 = 2;
pub(super) const REPORT: u8 = 3;
pub(super) const PARAMETERS: u8 = 4;
pub(super) const ERROR: u8 = 5;

/// An object that C holds a handle of. Its kind is that of the handle.
pub(super) enum Object {
    Mesh(Box<Shared<MeshObject>>),
    Plan(PlanObject),
    Report(FillReport),
    Parameters(Mutex<FillOptions>),
    Error(Mutex<Failure>),
}

impl Object {
    pub(super) fn mesh(session: FillSession) -> Self {
        Self::from(MeshObject::new(session))
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

impl From<MeshObject> for Object {
    fn from(mesh: MeshObject) -> Self {
        Self::Mesh(Box::new(Shared::new(mesh)))
    }
}

/// The only state of the library that calls share.
pub(super) static TABLE: LazyLock<HandleTable<Object>> = LazyLock::new(|| {
    // The process, and where this copy of the library was loaded. Nothing but the handles depends on it. The
    // multiplication (by 2^64 over the golden ratio) brings all bits into the upper ones.
    let place = std::ptr::from_ref(&TABLE).addr() as u64;
    let mixed = (place ^ u64::from(std::process::id())).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    HandleTable::new(mixed >> 52)
});

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
    match handle == 0 || TABLE.remove(kind, handle).is_some() {
        true => Ok(()),
        false => Err(invalid_handle(kind)),
    }
}

pub(super) fn invalid_handle(kind: u8) -> Failure {
    let noun = match kind {
        MESH => "mesh",
        PLAN => "plan",
        REPORT => "report",
        PARAMETERS => "set of parameters",
        _ => "error",
    };
    let message = format!("the handle is that of no living {noun}");
    Failure::new(HOLEFILL_STATUS_INVALID_HANDLE, message)
}

fn refused(refusal: Refusal) -> Failure {
    Failure::of(match refusal {
        Refusal::Busy => HOLEFILL_STATUS_BUSY,
        Refusal::Poisoned => HOLEFILL_STATUS_POISONED,
    })
}

macro_rules! with_object {
    ($(#[$doc:meta] $name:ident($kind:ident $variant:ident: $given:ty) by $body:ident, $object:ident => $call:expr;)*) => {
        $(
            #[$doc]
            pub(super) fn $name<R>(
                handle: u64,
                $body: impl FnOnce($given) -> Result<R, Failure>,
            ) -> Result<R, Failure> {
                match &*find($kind, handle)? {
                    Object::$variant($object) => $call,
                    _ => Err(invalid_handle($kind)),
                }
            }
        )*
    };
}
with_object! {
    /// Calls `body` with a mesh to read.
    with_mesh(MESH Mesh: &MeshObject) by body, mesh => body(&*mesh.read().map_err(refused)?);
    /// Calls `body` with a mesh to change.
    with_mesh_mut(MESH Mesh: &mut MeshObject) by body, mesh => body(&mut *mesh.write().map_err(refused)?);
    /// Calls `body` with a plan.
    with_plan(PLAN Plan: &PlanObject) by body, plan => body(plan);
    /// Calls `body` with a report.
    with_report(REPORT Report: &FillReport) by body, report => body(report);
    /// Calls `body` with a set of parameters. Other threads wait for that moment.
    with_parameters(PARAMETERS Parameters: &mut FillOptions) by body, options =>
        body(&mut options.lock().unwrap_or_else(|e| e.into_inner()));
    /// Calls `body` with an error.
    with_error(ERROR Error: &Failure) by body, error => body(&error.lock().unwrap_or_else(|e| e.into_inner()));
}
