/* The C interface of holefill: fills holes in triangle meshes, loop by loop, without touching the rest of the mesh.
 *
 * Generated from src/ffi by `HOLEFILL_UPDATE=1 cargo test --test header`: do not edit.
 *
 * Handles. Meshes, plans, reports, sets of parameters and errors are known by handles: numbers in structs of one field,
 * which are passed by value and never point to anything. A handle that was freed, is of another kind or was never
 * given out is answered by HOLEFILL_STATUS_INVALID_HANDLE. Freeing a handle that another thread uses is safe: that
 * call goes on, and the object is freed when it is done. The handle 0 is none; freeing it does nothing.
 *
 * Statuses. A function that can fail returns a HolefillStatus. It writes its outputs only with HOLEFILL_STATUS_OK and
 * HOLEFILL_STATUS_INCOMPLETE, and changes nothing otherwise. (Two exceptions, each said where it occurs: the length that
 * a text or list needs, and the error object.) Every function may return NULL_POINTER, INVALID_HANDLE, PANIC, and with
 * a mesh BUSY and POISONED; the comments name the others.
 *
 * Errors. The last argument of most functions is `error`. It may be null. Otherwise it points to a HolefillError that the
 * caller set to 0 before the first call; a call that fails leaves its status and message there. One variable does for
 * any number of calls in one thread, and is freed once. Nothing is kept per thread.
 *
 * Memory. What is given as a pointer is read or written during the call only. A pointer that is not null must point to as
 * much memory as the other arguments say; it need not be aligned. Null is answered by HOLEFILL_STATUS_NULL_POINTER
 * where it is not allowed. Texts are UTF-8 and end with a zero byte. No memory changes hands; static texts are never freed.
 *
 * Structs that begin with `struct_size` and `version` may grow at their end. Set them up by their ..._INIT, or set all to
 * zero but these two. A program and a library of different versions go together. What a shorter struct of the program
 * does not have counts as zero, and is not written. What a longer struct has more must be zero where the library reads,
 * and becomes zero where it writes. All else is HOLEFILL_STATUS_INVALID_STRUCT.
 *
 * Indices and ids in rows are int32_t, uint32_t, int64_t or uint64_t; none is negative.
 *
 * Threads. Every function may be called from any thread. On one mesh any number of calls that do not change it may run at
 * the same time, planning included; a call that changes it (fill, apply, undo, add_attribute) excludes all others. Nobody
 * waits: the call that comes second returns HOLEFILL_STATUS_BUSY. Different meshes are independent. Results
 * do not depend on threads.
 *
 * Nothing is written to the standard streams, but for the message of Rust's panic hook before HOLEFILL_STATUS_PANIC.
 */

#ifndef HOLEFILL_H
#define HOLEFILL_H

#include <stdint.h>
#ifndef HOLEFILL_API
#if defined(_WIN32) && !defined(HOLEFILL_STATIC)
#define HOLEFILL_API __declspec(dllimport)
#else
#define HOLEFILL_API
#endif
#endif

/* Initial values for structs of the caller: the defaults, or nothing. */
#define HOLEFILL_INPUT_INIT {0, 0, 0, 0, 0}
#define HOLEFILL_OUTPUT_INIT {0, 0, 0, 0, 0}
#define HOLEFILL_MESH_INFO_INIT \
    {(uint32_t)sizeof(HolefillMeshInfo), HOLEFILL_MESH_INFO_VERSION, 0, 0, 0, 0, 0, 0, 0}
#define HOLEFILL_DEFECTS_INIT \
    {(uint32_t)sizeof(HolefillDefects), HOLEFILL_DEFECTS_VERSION, 0, 0, 0, 0, 0}
#define HOLEFILL_ATTRIBUTE_INFO_INIT \
    {(uint32_t)sizeof(HolefillAttributeInfo), HOLEFILL_ATTRIBUTE_INFO_VERSION, 0, 0, 0}
#define HOLEFILL_LOOP_INFO_INIT \
    {(uint32_t)sizeof(HolefillLoopInfo), HOLEFILL_LOOP_INFO_VERSION, \
     0, 0, 0, {0, 0}, 0, {0, 0, 0}, 0, 0, 0, 0}
#define HOLEFILL_SELECTION_INIT \
    {(uint32_t)sizeof(HolefillSelection), HOLEFILL_SELECTION_VERSION, \
     HOLEFILL_INPUT_INIT, HOLEFILL_INPUT_INIT, 0, 0, 0}
#define HOLEFILL_TARGET_INIT \
    {(uint32_t)sizeof(HolefillTarget), HOLEFILL_TARGET_VERSION, 0, 0, 0, {0, 0}, 0, 0}
#define HOLEFILL_FILL_OPTIONS_INIT \
    {(uint32_t)sizeof(HolefillFillOptions), HOLEFILL_FILL_OPTIONS_VERSION, \
     0, {0}, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}
#define HOLEFILL_POINT_OPTIONS_INIT \
    {(uint32_t)sizeof(HolefillPointOptions), HOLEFILL_POINT_OPTIONS_VERSION, 0, 0, 0, 0, 0, 0}
#define HOLEFILL_POINT_SUMMARY_INIT \
    {(uint32_t)sizeof(HolefillPointSummary), HOLEFILL_POINT_SUMMARY_VERSION, \
     0, 0, 0, 0, 0, 0, {0, 0, 0}}
#define HOLEFILL_PATCH_INFO_INIT \
    {(uint32_t)sizeof(HolefillPatchInfo), HOLEFILL_PATCH_INFO_VERSION, 0, 0, 0}
#define HOLEFILL_HOLE_INIT \
    {(uint32_t)sizeof(HolefillHole), HOLEFILL_HOLE_VERSION, \
     0, 0, {0, 0}, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}
#define HOLEFILL_PREDICTION_INIT \
    {(uint32_t)sizeof(HolefillPrediction), HOLEFILL_PREDICTION_VERSION, 0, 0, 0, 0, 0, 0, 0}
#define HOLEFILL_SUMMARY_INIT \
    {(uint32_t)sizeof(HolefillSummary), HOLEFILL_SUMMARY_VERSION, 0, 0, 0, 0, 0, 0, 0, 0, 0}

/**
 * The version of the interface that this header declares. It changes when a function or a struct is changed so that
 * callers must be compiled anew; functions, statuses and fields at the end of structs come without a change.
 */
#define HOLEFILL_ABI_VERSION 0

/**
 * The version of `HolefillMeshInfo`.
 */
#define HOLEFILL_MESH_INFO_VERSION 1

/**
 * The version of `HolefillDefects`.
 */
#define HOLEFILL_DEFECTS_VERSION 1

/**
 * The version of `HolefillAttributeInfo`.
 */
#define HOLEFILL_ATTRIBUTE_INFO_VERSION 1

/**
 * The version of `HolefillLoopInfo`.
 */
#define HOLEFILL_LOOP_INFO_VERSION 1

/**
 * The version of `HolefillSelection`.
 */
#define HOLEFILL_SELECTION_VERSION 1

/**
 * The version of `HolefillTarget`.
 */
#define HOLEFILL_TARGET_VERSION 1

/**
 * The version of `HolefillProgress`.
 */
#define HOLEFILL_PROGRESS_VERSION 1

/**
 * The version of `HolefillFillOptions`.
 */
#define HOLEFILL_FILL_OPTIONS_VERSION 1

/**
 * The version of `HolefillPointOptions`.
 */
#define HOLEFILL_POINT_OPTIONS_VERSION 1

/**
 * The version of `HolefillPointSummary`.
 */
#define HOLEFILL_POINT_SUMMARY_VERSION 1

/**
 * The version of `HolefillPatchInfo`.
 */
#define HOLEFILL_PATCH_INFO_VERSION 1

/**
 * The version of `HolefillHole`.
 */
#define HOLEFILL_HOLE_VERSION 1

/**
 * The version of `HolefillPrediction`.
 */
#define HOLEFILL_PREDICTION_VERSION 1

/**
 * The version of `HolefillSummary`.
 */
#define HOLEFILL_SUMMARY_VERSION 1

/**
 * How a call ended: one of the `HOLEFILL_STATUS_` constants. A number once given is never used for anything
 * else; later versions may return new ones.
 */
typedef int32_t HolefillStatus;

/**
 * The status and message of the last call that failed with this handle as its `error` argument. Start with 0. A
 * failing call makes the object and writes its handle, or changes the object that the handle already names; a
 * call that does not fail leaves both alone. Free with `holefill_error_free`.
 */
typedef struct HolefillError {
    /**
     * The handle; 0 is none.
     */
    uint64_t id;
} HolefillError;

/**
 * The type of numbers: one of the `HOLEFILL_TYPE_` constants.
 */
typedef uint32_t HolefillType;

/**
 * Rows of numbers that the library reads during the call, and never after it. How many numbers make a row, and which
 * types are allowed, is said where one is taken.
 */
typedef struct HolefillInput {
    /**
     * The first number of the first row; need not be aligned; may be null when `count` is 0.
     */
    const void *data;
    /**
     * Number of rows.
     */
    uint64_t count;
    /**
     * Bytes from a row to the next; 0 when they follow each other without a gap. Rows must not overlap.
     */
    uint64_t stride;
    /**
     * The type of the numbers.
     */
    HolefillType scalar_type;
    /**
     * Must be 0.
     */
    uint32_t reserved;
} HolefillInput;

/**
 * A mesh with its boundary loops, or a polyline. The handle 0 is none. Free with `holefill_mesh_free`.
 */
typedef struct HolefillMesh {
    /**
     * The handle; 0 is none.
     */
    uint64_t id;
} HolefillMesh;

/**
 * The size of a mesh.
 */
typedef struct HolefillMeshInfo {
    /**
     * `sizeof(HolefillMeshInfo)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_MESH_INFO_VERSION`
     */
    uint32_t version;
    /**
     * Vertices, those of patches included.
     */
    uint64_t vertex_count;
    /**
     * Triangles, those of patches included.
     */
    uint64_t triangle_count;
    /**
     * Vertices that the mesh was made with: they come first.
     */
    uint64_t input_vertex_count;
    /**
     * Triangles that the mesh was made with: they come first.
     */
    uint64_t input_triangle_count;
    /**
     * Fills that can be undone.
     */
    uint64_t undo_count;
    /**
     * 1 for a polyline, 0 for a mesh.
     */
    uint32_t is_polyline;
    /**
     * 0.
     */
    uint32_t reserved;
} HolefillMeshInfo;

/**
 * What was irregular in a mesh when it was made. Nothing of it was repaired or removed.
 */
typedef struct HolefillDefects {
    /**
     * `sizeof(HolefillDefects)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_DEFECTS_VERSION`
     */
    uint32_t version;
    /**
     * Edges with more than two triangles.
     */
    uint64_t nonmanifold_edges;
    /**
     * Edges whose two triangles run along them in the same direction.
     */
    uint64_t inconsistent_edges;
    /**
     * Triangles that name a vertex twice.
     */
    uint64_t degenerate_triangles;
    /**
     * Triangles with the same three vertices as an earlier one.
     */
    uint64_t duplicate_triangles;
    /**
     * Vertices without a triangle.
     */
    uint64_t isolated_vertices;
} HolefillDefects;

/**
 * Memory of the caller that the library writes rows of numbers to during the call, and never after it. Bytes between
 * the rows are left alone.
 */
typedef struct HolefillOutput {
    /**
     * Where the first number of the first row goes; need not be aligned; may be null when `count` is 0.
     */
    void *data;
    /**
     * Number of rows to write.
     */
    uint64_t count;
    /**
     * Bytes from a row to the next; 0 when they follow each other without a gap. Rows must not overlap.
     */
    uint64_t stride;
    /**
     * The type of the numbers.
     */
    HolefillType scalar_type;
    /**
     * Must be 0.
     */
    uint32_t reserved;
} HolefillOutput;

/**
 * How far a fill or plan has come.
 */
typedef struct HolefillProgress {
    /**
     * `sizeof(HolefillProgress)` of the library: read only fields within it.
     */
    uint32_t struct_size;
    /**
     * The `HOLEFILL_PROGRESS_VERSION` of the library.
     */
    uint32_t version;
    /**
     * Holes that are finished, whatever became of them.
     */
    uint64_t holes_done;
    /**
     * Holes to fill or plan.
     */
    uint64_t holes_total;
    /**
     * Seconds since the call began.
     */
    double seconds;
} HolefillProgress;

/**
 * Told how far the work has come: after each hole, and within a hole about every 10 ms while the algorithms can be
 * stopped. A value other than 0 stops the call with `HOLEFILL_STATUS_CANCELLED`.
 *
 * It is called during the call that it was given to and never after it, one call at a time, from the thread that made
 * the call or any thread of the library. It may call the library; on the mesh
 * that is being filled every call returns `HOLEFILL_STATUS_BUSY`, on one that is being planned those that change it. It
 * must return: an exception or `longjmp` must not leave it. (holefill.hpp catches what a C++ function throws, stops
 * the call, and throws it again after the call has returned.)
 */
typedef int32_t (*HolefillProgressCallback)(const struct HolefillProgress *progress, void *user_data);

/**
 * How a mesh is made from points. All zero but the first two fields is the default, and so is a null pointer in the
 * place of the struct.
 */
typedef struct HolefillPointOptions {
    /**
     * `sizeof(HolefillPointOptions)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_POINT_OPTIONS_VERSION`
     */
    uint32_t version;
    /**
     * The largest radius of the circle through the corners of a triangle, in units of the positions: a hole that such a
     * circle passes through stays open. 0 takes three times the median of the neighborhood.
     */
    double radius;
    /**
     * How many of the nearest points each point chooses its triangles from, 6 to 200; 0 is 24.
     */
    uint32_t neighbours;
    /**
     * Threads that work, at most 1024; 0 is as many as there are processors. The result is the same for any number.
     */
    uint32_t threads;
    /**
     * Seconds that the call may take; 0 is no limit. When they run out the status is `HOLEFILL_STATUS_LIMIT`.
     */
    double time_budget;
    /**
     * Asked about every 10 ms whether to go on, with 0 of 0 holes; may be null.
     */
    HolefillProgressCallback progress;
    /**
     * Handed to `progress`.
     */
    void *progress_data;
} HolefillPointOptions;

/**
 * What became of points that a mesh was made from.
 */
typedef struct HolefillPointSummary {
    /**
     * `sizeof(HolefillPointSummary)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_POINT_SUMMARY_VERSION`
     */
    uint32_t version;
    /**
     * Points that a triangle uses.
     */
    uint64_t used;
    /**
     * Points at the place of an earlier one; no triangle uses them.
     */
    uint64_t duplicates;
    /**
     * Other points that no triangle uses.
     */
    uint64_t unused;
    /**
     * Triangles.
     */
    uint64_t triangle_count;
    /**
     * Pieces of surface that share no vertex.
     */
    uint64_t piece_count;
    /**
     * Normals that were not given, and were estimated.
     */
    uint64_t estimated_normals;
    /**
     * The largest radius of a triangle's circle that was allowed, in units of the positions: the smallest, the median and
     * the largest over the points.
     */
    double radius[3];
} HolefillPointSummary;

/**
 * What an attribute belongs to: one of the `HOLEFILL_ELEMENT_` constants.
 */
typedef uint32_t HolefillElement;

/**
 * What an attribute is.
 */
typedef struct HolefillAttributeInfo {
    /**
     * `sizeof(HolefillAttributeInfo)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_ATTRIBUTE_INFO_VERSION`
     */
    uint32_t version;
    /**
     * The type of its numbers.
     */
    HolefillType scalar_type;
    /**
     * Numbers per vertex or triangle.
     */
    uint32_t components;
    /**
     * Rows: the number of vertices or triangles.
     */
    uint64_t count;
} HolefillAttributeInfo;

/**
 * The kind of a loop: one of the `HOLEFILL_CLASS_` constants.
 */
typedef uint32_t HolefillClass;

/**
 * What a loop is.
 */
typedef struct HolefillLoopInfo {
    /**
     * `sizeof(HolefillLoopInfo)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_LOOP_INFO_VERSION`
     */
    uint32_t version;
    /**
     * The loop's id.
     */
    uint64_t loop_id;
    /**
     * Number of boundary edges.
     */
    uint64_t edge_count;
    /**
     * Number of vertices: as many, or one more for an open chain.
     */
    uint64_t vertex_count;
    /**
     * One directed boundary edge as it runs in its triangle: vertex 0 and vertex 1.
     */
    uint64_t edge[2];
    /**
     * Length, in units of the positions.
     */
    double perimeter;
    /**
     * The area that the loop encloses as seen from each axis; points to the side from which it runs
     * counter-clockwise. The loop runs as its triangles do: a patch runs the other way.
     */
    double vector_area[3];
    /**
     * Diagonal of the bounding box.
     */
    double diameter;
    /**
     * Root mean square distance to the plane of least squares, over that to the centroid: 0 when planar, at most
     * about 0.58.
     */
    double planarity;
    /**
     * Its kind.
     */
    HolefillClass loop_class;
    /**
     * 1 while the loop is open, 0 once a fill has closed it.
     */
    uint32_t is_open;
} HolefillLoopInfo;

/**
 * How a target names loops: one of the `HOLEFILL_TARGET_` constants.
 */
typedef uint32_t HolefillTargetKind;

/**
 * Rules that choose the loops to fill; all zero chooses every open loop.
 */
typedef struct HolefillSelection {
    /**
     * `sizeof(HolefillSelection)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_SELECTION_VERSION`
     */
    uint32_t version;
    /**
     * If not empty, only the loops through these directed boundary edges are chosen. Rows of two vertices.
     */
    struct HolefillInput only;
    /**
     * The loops through these directed boundary edges are not chosen. Rows of two vertices.
     */
    struct HolefillInput keep;
    /**
     * Loops with more edges are not chosen; 0 is no limit.
     */
    uint64_t max_edges;
    /**
     * Longer loops are not chosen; 0 is no limit.
     */
    double max_perimeter;
    /**
     * So many loops of the largest perimeter are not chosen.
     */
    uint64_t keep_largest;
} HolefillSelection;

/**
 * Which loops to fill or to plan. All zero but the first two fields is every open loop, and so is a null pointer in the
 * place of the struct. Only the fields that `kind` names are read.
 */
typedef struct HolefillTarget {
    /**
     * `sizeof(HolefillTarget)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_TARGET_VERSION`
     */
    uint32_t version;
    /**
     * How the loops are named.
     */
    HolefillTargetKind kind;
    /**
     * Must be 0.
     */
    uint32_t reserved;
    /**
     * The id of a loop.
     */
    uint64_t loop_id;
    /**
     * A directed boundary edge as it runs in its triangle: from vertex 0 to vertex 1.
     */
    uint64_t edge[2];
    /**
     * Rows of one loop id, or of one vertex.
     */
    const struct HolefillInput *ids;
    /**
     * Rules.
     */
    const struct HolefillSelection *selection;
} HolefillTarget;

/**
 * Values of the parameters that have names. Free with `holefill_parameters_free`.
 */
typedef struct HolefillParameters {
    /**
     * The handle; 0 is none, and stands for the defaults.
     */
    uint64_t id;
} HolefillParameters;

/**
 * How important a message is: one of the `HOLEFILL_LOG_` constants.
 */
typedef uint32_t HolefillLogLevel;

/**
 * Told what happened, in one line without a line break. The text is the library's and lasts until the function
 * returns. It is called on the thread that made the call, before the call returns. The rules of
 * `HolefillProgressCallback` hold otherwise.
 */
typedef void (*HolefillLogCallback)(HolefillLogLevel level, const char *message, void *user_data);

/**
 * How to fill. All zero but the first two fields is the default, and so is a null pointer in the place of the struct.
 */
typedef struct HolefillFillOptions {
    /**
     * `sizeof(HolefillFillOptions)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_FILL_OPTIONS_VERSION`
     */
    uint32_t version;
    /**
     * The name of a method, see `holefill_method_name`; null is `auto`.
     */
    const char *method;
    /**
     * Values of the parameters that have names; 0 for the defaults. They are read during the call.
     */
    struct HolefillParameters parameters;
    /**
     * Seed of the methods that use random numbers.
     */
    uint64_t seed;
    /**
     * Seconds that the call may take; holes that are not finished then stay open, those that are finished are filled,
     * and the status is `HOLEFILL_STATUS_INCOMPLETE`. 0 is as the parameter `fill.time-budget` says.
     */
    double time_budget;
    /**
     * Target edge length of new triangles over that of the rim; 0 is as the parameter `refine.density` says.
     */
    double density;
    /**
     * Most new vertices in one hole; 0 is as the parameter `refine.max-vertices` says.
     */
    uint64_t max_new_vertices;
    /**
     * Threads that fill holes at the same time, at most 1024; 0 takes as many as there are processors, 1 the calling
     * thread. The result is the same for any number.
     */
    uint32_t threads;
    /**
     * The highest level that is logged; 0 is all.
     */
    HolefillLogLevel log_level;
    /**
     * Told how far the work has come; may be null.
     */
    HolefillProgressCallback progress;
    /**
     * Handed to `progress`.
     */
    void *progress_data;
    /**
     * Told what happened; may be null: the library is silent then.
     */
    HolefillLogCallback log;
    /**
     * Handed to `log`.
     */
    void *log_data;
} HolefillFillOptions;

/**
 * What happened to each hole. Free with `holefill_report_free`.
 */
typedef struct HolefillReport {
    /**
     * The handle; 0 is none.
     */
    uint64_t id;
} HolefillReport;

/**
 * Patches that were planned and are not part of their mesh. Free with `holefill_plan_free`.
 */
typedef struct HolefillPlan {
    /**
     * The handle; 0 is none.
     */
    uint64_t id;
} HolefillPlan;

/**
 * The size of a planned patch.
 */
typedef struct HolefillPatchInfo {
    /**
     * `sizeof(HolefillPatchInfo)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_PATCH_INFO_VERSION`
     */
    uint32_t version;
    /**
     * The index of its first new vertex in its triangles. Vertices of the mesh have lower indices, and so do the
     * new ones of the patches before it in the plan.
     */
    uint64_t first_vertex;
    /**
     * New vertices.
     */
    uint64_t vertex_count;
    /**
     * Triangles.
     */
    uint64_t triangle_count;
} HolefillPatchInfo;

/**
 * What happened to all holes.
 */
typedef struct HolefillSummary {
    /**
     * `sizeof(HolefillSummary)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_SUMMARY_VERSION`
     */
    uint32_t version;
    /**
     * Entries of the report.
     */
    uint64_t hole_count;
    /**
     * Entries with `HOLEFILL_HOLE_FILLED`.
     */
    uint64_t filled;
    /**
     * Entries with `HOLEFILL_HOLE_KEPT`.
     */
    uint64_t kept;
    /**
     * Entries with `HOLEFILL_HOLE_FAILED`.
     */
    uint64_t failed;
    /**
     * Entries with `HOLEFILL_HOLE_CANCELLED`.
     */
    uint64_t cancelled;
    /**
     * New vertices.
     */
    uint64_t new_vertices;
    /**
     * New triangles.
     */
    uint64_t new_triangles;
    /**
     * Seconds spent to index the mesh; 0 when it was indexed already.
     */
    double index_seconds;
    /**
     * Seconds spent to fill.
     */
    double fill_seconds;
} HolefillSummary;

/**
 * What became of a hole: one of the `HOLEFILL_HOLE_` constants.
 */
typedef uint32_t HolefillHoleStatus;

/**
 * Why a hole stays open: one of the `HOLEFILL_CAUSE_` constants.
 */
typedef uint32_t HolefillCause;

/**
 * What happened to one hole.
 */
typedef struct HolefillHole {
    /**
     * `sizeof(HolefillHole)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_HOLE_VERSION`
     */
    uint32_t version;
    /**
     * The loop's id.
     */
    uint64_t loop_id;
    /**
     * Number of boundary edges of the loop.
     */
    uint64_t edge_count;
    /**
     * One directed boundary edge of the loop as it ran in its triangle.
     */
    uint64_t edge[2];
    /**
     * Length of the loop.
     */
    double perimeter;
    /**
     * Kind of the loop.
     */
    HolefillClass loop_class;
    /**
     * What became of it.
     */
    HolefillHoleStatus status;
    /**
     * Why it stays open.
     */
    HolefillCause cause;
    /**
     * Methods that were tried and not used: see `holefill_report_tried`.
     */
    uint32_t tried_count;
    /**
     * The method whose patch closes the hole; null where there is none. Static text, never freed.
     */
    const char *method;
    /**
     * The first of its new vertices.
     */
    uint64_t first_vertex;
    /**
     * The number of its new vertices.
     */
    uint64_t vertex_count;
    /**
     * The first of its new triangles.
     */
    uint64_t first_triangle;
    /**
     * The number of its new triangles.
     */
    uint64_t triangle_count;
    /**
     * Pairs of triangles that intersect, one of them new.
     */
    uint64_t self_intersections;
    /**
     * Smallest angle of the new triangles in radians; 0 where there are none.
     */
    double min_angle;
    /**
     * Seconds spent on the hole.
     */
    double seconds;
} HolefillHole;

/**
 * How the missing surface of a hole was predicted.
 */
typedef struct HolefillPrediction {
    /**
     * `sizeof(HolefillPrediction)`
     */
    uint32_t struct_size;
    /**
     * `HOLEFILL_PREDICTION_VERSION`
     */
    uint32_t version;
    /**
     * The name of the surface that was used, if there are no creases: `plane`, `sphere`, `cylinder`, `cone`, `torus`,
     * `quadric`, `cyclide`, `rbf3`, `rbf3-smoothed`, `rbf3-ridge`, `rbf5`; later versions may have more. Static text,
     * never freed.
     */
    const char *chosen;
    /**
     * Standard deviation of the vertices round the hole from smooth surfaces, in units of the mean rim edge.
     */
    double noise;
    /**
     * Candidates that were compared: `holefill_report_json` lists them. 0 when none were, as by `curvature` or with
     * `auto.candidate`.
     */
    uint64_t score_count;
    /**
     * Creases in the patch.
     */
    uint64_t crease_count;
    /**
     * Surfaces between the creases: `holefill_report_json` lists them.
     */
    uint64_t crease_surface_count;
    /**
     * 1 when the hole was taken for the missing tip of a horn, higher than half a sphere.
     */
    uint32_t is_tip;
    /**
     * 1 when the hole was taken for a gap in a flat face: then the patch lies in the plane of the rim, whatever the
     * scores say.
     */
    uint32_t is_flat;
} HolefillPrediction;

/**
 * The call did what it says; outputs are written.
 */
#define HOLEFILL_STATUS_OK 0

/**
 * A fill or plan did its work and its outputs are written, but some of the holes that were asked for stay open:
 * the report says which and why.
 */
#define HOLEFILL_STATUS_INCOMPLETE 1

/**
 * A pointer that must not be null is null.
 */
#define HOLEFILL_STATUS_NULL_POINTER 2

/**
 * A handle that was freed, never given out, of another kind, or of another process or copy of the library.
 */
#define HOLEFILL_STATUS_INVALID_HANDLE 3

/**
 * A value that the function does not take; nothing was changed.
 */
#define HOLEFILL_STATUS_INVALID_ARGUMENT 4

/**
 * A struct whose `struct_size` or `version` this library does not know, or that has something other than zero in
 * fields that this library does not know.
 */
#define HOLEFILL_STATUS_INVALID_STRUCT 5

/**
 * The text or the list does not fit; the length that is needed was written, nothing else.
 */
#define HOLEFILL_STATUS_BUFFER_TOO_SMALL 6

/**
 * Another thread, or the call from whose callback this one comes, uses the mesh in a way that excludes this call.
 * Nothing was changed: try again later.
 */
#define HOLEFILL_STATUS_BUSY 7

/**
 * The progress callback asked to stop. Nothing was changed.
 */
#define HOLEFILL_STATUS_CANCELLED 8

/**
 * There is no loop, edge, attribute, parameter or entry of this number or name.
 */
#define HOLEFILL_STATUS_NOT_FOUND 9

/**
 * A coordinate is infinite or not a number.
 */
#define HOLEFILL_STATUS_NOT_FINITE 10

/**
 * An index names a vertex that does not exist.
 */
#define HOLEFILL_STATUS_INDEX_OUT_OF_RANGE 11

/**
 * A count times a stride is more than the address space.
 */
#define HOLEFILL_STATUS_OVERFLOW 12

/**
 * The loop is of a kind that cannot be filled.
 */
#define HOLEFILL_STATUS_TOPOLOGY 13

/**
 * A documented limit was exceeded, such as the number of handles or of threads.
 */
#define HOLEFILL_STATUS_LIMIT 14

/**
 * There is not enough memory for a copy of the input.
 */
#define HOLEFILL_STATUS_OUT_OF_MEMORY 15

/**
 * The plan does not fit the mesh any more, or is of another mesh: plan again.
 */
#define HOLEFILL_STATUS_STALE_PLAN 16

/**
 * There is no fill to undo.
 */
#define HOLEFILL_STATUS_NOTHING_TO_UNDO 17

/**
 * An earlier call on this mesh ended in `HOLEFILL_STATUS_PANIC`: it can only be freed.
 */
#define HOLEFILL_STATUS_POISONED 18

/**
 * A defect of the library showed itself, and was contained. The mesh that was being used is poisoned.
 */
#define HOLEFILL_STATUS_PANIC 19

/**
 * `int8_t`
 */
#define HOLEFILL_TYPE_I8 1

/**
 * `uint8_t`
 */
#define HOLEFILL_TYPE_U8 2

/**
 * `int16_t`
 */
#define HOLEFILL_TYPE_I16 3

/**
 * `uint16_t`
 */
#define HOLEFILL_TYPE_U16 4

/**
 * `int32_t`
 */
#define HOLEFILL_TYPE_I32 5

/**
 * `uint32_t`
 */
#define HOLEFILL_TYPE_U32 6

/**
 * `int64_t`; for indices and ids only
 */
#define HOLEFILL_TYPE_I64 7

/**
 * `uint64_t`; for indices and ids only
 */
#define HOLEFILL_TYPE_U64 8

/**
 * `float`
 */
#define HOLEFILL_TYPE_F32 9

/**
 * `double`
 */
#define HOLEFILL_TYPE_F64 10

/**
 * Vertices.
 */
#define HOLEFILL_ELEMENT_VERTEX 1

/**
 * Triangles.
 */
#define HOLEFILL_ELEMENT_TRIANGLE 2

/**
 * The rim of a hole that touches no other loop; also a polyline.
 */
#define HOLEFILL_CLASS_SIMPLE 1

/**
 * The rim of a hole that shares a vertex with another loop.
 */
#define HOLEFILL_CLASS_TOUCHING 2

/**
 * The rim of a small loose sheet that lies inside the hole of another loop; judged from the shape, may be wrong.
 */
#define HOLEFILL_CLASS_ISLAND 3

/**
 * The outer rim of an open sheet; judged from the shape, may be wrong.
 */
#define HOLEFILL_CLASS_OUTER_RIM 4

/**
 * The triangles along the loop are not oriented alike; it cannot be filled.
 */
#define HOLEFILL_CLASS_NOT_ORIENTED 5

/**
 * The boundary runs into an edge with more than two triangles and does not close; it cannot be filled.
 */
#define HOLEFILL_CLASS_OPEN_CHAIN 6

/**
 * All open loops that the rules of `selection` choose. With `selection` null: all open loops.
 */
#define HOLEFILL_TARGET_SELECTED 0

/**
 * The loop `loop_id`.
 */
#define HOLEFILL_TARGET_LOOP 1

/**
 * The loop through the boundary edge `edge`.
 */
#define HOLEFILL_TARGET_EDGE 2

/**
 * The loops that the closed chain of the vertices `ids` consists of, the last joined to the first. It may start anywhere
 * and run either way. Where it visits a vertex twice it passes through more than one loop: loops are cut where the
 * boundary touches itself.
 */
#define HOLEFILL_TARGET_VERTICES 3

/**
 * The loops `ids`.
 */
#define HOLEFILL_TARGET_LOOPS 4

/**
 * A hole that was asked for stays open.
 */
#define HOLEFILL_LOG_WARNING 1

/**
 * A hole was filled: by which method, with what.
 */
#define HOLEFILL_LOG_INFO 2

/**
 * A method was tried and not used, and why.
 */
#define HOLEFILL_LOG_DEBUG 3

/**
 * The hole is closed; in the report of a plan: there is a patch for it.
 */
#define HOLEFILL_HOLE_FILLED 1

/**
 * The hole was not asked to be filled.
 */
#define HOLEFILL_HOLE_KEPT 2

/**
 * The hole stays open and is as it was: see the reason.
 */
#define HOLEFILL_HOLE_FAILED 3

/**
 * The caller stopped before the hole was filled; it is as it was.
 */
#define HOLEFILL_HOLE_CANCELLED 4

/**
 * It does not stay open, or was not asked for.
 */
#define HOLEFILL_CAUSE_NONE 0

/**
 * What was given does not allow it.
 */
#define HOLEFILL_CAUSE_INPUT 1

/**
 * The connectivity does not allow it.
 */
#define HOLEFILL_CAUSE_TOPOLOGY 2

/**
 * The positions do not allow it.
 */
#define HOLEFILL_CAUSE_GEOMETRY 3

/**
 * A linear system has no usable solution.
 */
#define HOLEFILL_CAUSE_SOLVER 4

/**
 * A limit of size or time was exceeded.
 */
#define HOLEFILL_CAUSE_LIMIT 5

/**
 * The caller stopped.
 */
#define HOLEFILL_CAUSE_CANCELLED 6

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The `HOLEFILL_ABI_VERSION` of the library: compare it with that of the header.
 */
HOLEFILL_API uint32_t holefill_abi_version(void);

/**
 * The version of the library as text, such as `0.1.0`. Static, never freed.
 */
HOLEFILL_API const char *holefill_version(void);

/**
 * Number of handles in the process that were not freed: for tests of callers.
 */
HOLEFILL_API uint64_t holefill_handle_count(void);

/**
 * The name of a status without its prefix, such as `INVALID_HANDLE`; `UNKNOWN` for a number that is none. The text
 * is static: it is never freed.
 */
HOLEFILL_API
const char *holefill_status_name(HolefillStatus status);

/**
 * What a status means, in a few words. The text is static: it is never freed.
 */
HOLEFILL_API const char *holefill_status_message(HolefillStatus status);

/**
 * The status of the last call that failed with this error object.
 */
HOLEFILL_API
HolefillStatus holefill_error_status(struct HolefillError error,
                                     HolefillStatus *status);

/**
 * The message of the last call that failed with this error object: one line, UTF-8, ended by a zero byte.
 *
 * `length` gets its length without the zero byte, also when the text does not fit. With `buffer` null and `capacity` 0
 * only the length is written.
 *
 * Statuses: `BUFFER_TOO_SMALL`.
 */
HOLEFILL_API
HolefillStatus holefill_error_message(struct HolefillError error,
                                      char *buffer,
                                      uint64_t capacity,
                                      uint64_t *length);

/**
 * Frees an error object. The handle 0 is allowed.
 */
HOLEFILL_API HolefillStatus holefill_error_free(struct HolefillError error);

/**
 * Makes a mesh from copies of arrays.
 *
 * `positions`: rows of three, `float` or `double`. `triangles`: rows of three vertex indices from 0, of 32
 * or 64 bits. Vertices and triangles keep their order, their indices and, in double precision, their bits. Non-manifold
 * edges, isolated vertices, duplicate and degenerate triangles and mixed orientation are kept: see
 * `holefill_mesh_defects`. `mesh` gets the handle.
 *
 * Time and memory are linear in the size of the mesh.
 *
 * Statuses: `NULL_POINTER`, `INVALID_ARGUMENT` (type, stride, a negative index, more than about 10^9 triangles), `OVERFLOW`, `NOT_FINITE`,
 * `INDEX_OUT_OF_RANGE`, `OUT_OF_MEMORY`, `LIMIT`.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_from_arrays(const struct HolefillInput *positions,
                                         const struct HolefillInput *triangles,
                                         struct HolefillMesh *mesh,
                                         struct HolefillError *error);

/**
 * Makes a mesh of a closed polyline: its points as vertices, no triangles, and one loop with the id 0. Every function
 * takes it as it takes other meshes; a fill appends the patch.
 *
 * `points`: rows of three, `float` or `double`, at least three; the last is joined to the first. The patch runs along
 * the polyline in its direction, counter-clockwise as seen from the side to which its normals point.
 *
 * `normals` may be null. Otherwise it has a row of three for each point, of any length: the normals of the surface that
 * the patch is to go on from. A strip of surface perpendicular to them is supposed outside the polyline, and every
 * method meets it as it would meet a mesh. Without normals, or where one is zero or along the polyline, nothing is
 * known outside: `flat` and `membrane` do what they always do, and the fair methods give the patch of least energy
 * through the polyline, with no tangent plane prescribed.
 *
 * Statuses: as `holefill_mesh_from_arrays`.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_from_polyline(const struct HolefillInput *points,
                                           const struct HolefillInput *normals,
                                           struct HolefillMesh *mesh,
                                           struct HolefillError *error);

/**
 * Frees a mesh. The handle 0 is allowed. Calls of other threads that use the mesh right now go on undisturbed, and
 * its memory is freed when they are done. Plans and reports made with it stay.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_free(struct HolefillMesh mesh);

/**
 * The size of a mesh.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_info(struct HolefillMesh mesh,
                                  struct HolefillMeshInfo *info,
                                  struct HolefillError *error);

/**
 * What was irregular in a mesh when it was made.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_defects(struct HolefillMesh mesh,
                                     struct HolefillDefects *defects,
                                     struct HolefillError *error);

/**
 * Finds the loops and indexes the mesh for the intersection tests, in time linear in the size of the mesh. Otherwise the
 * first function that needs them does it. After it the time of a fill follows the holes that it fills and not the mesh.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_prepare(struct HolefillMesh mesh,
                                     struct HolefillError *error);

/**
 * Copies the positions of the vertices from `first` on: `output` has rows of three, `float` or `double`, as many as are
 * wanted.
 *
 * Statuses: `NOT_FOUND` when the mesh has fewer vertices.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_read_positions(struct HolefillMesh mesh,
                                            uint64_t first,
                                            const struct HolefillOutput *output,
                                            struct HolefillError *error);

/**
 * Copies the vertex indices of the triangles from `first` on: `output` has rows of three, of 32 or 64 bits, as many as
 * are wanted.
 *
 * Statuses: `NOT_FOUND` when the mesh has fewer triangles; `LIMIT` for an index that the type has no room for.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_read_triangles(struct HolefillMesh mesh,
                                            uint64_t first,
                                            const struct HolefillOutput *output,
                                            struct HolefillError *error);

/**
 * Makes a mesh from copies of unorganized points, such as those of a scanner: oriented, without edges of more than two
 * triangles, and open where there are no samples. Its holes are filled like those of any mesh.
 *
 * `points`: rows of three, `float` or `double`. They are the vertices, all of them, in their order and, in double
 * precision, with their bits; those that no triangle uses stay as isolated vertices.
 *
 * `normals` may be null. Otherwise it has a row of three for each point, of any length, pointing outward: triangles face
 * where they point. A normal that is zero is not known and is estimated, as all are without `normals`; each piece of
 * surface then faces away from its middle. Normals are not kept: `holefill_mesh_add_attribute` does that.
 *
 * `colors` may be null. Otherwise it has a row of three numbers for each point, of any type of an attribute, which become
 * the vertex attribute `color`: as if added by `holefill_mesh_add_attribute`.
 *
 * `options` may be null. `mesh` gets the handle. `summary` may be null; otherwise it gets what became of the points.
 *
 * Time is O(n log n), memory about 1 kB for each point.
 *
 * Statuses: as `holefill_mesh_from_arrays`, but for `INDEX_OUT_OF_RANGE`; `INVALID_ARGUMENT` also for fewer than four
 * different points, points on one line, points of which no three make a triangle, another number of normals or colors, and
 * options out of range; `LIMIT` also when the time ran out; `CANCELLED`.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_from_points(const struct HolefillInput *points,
                                         const struct HolefillInput *normals,
                                         const struct HolefillInput *colors,
                                         const struct HolefillPointOptions *options,
                                         struct HolefillMesh *mesh,
                                         struct HolefillPointSummary *summary,
                                         struct HolefillError *error);

/**
 * Adds an attribute to the vertices or the triangles of a mesh, and copies its values.
 *
 * `name` is UTF-8 and unique among those of the element. `values` has a row of `components` numbers for each vertex or
 * triangle, those of patches included, of any type of at most 32 bits or `double`.
 *
 * A fill gives values to new vertices and triangles: floating-point numbers, and whatever is called `color`, are
 * extended smoothly from the rim; three floating-point numbers called `normal` become the normals of the patch; all
 * else is copied from the nearest vertex of the rim, or triangle beside it. Plans that were made before cannot be
 * applied any more.
 *
 * Statuses: `INVALID_ARGUMENT` for an unknown element, a name that exists or is empty, no component or more than 1024, or
 * another number of rows; `BUSY`.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_add_attribute(struct HolefillMesh mesh,
                                           HolefillElement element,
                                           const char *name,
                                           uint32_t components,
                                           const struct HolefillInput *values,
                                           struct HolefillError *error);

/**
 * Number of attributes of the vertices or the triangles.
 *
 * Statuses: `INVALID_ARGUMENT` for an unknown element.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_attribute_count(struct HolefillMesh mesh,
                                             HolefillElement element,
                                             uint64_t *count,
                                             struct HolefillError *error);

/**
 * Type and size of attribute `index`, in the order in which they were added.
 *
 * Statuses: `NOT_FOUND`; `INVALID_ARGUMENT` for an unknown element.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_attribute_info(struct HolefillMesh mesh,
                                            HolefillElement element,
                                            uint64_t index,
                                            struct HolefillAttributeInfo *info,
                                            struct HolefillError *error);

/**
 * The name of attribute `index`; `buffer`, `capacity` and `length` as in `holefill_error_message`.
 *
 * Statuses: `NOT_FOUND`; `INVALID_ARGUMENT` for an unknown element.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_attribute_name(struct HolefillMesh mesh,
                                            HolefillElement element,
                                            uint64_t index,
                                            char *buffer,
                                            uint64_t capacity,
                                            uint64_t *length,
                                            struct HolefillError *error);

/**
 * Copies values of attribute `index` from row `first` on: `output` has rows of as many numbers as the attribute has
 * components, of its type or `double`, as many as are wanted.
 *
 * Statuses: `NOT_FOUND`; `INVALID_ARGUMENT` for an unknown element or another type.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_read_attribute(struct HolefillMesh mesh,
                                            HolefillElement element,
                                            uint64_t index,
                                            uint64_t first,
                                            const struct HolefillOutput *output,
                                            struct HolefillError *error);

/**
 * Number of boundary loops that the mesh was made with. Their ids are the numbers below it. They keep them whatever is
 * filled or undone: a loop that a fill has closed stays in the list and says so in `is_open`.
 *
 * The first call of a function that needs the loops finds them, in time linear in the boundary.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_loop_count(struct HolefillMesh mesh,
                                        uint64_t *count,
                                        struct HolefillError *error);

/**
 * What a loop is.
 *
 * Statuses: `NOT_FOUND`.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_loop_info(struct HolefillMesh mesh,
                                       uint64_t loop_id,
                                       struct HolefillLoopInfo *info,
                                       struct HolefillError *error);

/**
 * Copies the vertices of a loop from position `first` on, in the direction in which its triangles run: `output` has rows
 * of one, of 32 or 64 bits, as many as are wanted.
 *
 * Statuses: `NOT_FOUND` for no such loop or more vertices than it has; `LIMIT` for an index that the type has no room
 * for.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_read_loop(struct HolefillMesh mesh,
                                       uint64_t loop_id,
                                       uint64_t first,
                                       const struct HolefillOutput *output,
                                       struct HolefillError *error);

/**
 * The loops that `target` names, as `holefill_mesh_fill` takes it; null is every open loop.
 *
 * `ids` gets the ids, ascending but for those that the target lists itself, and `count` their number, also when they do
 * not fit into `capacity`. With `ids` null and `capacity` 0 only the number is written.
 *
 * Statuses: `NOT_FOUND` for a loop, an edge or a chain that the mesh does not have; for an edge that runs the other way
 * the message says so. `INVALID_ARGUMENT` for an unknown kind of target or an edge of the rules that is on no loop;
 * `BUFFER_TOO_SMALL`.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_find_loops(struct HolefillMesh mesh,
                                        const struct HolefillTarget *target,
                                        uint64_t *ids,
                                        uint64_t capacity,
                                        uint64_t *count,
                                        struct HolefillError *error);

/**
 * Makes a set of parameters with their defaults.
 */
HOLEFILL_API
HolefillStatus holefill_parameters_new(struct HolefillParameters *parameters,
                                       struct HolefillError *error);

/**
 * Frees a set of parameters. The handle 0 is allowed. Calls that were given it have read it already.
 */
HOLEFILL_API
HolefillStatus holefill_parameters_free(struct HolefillParameters parameters);

/**
 * Sets a parameter by its name to a value in text, as `holefill_parameter_allowed` describes it.
 *
 * Statuses: `NOT_FOUND` for an unknown name (the message lists the known ones), `INVALID_ARGUMENT` for a value that is not
 * allowed (the message says which are).
 */
HOLEFILL_API
HolefillStatus holefill_parameters_set(struct HolefillParameters parameters,
                                       const char *name,
                                       const char *value,
                                       struct HolefillError *error);

/**
 * The value of a parameter in text; `buffer`, `capacity` and `length` as in `holefill_error_message`.
 *
 * Statuses: `NOT_FOUND`.
 */
HOLEFILL_API
HolefillStatus holefill_parameters_get(struct HolefillParameters parameters,
                                       const char *name,
                                       char *buffer,
                                       uint64_t capacity,
                                       uint64_t *length,
                                       struct HolefillError *error);

/**
 * Number of methods of this version of the library.
 */
HOLEFILL_API uint64_t holefill_method_count(void);

/**
 * The name of method `index`, as options take it; null when there is none. Static, never freed.
 */
HOLEFILL_API const char *holefill_method_name(uint64_t index);

/**
 * What method `index` does, in one line; null when there is none. Static, never freed.
 */
HOLEFILL_API const char *holefill_method_summary(uint64_t index);

/**
 * Number of parameters that can be set by name in this version of the library.
 */
HOLEFILL_API uint64_t holefill_parameter_count(void);

/**
 * The name of parameter `index`, such as `refine.density`; null when there is none. Static, never freed.
 */
HOLEFILL_API
const char *holefill_parameter_name(uint64_t index);

/**
 * What parameter `index` does, with its unit; null when there is none. Static, never freed.
 */
HOLEFILL_API const char *holefill_parameter_help(uint64_t index);

/**
 * The values that parameter `index` takes, in words; null when there is none. Static, never freed.
 */
HOLEFILL_API const char *holefill_parameter_allowed(uint64_t index);

/**
 * The default of parameter `index` in text; null when there is none. Static, never freed.
 */
HOLEFILL_API const char *holefill_parameter_default(uint64_t index);

/**
 * Fills holes. Everything that was in the mesh stays bit for bit and keeps its index. New vertices and triangles are
 * appended, oriented like those round the hole.
 *
 * `target` says which holes; null is every open loop. They are filled in parallel and appended in the order of the ids of
 * their loops. An island is filled together with the loop that it lies in, if both are asked for. A hole that stays open
 * does not keep the others from being filled.
 *
 * `options` may be null. `report` may be null; otherwise it gets what happened: an entry for each loop that was named, or,
 * for `HOLEFILL_TARGET_SELECTED`, for every loop of the mesh.
 *
 * Statuses: `INCOMPLETE` when a hole stays open that was asked for: the report says why; `NOT_FOUND` for a loop, an edge
 * or a chain that the mesh does not have; `INVALID_ARGUMENT` for a loop that was closed before, an option that is not
 * allowed, an unknown kind of target or an edge of the rules that is on no loop; `TOPOLOGY` for a loop that cannot be
 * filled; `CANCELLED`; `BUSY`. With any but `OK` and `INCOMPLETE` nothing was changed and no report written.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_fill(struct HolefillMesh mesh,
                                  const struct HolefillTarget *target,
                                  const struct HolefillFillOptions *options,
                                  struct HolefillReport *report,
                                  struct HolefillError *error);

/**
 * Fills every open loop with the default options: `holefill_mesh_fill` with null for everything else.
 *
 * Statuses: as `holefill_mesh_fill`.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_fill_all(struct HolefillMesh mesh,
                                      struct HolefillError *error);

/**
 * Takes the last fill or apply back that appended something: its vertices, triangles and attribute values are removed,
 * and its loops are open again. May be called again for the one before. Time follows what is removed.
 *
 * Statuses: `NOTHING_TO_UNDO`, `BUSY`.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_undo(struct HolefillMesh mesh,
                                  struct HolefillError *error);

/**
 * Makes patches and leaves the mesh as it is. The patches can be read, in the mesh's vertex indices, and applied. Nothing
 * of the mesh is copied, and other threads may read the mesh meanwhile.
 *
 * `target` and `options` as in `holefill_mesh_fill`. `plan` gets the handle.
 *
 * Each patch is checked against the mesh, but not against the other patches of the plan: that is done when the plan is
 * applied. To get patches that fit each other without keeping them in the mesh, fill, read what was appended, and undo.
 *
 * Statuses: as `holefill_mesh_fill`. With `INCOMPLETE` there is a plan that lacks patches, and its report says why.
 */
HOLEFILL_API
HolefillStatus holefill_mesh_plan(struct HolefillMesh mesh,
                                  const struct HolefillTarget *target,
                                  const struct HolefillFillOptions *options,
                                  struct HolefillPlan *plan,
                                  struct HolefillError *error);

/**
 * Appends the patches of a plan to its mesh, in the order of the loops. Patches are checked against each other and
 * against what was filled since; one that does not fit is made anew. The plan stays until it is freed.
 *
 * Of `options` only the callbacks count, and it may be null; everything else is as it was given when the plan was made.
 * `report` may be null.
 *
 * Statuses: `INCOMPLETE`, `STALE_PLAN` when it is of another mesh, an undo took back what it was made for, or attributes
 * were added since; `CANCELLED`; `BUSY`. With any but `OK` and `INCOMPLETE` nothing was changed and no report written.
 */
HOLEFILL_API
HolefillStatus holefill_plan_apply(struct HolefillPlan plan,
                                   struct HolefillMesh mesh,
                                   const struct HolefillFillOptions *options,
                                   struct HolefillReport *report,
                                   struct HolefillError *error);

/**
 * What each loop would get: a report in which `HOLEFILL_HOLE_FILLED` says that there is a patch, and ranges are those of
 * the plan's own numbering, in which the patches follow each other.
 */
HOLEFILL_API
HolefillStatus holefill_plan_report(struct HolefillPlan plan,
                                    struct HolefillReport *report,
                                    struct HolefillError *error);

/**
 * The size of the patch for a loop.
 *
 * Statuses: `NOT_FOUND` when the plan has no patch for it. An island that is filled together with the loop round it has
 * none of its own.
 */
HOLEFILL_API
HolefillStatus holefill_plan_patch(struct HolefillPlan plan,
                                   uint64_t loop_id,
                                   struct HolefillPatchInfo *info,
                                   struct HolefillError *error);

/**
 * Copies the positions of the new vertices of the patch for a loop, from its `first` on: `output` has rows of three,
 * `float` or `double`, as many as are wanted.
 *
 * Statuses: `NOT_FOUND`.
 */
HOLEFILL_API
HolefillStatus holefill_plan_read_positions(struct HolefillPlan plan,
                                            uint64_t loop_id,
                                            uint64_t first,
                                            const struct HolefillOutput *output,
                                            struct HolefillError *error);

/**
 * Copies the triangles of the patch for a loop, from its `first` on: `output` has rows of three, of 32 or 64 bits, as
 * many as are wanted. Indices below the number of vertices of the mesh are those of the mesh. The first new vertex has
 * the index `first_vertex` of `holefill_plan_patch`.
 *
 * Statuses: `NOT_FOUND`; `LIMIT` for an index that the type has no room for.
 */
HOLEFILL_API
HolefillStatus holefill_plan_read_triangles(struct HolefillPlan plan,
                                            uint64_t loop_id,
                                            uint64_t first,
                                            const struct HolefillOutput *output,
                                            struct HolefillError *error);

/**
 * Frees a plan. The handle 0 is allowed.
 */
HOLEFILL_API HolefillStatus holefill_plan_free(struct HolefillPlan plan);

/**
 * The whole report as JSON: one object, UTF-8. `buffer`, `capacity` and `length` as in `holefill_error_message`.
 *
 * `holes` is a list with an entry for each hole, in the form of `holefill fill --report`: with the methods that were tried,
 * the candidate surfaces that were compared, and their scores. `index_seconds` and `fill_seconds` are those of
 * `HolefillSummary`. Later versions may add keys.
 *
 * Statuses: `BUFFER_TOO_SMALL`.
 */
HOLEFILL_API
HolefillStatus holefill_report_json(struct HolefillReport report,
                                    char *buffer,
                                    uint64_t capacity,
                                    uint64_t *length,
                                    struct HolefillError *error);

/**
 * What happened to all holes.
 */
HOLEFILL_API
HolefillStatus holefill_report_summary(struct HolefillReport report,
                                       struct HolefillSummary *summary,
                                       struct HolefillError *error);

/**
 * What happened to one hole: entry `index` of the report, in the order of the loops' ids.
 *
 * Statuses: `NOT_FOUND`.
 */
HOLEFILL_API
HolefillStatus holefill_report_hole(struct HolefillReport report,
                                    uint64_t index,
                                    struct HolefillHole *hole,
                                    struct HolefillError *error);

/**
 * Why the hole of entry `index` stays open, or what remains to be said of it; empty when that is nothing. `buffer`,
 * `capacity` and `length` as in `holefill_error_message`.
 *
 * Statuses: `NOT_FOUND`.
 */
HOLEFILL_API
HolefillStatus holefill_report_reason(struct HolefillReport report,
                                      uint64_t index,
                                      char *buffer,
                                      uint64_t capacity,
                                      uint64_t *length,
                                      struct HolefillError *error);

/**
 * The `attempt`-th method that was tried for the hole of entry `index` and not used, and why. `method` gets its name as
 * static text that is never freed; `buffer`, `capacity` and `length` as in `holefill_error_message` for the reason.
 *
 * Statuses: `NOT_FOUND`.
 */
HOLEFILL_API
HolefillStatus holefill_report_tried(struct HolefillReport report,
                                     uint64_t index,
                                     uint32_t attempt,
                                     const char **method,
                                     char *buffer,
                                     uint64_t capacity,
                                     uint64_t *length,
                                     struct HolefillError *error);

/**
 * How the missing surface was predicted for the filled hole of entry `index`. The methods `auto` and `curvature` predict
 * one; whether it stands is said by the hole's `method`. An island has none: it belongs to the hole that it lies in.
 *
 * Statuses: `NOT_FOUND`, also when the entry has no prediction.
 */
HOLEFILL_API
HolefillStatus holefill_report_prediction(struct HolefillReport report,
                                          uint64_t index,
                                          struct HolefillPrediction *prediction,
                                          struct HolefillError *error);

/**
 * Frees a report. The handle 0 is allowed.
 */
HOLEFILL_API HolefillStatus holefill_report_free(struct HolefillReport report);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HOLEFILL_H */
