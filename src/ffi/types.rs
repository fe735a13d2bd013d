//! The structs and constants of the C interface.

use std::ffi::{c_char, c_void};

/// A mesh with its boundary loops, or a polyline. The handle 0 is none. Free with `holefill_mesh_free`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HolefillMesh {
    /// The handle; 0 is none.
    pub id: u64,
}

/// Patches that were planned and are not part of their mesh. Free with `holefill_plan_free`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HolefillPlan {
    /// The handle; 0 is none.
    pub id: u64,
}

/// What happened to each hole. Free with `holefill_report_free`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HolefillReport {
    /// The handle; 0 is none.
    pub id: u64,
}

/// Values of the parameters that have names. Free with `holefill_parameters_free`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HolefillParameters {
    /// The handle; 0 is none, and stands for the defaults.
    pub id: u64,
}

/// The status and message of the last call that failed with this handle as its `error` argument. Start with 0. A
/// failing call makes the object and writes its handle, or changes the object that the handle already names; a
/// call that does not fail leaves both alone. Free with `holefill_error_free`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HolefillError {
    /// The handle; 0 is none.
    pub id: u64,
}

/// The type of numbers: one of the `HOLEFILL_TYPE_` constants.
pub type HolefillType = u32;
/// `int8_t`
pub const HOLEFILL_TYPE_I8: HolefillType = 1;
/// `uint8_t`
pub const HOLEFILL_TYPE_U8: HolefillType = 2;
/// `int16_t`
pub const HOLEFILL_TYPE_I16: HolefillType = 3;
/// `uint16_t`
pub const HOLEFILL_TYPE_U16: HolefillType = 4;
/// `int32_t`
pub const HOLEFILL_TYPE_I32: HolefillType = 5;
/// `uint32_t`
pub const HOLEFILL_TYPE_U32: HolefillType = 6;
/// `int64_t`; for indices and ids only
pub const HOLEFILL_TYPE_I64: HolefillType = 7;
/// `uint64_t`; for indices and ids only
pub const HOLEFILL_TYPE_U64: HolefillType = 8;
/// `float`
pub const HOLEFILL_TYPE_F32: HolefillType = 9;
/// `double`
pub const HOLEFILL_TYPE_F64: HolefillType = 10;

/// Rows of numbers that the library reads during the call, and never after it. How many numbers make a row, and which
/// types are allowed, is said where one is taken.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillInput {
    /// The first number of the first row; need not be aligned; may be null when `count` is 0.
    pub data: *const c_void,
    /// Number of rows.
    pub count: u64,
    /// Bytes from a row to the next; 0 when they follow each other without a gap. Rows must not overlap.
    pub stride: u64,
    /// The type of the numbers.
    pub scalar_type: HolefillType,
    /// Must be 0.
    pub reserved: u32,
}

/// Memory of the caller that the library writes rows of numbers to during the call, and never after it. Bytes between
/// the rows are left alone.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillOutput {
    /// Where the first number of the first row goes; need not be aligned; may be null when `count` is 0.
    pub data: *mut c_void,
    /// Number of rows to write.
    pub count: u64,
    /// Bytes from a row to the next; 0 when they follow each other without a gap. Rows must not overlap.
    pub stride: u64,
    /// The type of the numbers.
    pub scalar_type: HolefillType,
    /// Must be 0.
    pub reserved: u32,
}

/// What an attribute belongs to: one of the `HOLEFILL_ELEMENT_` constants.
pub type HolefillElement = u32;
/// Vertices.
pub const HOLEFILL_ELEMENT_VERTEX: HolefillElement = 1;
/// Triangles.
pub const HOLEFILL_ELEMENT_TRIANGLE: HolefillElement = 2;

/// The version of `HolefillMeshInfo`.
pub const HOLEFILL_MESH_INFO_VERSION: u32 = 1;
/// The size of a mesh.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillMeshInfo {
    /// `sizeof(HolefillMeshInfo)`
    pub struct_size: u32,
    /// `HOLEFILL_MESH_INFO_VERSION`
    pub version: u32,
    /// Vertices, those of patches included.
    pub vertex_count: u64,
    /// Triangles, those of patches included.
    pub triangle_count: u64,
    /// Vertices that the mesh was made with: they come first.
    pub input_vertex_count: u64,
    /// Triangles that the mesh was made with: they come first.
    pub input_triangle_count: u64,
    /// Fills that can be undone.
    pub undo_count: u64,
    /// 1 for a polyline, 0 for a mesh.
    pub is_polyline: u32,
    /// 0.
    pub reserved: u32,
}

/// The version of `HolefillDefects`.
pub const HOLEFILL_DEFECTS_VERSION: u32 = 1;
/// What was irregular in a mesh when it was made. Nothing of it was repaired or removed.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillDefects {
    /// `sizeof(HolefillDefects)`
    pub struct_size: u32,
    /// `HOLEFILL_DEFECTS_VERSION`
    pub version: u32,
    /// Edges with more than two triangles.
    pub nonmanifold_edges: u64,
    /// Edges whose two triangles run along them in the same direction.
    pub inconsistent_edges: u64,
    /// Triangles that name a vertex twice.
    pub degenerate_triangles: u64,
    /// Triangles with the same three vertices as an earlier one.
    pub duplicate_triangles: u64,
    /// Vertices without a triangle.
    pub isolated_vertices: u64,
}

/// The version of `HolefillAttributeInfo`.
pub const HOLEFILL_ATTRIBUTE_INFO_VERSION: u32 = 1;
/// What an attribute is.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillAttributeInfo {
    /// `sizeof(HolefillAttributeInfo)`
    pub struct_size: u32,
    /// `HOLEFILL_ATTRIBUTE_INFO_VERSION`
    pub version: u32,
    /// The type of its numbers.
    pub scalar_type: HolefillType,
    /// Numbers per vertex or triangle.
    pub components: u32,
    /// Rows: the number of vertices or triangles.
    pub count: u64,
}

/// The kind of a loop: one of the `HOLEFILL_CLASS_` constants.
pub type HolefillClass = u32;
/// The rim of a hole that touches no other loop; also a polyline.
pub const HOLEFILL_CLASS_SIMPLE: HolefillClass = 1;
/// The rim of a hole that shares a vertex with another loop.
pub const HOLEFILL_CLASS_TOUCHING: HolefillClass = 2;
/// The rim of a small loose sheet that lies inside the hole of another loop; judged from the shape, may be wrong.
pub const HOLEFILL_CLASS_ISLAND: HolefillClass = 3;
/// The outer rim of an open sheet; judged from the shape, may be wrong.
pub const HOLEFILL_CLASS_OUTER_RIM: HolefillClass = 4;
/// The triangles along the loop are not oriented alike; it cannot be filled.
pub const HOLEFILL_CLASS_NOT_ORIENTED: HolefillClass = 5;
/// The boundary runs into an edge with more than two triangles and does not close; it cannot be filled.
pub const HOLEFILL_CLASS_OPEN_CHAIN: HolefillClass = 6;

/// The version of `HolefillLoopInfo`.
pub const HOLEFILL_LOOP_INFO_VERSION: u32 = 1;
/// What a loop is.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillLoopInfo {
    /// `sizeof(HolefillLoopInfo)`
    pub struct_size: u32,
    /// `HOLEFILL_LOOP_INFO_VERSION`
    pub version: u32,
    /// The loop's id.
    pub loop_id: u64,
    /// Number of boundary edges.
    pub edge_count: u64,
    /// Number of vertices: as many, or one more for an open chain.
    pub vertex_count: u64,
    /// One directed boundary edge as it runs in its triangle: vertex 0 and vertex 1.
    pub edge: [u64; 2],
    /// Length, in units of the positions.
    pub perimeter: f64,
    /// The area that the loop encloses as seen from each axis; points to the side from which it runs
    /// counter-clockwise. The loop runs as its triangles do: a patch runs the other way.
    pub vector_area: [f64; 3],
    /// Diagonal of the bounding box.
    pub diameter: f64,
    /// Root mean square distance to the plane of least squares, over that to the centroid: 0 when planar, at most
    /// about 0.58.
    pub planarity: f64,
    /// Its kind.
    pub loop_class: HolefillClass,
    /// 1 while the loop is open, 0 once a fill has closed it.
    pub is_open: u32,
}

/// The version of `HolefillSelection`.
pub const HOLEFILL_SELECTION_VERSION: u32 = 1;
/// Rules that choose the loops to fill; all zero chooses every open loop.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillSelection {
    /// `sizeof(HolefillSelection)`
    pub struct_size: u32,
    /// `HOLEFILL_SELECTION_VERSION`
    pub version: u32,
    /// If not empty, only the loops through these directed boundary edges are chosen. Rows of two vertices.
    pub only: HolefillInput,
    /// The loops through these directed boundary edges are not chosen. Rows of two vertices.
    pub keep: HolefillInput,
    /// Loops with more edges are not chosen; 0 is no limit.
    pub max_edges: u64,
    /// Longer loops are not chosen; 0 is no limit.
    pub max_perimeter: f64,
    /// So many loops of the largest perimeter are not chosen.
    pub keep_largest: u64,
}

/// How a target names loops: one of the `HOLEFILL_TARGET_` constants.
pub type HolefillTargetKind = u32;
/// All open loops that the rules of `selection` choose. With `selection` null: all open loops.
pub const HOLEFILL_TARGET_SELECTED: HolefillTargetKind = 0;
/// The loop `loop_id`.
pub const HOLEFILL_TARGET_LOOP: HolefillTargetKind = 1;
/// The loop through the boundary edge `edge`.
pub const HOLEFILL_TARGET_EDGE: HolefillTargetKind = 2;
/// The loops that the closed chain of the vertices `ids` consists of, the last joined to the first. It may start anywhere
/// and run either way. Where it visits a vertex twice it passes through more than one loop: loops are cut where the
/// boundary touches itself.
pub const HOLEFILL_TARGET_VERTICES: HolefillTargetKind = 3;
/// The loops `ids`.
pub const HOLEFILL_TARGET_LOOPS: HolefillTargetKind = 4;

/// The version of `HolefillTarget`.
pub const HOLEFILL_TARGET_VERSION: u32 = 1;
/// Which loops to fill or to plan. All zero but the first two fields is every open loop, and so is a null pointer in the
/// place of the struct. Only the fields that `kind` names are read.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillTarget {
    /// `sizeof(HolefillTarget)`
    pub struct_size: u32,
    /// `HOLEFILL_TARGET_VERSION`
    pub version: u32,
    /// How the loops are named.
    pub kind: HolefillTargetKind,
    /// Must be 0.
    pub reserved: u32,
    /// The id of a loop.
    pub loop_id: u64,
    /// A directed boundary edge as it runs in its triangle: from vertex 0 to vertex 1.
    pub edge: [u64; 2],
    /// Rows of one loop id, or of one vertex.
    pub ids: *const HolefillInput,
    /// Rules.
    pub selection: *const HolefillSelection,
}

/// The version of `HolefillProgress`.
pub const HOLEFILL_PROGRESS_VERSION: u32 = 1;
/// How far a fill or plan has come.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillProgress {
    /// `sizeof(HolefillProgress)` of the library: read only fields within it.
    pub struct_size: u32,
    /// The `HOLEFILL_PROGRESS_VERSION` of the library.
    pub version: u32,
    /// Holes that are finished, whatever became of them.
    pub holes_done: u64,
    /// Holes to fill or plan.
    pub holes_total: u64,
    /// Seconds since the call began.
    pub seconds: f64,
}

/// Told how far the work has come: after each hole, and within a hole about every 10 ms while the algorithms can be
/// stopped. A value other than 0 stops the call with `HOLEFILL_STATUS_CANCELLED`.
///
/// It is called during the call that it was given to and never after it, one call at a time, from the thread that made
/// the call or any thread of the library. It may call the library; on the mesh
/// that is being filled every call returns `HOLEFILL_STATUS_BUSY`, on one that is being planned those that change it. It
/// must return: an exception or `longjmp` must not leave it. (holefill.hpp catches what a C++ function throws, stops
/// the call, and throws it again after the call has returned.)
pub type HolefillProgressCallback =
    Option<unsafe extern "C" fn(progress: *const HolefillProgress, user_data: *mut c_void) -> i32>;

/// How important a message is: one of the `HOLEFILL_LOG_` constants.
pub type HolefillLogLevel = u32;
/// A hole that was asked for stays open.
pub const HOLEFILL_LOG_WARNING: HolefillLogLevel = 1;
/// A hole was filled: by which method, with what.
pub const HOLEFILL_LOG_INFO: HolefillLogLevel = 2;
/// A method was tried and not used, and why.
pub const HOLEFILL_LOG_DEBUG: HolefillLogLevel = 3;

/// Told what happened, in one line without a line break. The text is the library's and lasts until the function
/// returns. It is called on the thread that made the call, before the call returns. The rules of
/// `HolefillProgressCallback` hold otherwise.
pub type HolefillLogCallback = Option<
    unsafe extern "C" fn(level: HolefillLogLevel, message: *const c_char, user_data: *mut c_void),
>;

/// The version of `HolefillFillOptions`.
pub const HOLEFILL_FILL_OPTIONS_VERSION: u32 = 1;
/// How to fill. All zero but the first two fields is the default, and so is a null pointer in the place of the struct.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillFillOptions {
    /// `sizeof(HolefillFillOptions)`
    pub struct_size: u32,
    /// `HOLEFILL_FILL_OPTIONS_VERSION`
    pub version: u32,
    /// The name of a method, see `holefill_method_name`; null is `auto`.
    pub method: *const c_char,
    /// Values of the parameters that have names; 0 for the defaults. They are read during the call.
    pub parameters: HolefillParameters,
    /// Seed of the methods that use random numbers.
    pub seed: u64,
    /// Seconds that the call may take; holes that are not finished then stay open, those that are finished are filled,
    /// and the status is `HOLEFILL_STATUS_INCOMPLETE`. 0 is as the parameter `fill.time-budget` says.
    pub time_budget: f64,
    /// Target edge length of new triangles over that of the rim; 0 is as the parameter `refine.density` says.
    pub density: f64,
    /// Most new vertices in one hole; 0 is as the parameter `refine.max-vertices` says.
    pub max_new_vertices: u64,
    /// Threads that fill holes at the same time, at most 1024; 0 takes as many as there are processors, 1 the calling
    /// thread. The result is the same for any number.
    pub threads: u32,
    /// The highest level that is logged; 0 is all.
    pub log_level: HolefillLogLevel,
    /// Told how far the work has come; may be null.
    pub progress: HolefillProgressCallback,
    /// Handed to `progress`.
    pub progress_data: *mut c_void,
    /// Told what happened; may be null: the library is silent then.
    pub log: HolefillLogCallback,
    /// Handed to `log`.
    pub log_data: *mut c_void,
}

/// The version of `HolefillPointOptions`.
pub const HOLEFILL_POINT_OPTIONS_VERSION: u32 = 1;
/// How a mesh is made from points. All zero but the first two fields is the default, and so is a null pointer in the
/// place of the struct.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillPointOptions {
    /// `sizeof(HolefillPointOptions)`
    pub struct_size: u32,
    /// `HOLEFILL_POINT_OPTIONS_VERSION`
    pub version: u32,
    /// The largest radius of the circle through the corners of a triangle, in units of the positions: a hole that such a
    /// circle passes through stays open. 0 takes three times the median of the neighborhood.
    pub radius: f64,
    /// How many of the nearest points each point chooses its triangles from, 6 to 200; 0 is 24.
    pub neighbours: u32,
    /// Threads that work, at most 1024; 0 is as many as there are processors. The result is the same for any number.
    pub threads: u32,
    /// Seconds that the call may take; 0 is no limit. When they run out the status is `HOLEFILL_STATUS_LIMIT`.
    pub time_budget: f64,
    /// Asked about every 10 ms whether to go on, with 0 of 0 holes; may be null.
    pub progress: HolefillProgressCallback,
    /// Handed to `progress`.
    pub progress_data: *mut c_void,
}

/// The version of `HolefillPointSummary`.
pub const HOLEFILL_POINT_SUMMARY_VERSION: u32 = 1;
/// What became of points that a mesh was made from.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillPointSummary {
    /// `sizeof(HolefillPointSummary)`
    pub struct_size: u32,
    /// `HOLEFILL_POINT_SUMMARY_VERSION`
    pub version: u32,
    /// Points that a triangle uses.
    pub used: u64,
    /// Points at the place of an earlier one; no triangle uses them.
    pub duplicates: u64,
    /// Other points that no triangle uses.
    pub unused: u64,
    /// Triangles.
    pub triangle_count: u64,
    /// Pieces of surface that share no vertex.
    pub piece_count: u64,
    /// Normals that were not given, and were estimated.
    pub estimated_normals: u64,
    /// The largest radius of a triangle's circle that was allowed, in units of the positions: the smallest, the median and
    /// the largest over the points.
    pub radius: [f64; 3],
}

/// The version of `HolefillPatchInfo`.
pub const HOLEFILL_PATCH_INFO_VERSION: u32 = 1;
/// The size of a planned patch.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillPatchInfo {
    /// `sizeof(HolefillPatchInfo)`
    pub struct_size: u32,
    /// `HOLEFILL_PATCH_INFO_VERSION`
    pub version: u32,
    /// The index of its first new vertex in its triangles. Vertices of the mesh have lower indices, and so do the
    /// new ones of the patches before it in the plan.
    pub first_vertex: u64,
    /// New vertices.
    pub vertex_count: u64,
    /// Triangles.
    pub triangle_count: u64,
}

/// What became of a hole: one of the `HOLEFILL_HOLE_` constants.
pub type HolefillHoleStatus = u32;
/// The hole is closed; in the report of a plan: there is a patch for it.
pub const HOLEFILL_HOLE_FILLED: HolefillHoleStatus = 1;
/// The hole was not asked to be filled.
pub const HOLEFILL_HOLE_KEPT: HolefillHoleStatus = 2;
/// The hole stays open and is as it was: see the reason.
pub const HOLEFILL_HOLE_FAILED: HolefillHoleStatus = 3;
/// The caller stopped before the hole was filled; it is as it was.
pub const HOLEFILL_HOLE_CANCELLED: HolefillHoleStatus = 4;

/// Why a hole stays open: one of the `HOLEFILL_CAUSE_` constants.
pub type HolefillCause = u32;
/// It does not stay open, or was not asked for.
pub const HOLEFILL_CAUSE_NONE: HolefillCause = 0;
/// What was given does not allow it.
pub const HOLEFILL_CAUSE_INPUT: HolefillCause = 1;
/// The connectivity does not allow it.
pub const HOLEFILL_CAUSE_TOPOLOGY: HolefillCause = 2;
/// The positions do not allow it.
pub const HOLEFILL_CAUSE_GEOMETRY: HolefillCause = 3;
/// A linear system has no usable solution.
pub const HOLEFILL_CAUSE_SOLVER: HolefillCause = 4;
/// A limit of size or time was exceeded.
pub const HOLEFILL_CAUSE_LIMIT: HolefillCause = 5;
/// The caller stopped.
pub const HOLEFILL_CAUSE_CANCELLED: HolefillCause = 6;

/// The version of `HolefillHole`.
pub const HOLEFILL_HOLE_VERSION: u32 = 1;
/// What happened to one hole.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillHole {
    /// `sizeof(HolefillHole)`
    pub struct_size: u32,
    /// `HOLEFILL_HOLE_VERSION`
    pub version: u32,
    /// The loop's id.
    pub loop_id: u64,
    /// Number of boundary edges of the loop.
    pub edge_count: u64,
    /// One directed boundary edge of the loop as it ran in its triangle.
    pub edge: [u64; 2],
    /// Length of the loop.
    pub perimeter: f64,
    /// Kind of the loop.
    pub loop_class: HolefillClass,
    /// What became of it.
    pub status: HolefillHoleStatus,
    /// Why it stays open.
    pub cause: HolefillCause,
    /// Methods that were tried and not used: see `holefill_report_tried`.
    pub tried_count: u32,
    /// The method whose patch closes the hole; null where there is none. Static text, never freed.
    pub method: *const c_char,
    /// The first of its new vertices.
    pub first_vertex: u64,
    /// The number of its new vertices.
    pub vertex_count: u64,
    /// The first of its new triangles.
    pub first_triangle: u64,
    /// The number of its new triangles.
    pub triangle_count: u64,
    /// Pairs of triangles that intersect, one of them new.
    pub self_intersections: u64,
    /// Smallest angle of the new triangles in radians; 0 where there are none.
    pub min_angle: f64,
    /// Seconds spent on the hole.
    pub seconds: f64,
}

/// The version of `HolefillPrediction`.
pub const HOLEFILL_PREDICTION_VERSION: u32 = 1;
/// How the missing surface of a hole was predicted.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillPrediction {
    /// `sizeof(HolefillPrediction)`
    pub struct_size: u32,
    /// `HOLEFILL_PREDICTION_VERSION`
    pub version: u32,
    /// The name of the surface that was used, if there are no creases: `plane`, `sphere`, `cylinder`, `cone`, `torus`,
    /// `quadric`, `cyclide`, `rbf3`, `rbf3-smoothed`, `rbf3-ridge`, `rbf5`; later versions may have more. Static text,
    /// never freed.
    pub chosen: *const c_char,
    /// Standard deviation of the vertices round the hole from smooth surfaces, in units of the mean rim edge.
    pub noise: f64,
    /// Candidates that were compared: `holefill_report_json` lists them. 0 when none were, as by `curvature` or with
    /// `auto.candidate`.
    pub score_count: u64,
    /// Creases in the patch.
    pub crease_count: u64,
    /// Surfaces between the creases: `holefill_report_json` lists them.
    pub crease_surface_count: u64,
    /// 1 when the hole was taken for the missing tip of a horn, higher than half a sphere.
    pub is_tip: u32,
    /// 1 when the hole was taken for a gap in a flat face: then the patch lies in the plane of the rim, whatever the
    /// scores say.
    pub is_flat: u32,
}

/// The version of `HolefillSummary`.
pub const HOLEFILL_SUMMARY_VERSION: u32 = 1;
/// What happened to all holes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct HolefillSummary {
    /// `sizeof(HolefillSummary)`
    pub struct_size: u32,
    /// `HOLEFILL_SUMMARY_VERSION`
    pub version: u32,
    /// Entries of the report.
    pub hole_count: u64,
    /// Entries with `HOLEFILL_HOLE_FILLED`.
    pub filled: u64,
    /// Entries with `HOLEFILL_HOLE_KEPT`.
    pub kept: u64,
    /// Entries with `HOLEFILL_HOLE_FAILED`.
    pub failed: u64,
    /// Entries with `HOLEFILL_HOLE_CANCELLED`.
    pub cancelled: u64,
    /// New vertices.
    pub new_vertices: u64,
    /// New triangles.
    pub new_triangles: u64,
    /// Seconds spent to index the mesh; 0 when it was indexed already.
    pub index_seconds: f64,
    /// Seconds spent to fill.
    pub fill_seconds: f64,
}
