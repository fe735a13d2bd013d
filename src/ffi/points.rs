//! Meshes made from points.

use super::attributes::copy_attribute;
use super::callbacks::Callbacks;
use super::failure::{Failure, not_null};
use super::guard::guard;
use super::input::{read_finite, read_optional};
use super::objects::MeshObject;
use super::options::read_options;
use super::output::hand_out;
use super::status::HolefillStatus;
use super::structs::{check_struct, read_struct, write_struct};
use super::types::*;
use crate::fill::progress::Watch;
use crate::fill::session::{FillSession, thread_pool};
use crate::job::Job;
use crate::mesh::trimesh::TriMesh;
use crate::options::FillOptions;
use crate::reconstruct::{PointCloud, PointOptions, PointReport, reconstruct};

/// Options of the caller, read.
struct Given {
    points: PointOptions,
    /// Of these, threads and time budget: they mean what they mean in a fill.
    limits: FillOptions,
    callbacks: Callbacks,
}

/// Reads options; null is the defaults.
///
/// # Safety
/// `options` is null or points to a struct as its first fields say, whose pointers are the caller's.
unsafe fn read_point_options(options: *const HolefillPointOptions) -> Result<Given, Failure> {
    // SAFETY: the caller's promise.
    let given = unsafe { read_struct(options, "options")? }.unwrap_or_default();
    let mut points = PointOptions::default();
    if given.radius != 0.0 {
        points.radius = Some(given.radius);
    }
    if given.neighbours != 0 {
        points.neighbours = given.neighbours as usize;
    }
    let limits = HolefillFillOptions {
        threads: given.threads,
        time_budget: given.time_budget,
        progress: given.progress,
        progress_data: given.progress_data,
        ..Default::default()
    };
    // SAFETY: the caller's promise is that the callback can be called during the call.
    let (limits, callbacks) = unsafe { read_options(&limits)? };
    Ok(Given {
        points,
        limits,
        callbacks,
    })
}

/// Makes the mesh, on as many threads and for as long as is allowed.
fn make(cloud: PointCloud, given: &Given) -> Result<(TriMesh, PointReport), Failure> {
    let pool = thread_pool(&given.limits)?;
    given.callbacks.with_progress(|progress| {
        let watch = Watch::new(0, given.limits.time_budget, progress);
        let made = pool.install(|| reconstruct(cloud, &given.points, &Job::new(&watch)));
        Ok(made.map_err(|e| watch.explain(e))?)
    })
}

/// Makes a mesh from copies of unorganized points, such as those of a scanner: oriented, without edges of more than two
/// triangles, and open where there are no samples. Its holes are filled like those of any mesh.
///
/// `points`: rows of three, `float` or `double`. They are the vertices, all of them, in their order and, in double
/// precision, with their bits; those that no triangle uses stay as isolated vertices.
///
/// `normals` may be null. Otherwise it has a row of three for each point, of any length, pointing outward: triangles face
/// where they point. A normal that is zero is not known and is estimated, as all are without `normals`; each piece of
/// surface then faces away from its middle. Normals are not kept: `holefill_mesh_add_attribute` does that.
///
/// `colors` may be null. Otherwise it has a row of three numbers for each point, of any type of an attribute, which become
/// the vertex attribute `color`: as if added by `holefill_mesh_add_attribute`.
///
/// `options` may be null. `mesh` gets the handle. `summary` may be null; otherwise it gets what became of the points.
///
/// Time is O(n log n), memory about 1 kB for each point.
///
/// Statuses: as `holefill_mesh_from_arrays`, but for `INDEX_OUT_OF_RANGE`; `INVALID_ARGUMENT` also for fewer than four
/// different points, points on one line, points of which no three make a triangle, another number of normals or colors, and
/// options out of range; `LIMIT` also when the time ran out; `CANCELLED`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn holefill_mesh_from_points(
    points: *const HolefillInput,
    normals: *const HolefillInput,
    colors: *const HolefillInput,
    options: *const HolefillPointOptions,
    mesh: *mut HolefillMesh,
    summary: *mut HolefillPointSummary,
    error: *mut HolefillError,
) -> HolefillStatus {
    guard(error, || {
        not_null(mesh.cast_const(), "mesh")?;
        if !summary.is_null() {
            // SAFETY: not null, and the caller's promise.
            unsafe { check_struct(summary.cast_const(), "summary")? };
        }
        // SAFETY: the caller's promise.
        let given = unsafe { read_point_options(options)? };
        // SAFETY: as above.
        let mut cloud = PointCloud::new(unsafe { read_finite(points, "points")? });
        // SAFETY: as above.
        cloud.normals = unsafe { read_optional(normals, "normals")? };
        let mut color = None;
        if !colors.is_null() {
            let count = cloud.positions.len();
            // SAFETY: as above.
            let (named, columns) = unsafe { copy_attribute("color", 3, colors, count, "colors")? };
            for (name, values) in columns {
                cloud.attributes.push(name, values)?;
            }
            color = Some(named);
        }
        let (built, report) = make(cloud, &given)?;
        let mut object = MeshObject::new(FillSession::new(built));
        object.attributes[0].extend(color);
        // SAFETY: as above.
        unsafe { hand_out(object, mesh, "mesh")? };
        if !summary.is_null() {
            let value = HolefillPointSummary {
                used: report.used as u64,
                duplicates: report.duplicates as u64,
                unused: report.unused as u64,
                triangle_count: report.triangles as u64,
                piece_count: report.pieces as u64,
                estimated_normals: report.estimated_normals as u64,
                radius: report.radius,
                ..Default::default()
            };
            // SAFETY: not null, and checked before.
            unsafe { write_struct(summary, &value, "summary")? };
        }
        Ok(())
    })
}
