//! What handles stand for, and the one table of them.

use super::failure::{Failure, not_found};
use super::handles::HandleTable;
use super::shared::{Refusal, Shared};
use super::status::{
    HOLEFILL_STATUS_BUSY, HOLEFILL_STATUS_INVALID_HANDLE, HOLEFILL_STATUS_LIMIT,
    HOLEFILL_STATUS_POISONED,
};
use super::types::*;
use crate::fill::report::FillReport;
use crate::fill::session::{FillPlan, FillSession, PlannedPatch};
use crate::options::FillOptions;
use std::sync::{LazyLock, Mutex, MutexGuard, OnceLock};

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

/// Ends the life of an object. The handle 0 is none, and may be freed.
pub(super) fn free<H: Handle>(handle: H) -> Result<(), Failure> {
    match handle.id() == 0 || TABLE.remove(H::KIND, handle.id()).is_some() {
        true => Ok(()),
        false => Err(unknown::<H>()),
    }
}

fn unknown<H: Handle>() -> Failure {
    let message = format!("the handle is that of no living {}", H::NOUN);
    Failure::new(HOLEFILL_STATUS_INVALID_HANDLE, message)
}

fn refused(refusal: Refusal) -> Failure {
    Failure::of(match refusal {
        Refusal::Busy => HOLEFILL_STATUS_BUSY,
        Refusal::Poisoned => HOLEFILL_STATUS_POISONED,
    })
}

/// What is behind a lock that is held for a moment only. It is sound after every statement, so a panic meanwhile does
/// not matter.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|e| e.into_inner())
}

/// A handle as C has it, and what it stands for.
pub(super) trait Handle: Copy {
    type Object;
    const KIND: u8;
    /// What it is called in messages.
    const NOUN: &'static str;

    fn id(self) -> u64;

    /// Calls `body` with the living object of the handle.
    fn with<R>(self, body: impl FnOnce(&Self::Object) -> Result<R, Failure>) -> Result<R, Failure>;
}

macro_rules! handles {
    ($($handle:ident $kind:literal $noun:literal $variant:ident($object:ident: $given:ty) => $read:expr;)*) => {
        $(
            impl Handle for $handle {
                type Object = $given;
                const KIND: u8 = $kind;
                const NOUN: &'static str = $noun;

                fn id(self) -> u64 {
                    self.id
                }

                fn with<R>(self, body: impl FnOnce(&$given) -> Result<R, Failure>) -> Result<R, Failure> {
                    match TABLE.get($kind, self.id).as_deref() {
                        Some(Object::$variant($object)) => body($read),
                        _ => Err(unknown::<Self>()),
                    }
                }
            }
        )*

        impl Object {
            fn kind(&self) -> u8 {
                match self {
                    $(Self::$variant(_) => $kind,)*
                }
            }
        }
    };
}
handles! {
    HolefillMesh 1 "mesh" Mesh(mesh: MeshObject) => &*mesh.read().map_err(refused)?;
    HolefillPlan 2 "plan" Plan(plan: PlanObject) => plan;
    HolefillReport 3 "report" Report(report: FillReport) => report;
    HolefillParameters 4 "set of parameters" Parameters(options: Mutex<FillOptions>) => options;
    HolefillError 5 "error" Error(failure: Mutex<Failure>) => failure;
}

/// Calls `body` with a mesh to change.
pub(super) fn with_mesh_mut<R>(
    mesh: HolefillMesh,
    body: impl FnOnce(&mut MeshObject) -> Result<R, Failure>,
) -> Result<R, Failure> {
    match TABLE.get(HolefillMesh::KIND, mesh.id).as_deref() {
        Some(Object::Mesh(object)) => body(&mut *object.write().map_err(refused)?),
        _ => Err(unknown::<HolefillMesh>()),
    }
}
