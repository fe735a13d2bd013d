/* Every function of the C interface once, as it is meant to be used. */
#include "check.h"
#include "sheet.h"

#include <holefill.h>

#include <string.h>

static void check_versions_and_names(void) {
    uint64_t i;
    CHECK(holefill_abi_version() == HOLEFILL_ABI_VERSION);
    CHECK(strchr(holefill_version(), '.') != NULL);
    CHECK(strcmp(holefill_status_name(HOLEFILL_STATUS_INVALID_HANDLE), "INVALID_HANDLE") == 0);
    CHECK(strcmp(holefill_status_name(-12345), "UNKNOWN") == 0);
    CHECK(strlen(holefill_status_message(HOLEFILL_STATUS_BUSY)) > 0);
    CHECK(holefill_method_count() >= 5);
    for (i = 0; i < holefill_method_count(); ++i) {
        CHECK(strlen(holefill_method_name(i)) > 0 && strlen(holefill_method_summary(i)) > 0);
    }
    CHECK(holefill_method_name(i) == NULL && holefill_method_summary(i) == NULL);
    CHECK(holefill_parameter_count() > 0);
    for (i = 0; i < holefill_parameter_count(); ++i) {
        CHECK(strchr(holefill_parameter_name(i), '.') != NULL);
        CHECK(strlen(holefill_parameter_help(i)) > 0 && strlen(holefill_parameter_allowed(i)) > 0);
        CHECK(strlen(holefill_parameter_default(i)) > 0);
    }
    CHECK(holefill_parameter_name(i) == NULL && holefill_parameter_help(i) == NULL);
    CHECK(holefill_parameter_allowed(i) == NULL && holefill_parameter_default(i) == NULL);
}

static void check_parameters(void) {
    HolefillParameters parameters = {0};
    HolefillError error = {0};
    HolefillStatus status = HOLEFILL_STATUS_OK;
    uint64_t length = 0, i;
    char text[256];
    CHECK_OK(holefill_parameters_new(&parameters, &error));
    for (i = 0; i < holefill_parameter_count(); ++i) {
        const char *name = holefill_parameter_name(i);
        CHECK_OK(holefill_parameters_get(parameters, name, text, sizeof text, &length, &error));
        CHECK(strcmp(text, holefill_parameter_default(i)) == 0 && length == strlen(text));
        CHECK_OK(holefill_parameters_set(parameters, name, text, &error));
    }
    CHECK_STATUS(holefill_parameters_set(parameters, "refine.densty", "1", &error), HOLEFILL_STATUS_NOT_FOUND);
    CHECK_OK(holefill_error_status(error, &status));
    CHECK(status == HOLEFILL_STATUS_NOT_FOUND);
    CHECK_OK(holefill_error_message(error, NULL, 0, &length));
    CHECK(length > 0);
    CHECK_STATUS(holefill_error_message(error, text, 2, &length), HOLEFILL_STATUS_BUFFER_TOO_SMALL);
    CHECK_OK(holefill_error_free(error));
    CHECK_OK(holefill_parameters_free(parameters));
}

static void *allocate(uint64_t count, size_t size) {
    void *memory = malloc((size_t)count * size);
    CHECK(memory != NULL);
    return memory;
}

static HolefillMesh make_mesh(const Sheet *sheet) {
    const HolefillInput positions = rows(sheet->positions, sheet->vertex_count, HOLEFILL_TYPE_F64);
    const HolefillInput triangles = rows(sheet->triangles, sheet->triangle_count, HOLEFILL_TYPE_U32);
    HolefillMesh mesh = {0};
    CHECK_OK(holefill_mesh_from_arrays(&positions, &triangles, &mesh, NULL));
    return mesh;
}

static void check_attributes(HolefillMesh mesh, const Sheet *sheet) {
    uint8_t *colors = (uint8_t *)allocate(3 * sheet->vertex_count, 1);
    HolefillAttributeInfo info = HOLEFILL_ATTRIBUTE_INFO_INIT;
    uint64_t count = 0, length = 0, i;
    char name[16];
    double back[3] = {0, 0, 0};
    for (i = 0; i < sheet->vertex_count; ++i) {
        colors[3 * i] = 200;
        colors[3 * i + 1] = (uint8_t)(i % 200);
        colors[3 * i + 2] = 7;
    }
    const HolefillInput values = rows(colors, sheet->vertex_count, HOLEFILL_TYPE_U8);
    CHECK_OK(holefill_mesh_add_attribute(mesh, HOLEFILL_ELEMENT_VERTEX, "color", 3, &values, NULL));
    CHECK_OK(holefill_mesh_attribute_count(mesh, HOLEFILL_ELEMENT_VERTEX, &count, NULL));
    CHECK(count == 1);
    CHECK_OK(holefill_mesh_attribute_info(mesh, HOLEFILL_ELEMENT_VERTEX, 0, &info, NULL));
    CHECK(info.components == 3 && info.scalar_type == HOLEFILL_TYPE_U8 && info.count == sheet->vertex_count);
    CHECK_OK(holefill_mesh_attribute_name(mesh, HOLEFILL_ELEMENT_VERTEX, 0, name, sizeof name, &length, NULL));
    CHECK(strcmp(name, "color") == 0 && length == 5);
    HolefillOutput output = room(back, 1, HOLEFILL_TYPE_F64);
    CHECK_OK(holefill_mesh_read_attribute(mesh, HOLEFILL_ELEMENT_VERTEX, 0, 5, &output, NULL));
    CHECK(back[0] == 200 && back[1] == 5 && back[2] == 7);
    free(colors);
}

/* A directed edge of the first hole. */
static HolefillTarget at_edge(const Sheet *sheet) {
    HolefillTarget made = target(HOLEFILL_TARGET_EDGE);
    made.edge[0] = sheet->hole_edge[0];
    made.edge[1] = sheet->hole_edge[1];
    return made;
}

/* The id of the first hole. */
static uint64_t first_hole(HolefillMesh mesh, const Sheet *sheet) {
    const HolefillTarget edge = at_edge(sheet);
    uint64_t id = 0, count = 0;
    CHECK_OK(holefill_mesh_find_loops(mesh, &edge, &id, 1, &count, NULL));
    CHECK(count == 1);
    return id;
}

static void check_loops(HolefillMesh mesh, const Sheet *sheet) {
    HolefillLoopInfo info = HOLEFILL_LOOP_INFO_INIT;
    HolefillSelection selection = HOLEFILL_SELECTION_INIT;
    HolefillTarget selected = target(HOLEFILL_TARGET_SELECTED);
    uint32_t vertices[4 * SHEET_HOLE];
    const HolefillOutput output = room(vertices, 4 * SHEET_HOLE, HOLEFILL_TYPE_U32);
    uint64_t count = 0, id = 0, ids[32];
    CHECK_OK(holefill_mesh_prepare(mesh, NULL));
    CHECK_OK(holefill_mesh_loop_count(mesh, &count, NULL));
    CHECK(count == sheet->hole_count + 1);
    id = first_hole(mesh, sheet);
    CHECK_OK(holefill_mesh_loop_info(mesh, id, &info, NULL));
    CHECK(info.edge_count == 4 * SHEET_HOLE && info.vertex_count == info.edge_count && info.is_open == 1);
    CHECK(info.perimeter >= 4 * SHEET_HOLE && info.loop_class == HOLEFILL_CLASS_SIMPLE);
    CHECK_OK(holefill_mesh_read_loop(mesh, id, 0, &output, NULL));
    selection.keep_largest = 1;
    selected.selection = &selection;
    CHECK_OK(holefill_mesh_find_loops(mesh, &selected, NULL, 0, &count, NULL));
    CHECK_OK(holefill_mesh_find_loops(mesh, &selected, ids, 32, &count, NULL));
    CHECK(count == sheet->hole_count);
}

static int32_t count_calls(const HolefillProgress *progress, void *data) {
    CHECK(progress->holes_done <= progress->holes_total);
    ++*(uint64_t *)data;
    return 0;
}

static void count_lines(HolefillLogLevel level, const char *message, void *data) {
    CHECK(level >= HOLEFILL_LOG_WARNING && strlen(message) > 0);
    ++*(uint64_t *)data;
}

/* What was predicted for entry `index`, if anything was. */
static void check_prediction(HolefillReport report, uint64_t index) {
    HolefillPrediction prediction = HOLEFILL_PREDICTION_INIT;
    const HolefillStatus status = holefill_report_prediction(report, index, &prediction, NULL);
    if (status == HOLEFILL_STATUS_NOT_FOUND) {
        return;
    }
    CHECK_OK(status);
    CHECK(prediction.chosen != NULL && prediction.noise >= 0.0);
    CHECK(prediction.is_tip + prediction.is_flat <= 1);
}

static void check_json(HolefillReport report) {
    uint64_t length = 0;
    char *text = NULL;
    CHECK_OK(holefill_report_json(report, NULL, 0, &length, NULL));
    text = (char *)allocate(length + 1, 1);
    CHECK_OK(holefill_report_json(report, text, length + 1, &length, NULL));
    CHECK(strlen(text) == length && text[0] == '{' && strstr(text, "\"holes\"") != NULL);
    free(text);
}

static void check_report(HolefillReport report, uint64_t expected) {
    HolefillSummary summary = HOLEFILL_SUMMARY_INIT;
    HolefillHole hole = HOLEFILL_HOLE_INIT;
    uint64_t i, length = 0, filled = 0;
    CHECK_OK(holefill_report_summary(report, &summary, NULL));
    CHECK(summary.filled == expected && summary.failed == 0 && summary.cancelled == 0);
    for (i = 0; i < summary.hole_count; ++i) {
        char reason[256];
        uint32_t k;
        CHECK_OK(holefill_report_hole(report, i, &hole, NULL));
        CHECK_OK(holefill_report_reason(report, i, reason, sizeof reason, &length, NULL));
        for (k = 0; k < hole.tried_count; ++k) {
            const char *method = NULL;
            CHECK_OK(holefill_report_tried(report, i, k, &method, reason, sizeof reason, &length, NULL));
            CHECK(method != NULL && length > 0);
        }
        check_prediction(report, i);
        if (hole.status == HOLEFILL_HOLE_FILLED) {
            ++filled;
            CHECK(hole.method != NULL && hole.triangle_count > 0 && hole.min_angle > 0.0);
            CHECK(hole.cause == HOLEFILL_CAUSE_NONE);
        }
    }
    CHECK(filled == expected);
    check_json(report);
    CHECK_OK(holefill_report_free(report));
}

static HolefillTarget at_loop(uint64_t id) {
    HolefillTarget made = target(HOLEFILL_TARGET_LOOP);
    made.loop_id = id;
    return made;
}

/* Finds the first hole, named in every way, fills and undoes it, and plans it. */
static void check_targets(HolefillMesh mesh, const Sheet *sheet) {
    HolefillTarget ways[4];
    HolefillReport report = {0};
    HolefillPlan plan = {0};
    int32_t vertices[4 * SHEET_HOLE];
    const uint64_t id = first_hole(mesh, sheet);
    int64_t signed_id = (int64_t)id;
    const HolefillOutput output = room(vertices, 4 * SHEET_HOLE, HOLEFILL_TYPE_I32);
    HolefillInput chain = rows(vertices, 4 * SHEET_HOLE, HOLEFILL_TYPE_I32);
    const HolefillInput ids = rows(&signed_id, 1, HOLEFILL_TYPE_I64);
    int i;
    CHECK_OK(holefill_mesh_read_loop(mesh, id, 0, &output, NULL));
    ways[0] = at_loop(id);
    ways[1] = at_edge(sheet);
    ways[2] = target(HOLEFILL_TARGET_VERTICES);
    ways[2].ids = &chain;
    ways[3] = target(HOLEFILL_TARGET_LOOPS);
    ways[3].ids = &ids;
    for (i = 0; i < 4; ++i) {
        uint64_t found = 0, count = 0;
        CHECK_OK(holefill_mesh_find_loops(mesh, &ways[i], &found, 1, &count, NULL));
        CHECK(count == 1 && found == id);
        CHECK_OK(holefill_mesh_fill(mesh, &ways[i], NULL, &report, NULL));
        check_report(report, 1);
        CHECK_STATUS(holefill_mesh_fill(mesh, &ways[i], NULL, NULL, NULL), HOLEFILL_STATUS_INVALID_ARGUMENT);
        CHECK_OK(holefill_mesh_undo(mesh, NULL));
        CHECK_STATUS(holefill_mesh_undo(mesh, NULL), HOLEFILL_STATUS_NOTHING_TO_UNDO);
        CHECK_OK(holefill_mesh_plan(mesh, &ways[i], NULL, &plan, NULL));
        CHECK_OK(holefill_plan_report(plan, &report, NULL));
        check_report(report, 1);
        CHECK_OK(holefill_plan_free(plan));
    }
    chain.count -= 1;
    CHECK_STATUS(holefill_mesh_fill(mesh, &ways[2], NULL, NULL, NULL), HOLEFILL_STATUS_NOT_FOUND);
    signed_id = -1;
    CHECK_STATUS(holefill_mesh_fill(mesh, &ways[3], NULL, NULL, NULL), HOLEFILL_STATUS_INVALID_ARGUMENT);
    CHECK_OK(holefill_mesh_fill_all(mesh, NULL));
    CHECK_OK(holefill_mesh_undo(mesh, NULL));
}

static void check_fills(HolefillMesh mesh, const Sheet *sheet) {
    HolefillFillOptions options = HOLEFILL_FILL_OPTIONS_INIT;
    HolefillSelection selection = HOLEFILL_SELECTION_INIT;
    HolefillTarget selected = target(HOLEFILL_TARGET_SELECTED);
    HolefillReport report = {0};
    HolefillMeshInfo size = HOLEFILL_MESH_INFO_INIT;
    uint64_t calls = 0, lines = 0, i;
    double *positions;
    selected.selection = &selection;
    selection.keep_largest = 1;
    options.method = "fair-c1";
    options.threads = 1;
    options.progress = count_calls;
    options.progress_data = &calls;
    options.log = count_lines;
    options.log_data = &lines;
    CHECK_OK(holefill_mesh_fill(mesh, &selected, &options, &report, NULL));
    check_report(report, sheet->hole_count);
    CHECK(calls >= sheet->hole_count && lines >= sheet->hole_count);

    /* What was there is there, bit for bit. */
    CHECK_OK(holefill_mesh_info(mesh, &size, NULL));
    CHECK(size.input_vertex_count == sheet->vertex_count && size.vertex_count > size.input_vertex_count);
    CHECK(size.undo_count == 1 && size.is_polyline == 0);
    positions = (double *)allocate(3 * size.vertex_count, sizeof(double));
    HolefillOutput output = room(positions, size.vertex_count, HOLEFILL_TYPE_F64);
    CHECK_OK(holefill_mesh_read_positions(mesh, 0, &output, NULL));
    CHECK(memcmp(positions, sheet->positions, (size_t)sheet->vertex_count * 3 * sizeof(double)) == 0);
    for (i = 0; i < 3 * size.vertex_count; ++i) {
        CHECK(positions[i] > -100.0 && positions[i] < 100.0);
    }
    free(positions);
}

static void check_plans(HolefillMesh mesh, const Sheet *sheet) {
    HolefillPlan plan = {0};
    HolefillReport report = {0};
    HolefillPatchInfo patch = HOLEFILL_PATCH_INFO_INIT;
    HolefillTarget one;
    uint32_t *triangles;
    double *positions;
    uint64_t id = 0, i;
    id = first_hole(mesh, sheet);
    one = at_loop(id);
    CHECK_OK(holefill_mesh_plan(mesh, &one, NULL, &plan, NULL));
    CHECK_OK(holefill_plan_patch(plan, id, &patch, NULL));
    CHECK(patch.first_vertex == sheet->vertex_count && patch.vertex_count > 0);
    positions = (double *)allocate(3 * patch.vertex_count, sizeof(double));
    triangles = (uint32_t *)allocate(3 * patch.triangle_count, sizeof(uint32_t));
    HolefillOutput output = room(positions, patch.vertex_count, HOLEFILL_TYPE_F64);
    CHECK_OK(holefill_plan_read_positions(plan, id, 0, &output, NULL));
    output = room(triangles, patch.triangle_count, HOLEFILL_TYPE_U32);
    CHECK_OK(holefill_plan_read_triangles(plan, id, 0, &output, NULL));
    for (i = 0; i < 3 * patch.triangle_count; ++i) {
        CHECK(triangles[i] < patch.first_vertex + patch.vertex_count);
    }
    free(positions);
    free(triangles);
    CHECK_OK(holefill_plan_report(plan, &report, NULL));
    check_report(report, 1);
    CHECK_OK(holefill_plan_apply(plan, mesh, NULL, &report, NULL));
    check_report(report, 1);
    CHECK_OK(holefill_plan_free(plan));
    CHECK_OK(holefill_mesh_undo(mesh, NULL));
}

static void check_polyline(void) {
    enum { COUNT = 24 };
    float points[COUNT][3], normals[COUNT][3];
    const HolefillInput input = rows(points, COUNT, HOLEFILL_TYPE_F32);
    const HolefillInput normal_input = rows(normals, COUNT, HOLEFILL_TYPE_F32);
    HolefillMesh mesh = {0};
    HolefillReport report = {0};
    HolefillDefects defects = HOLEFILL_DEFECTS_INIT;
    HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
    uint64_t triangle[3] = {9, 9, 9};
    int i;
    for (i = 0; i < COUNT; ++i) {
        const double t = 6.283185307179586 * i / COUNT;
        points[i][0] = (float)cos(t);
        points[i][1] = (float)sin(t);
        points[i][2] = 0.0f;
        /* The rim of a spherical cap: the patch bulges. */
        normals[i][0] = (float)(0.6 * cos(t));
        normals[i][1] = (float)(0.6 * sin(t));
        normals[i][2] = 0.8f;
    }
    CHECK_OK(holefill_mesh_from_polyline(&input, &normal_input, &mesh, NULL));
    CHECK_OK(holefill_mesh_fill(mesh, NULL, NULL, &report, NULL));
    check_report(report, 1);
    CHECK_OK(holefill_mesh_info(mesh, &info, NULL));
    CHECK(info.is_polyline == 1 && info.input_vertex_count == COUNT && info.vertex_count > COUNT);
    HolefillOutput output = room(triangle, 1, HOLEFILL_TYPE_U64);
    CHECK_OK(holefill_mesh_read_triangles(mesh, 0, &output, NULL));
    CHECK(triangle[0] < info.vertex_count && triangle[1] < info.vertex_count && triangle[2] < info.vertex_count);
    CHECK_OK(holefill_mesh_free(mesh));
    CHECK_OK(holefill_mesh_from_polyline(&input, NULL, &mesh, NULL));
    CHECK_OK(holefill_mesh_defects(mesh, &defects, NULL));
    CHECK(defects.nonmanifold_edges == 0);
    CHECK_OK(holefill_mesh_free(mesh));
}

static void check_points(const Sheet *sheet) {
    HolefillPointOptions options = HOLEFILL_POINT_OPTIONS_INIT;
    HolefillPointSummary summary = HOLEFILL_POINT_SUMMARY_INIT;
    HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
    HolefillMesh mesh = {0};
    const uint64_t n = sheet->vertex_count;
    const HolefillInput points = rows(sheet->positions, n, HOLEFILL_TYPE_F64);
    options.threads = 1;
    CHECK_OK(holefill_mesh_from_points(&points, NULL, &points, &options, &mesh, &summary, NULL));
    CHECK_OK(holefill_mesh_info(mesh, &info, NULL));
    CHECK(info.vertex_count == n && info.triangle_count == summary.triangle_count);
    CHECK(summary.used == n && summary.duplicates == 0 && summary.unused == 0 && summary.piece_count == 1);
    CHECK(summary.estimated_normals == n && summary.radius[0] > 0.0 && summary.radius[2] >= summary.radius[1]);
    CHECK_OK(holefill_mesh_free(mesh));
}

int main(void) {
    Sheet sheet = sheet_new();
    HolefillMesh mesh;
    check_versions_and_names();
    check_parameters();
    mesh = make_mesh(&sheet);
    check_attributes(mesh, &sheet);
    check_loops(mesh, &sheet);
    check_targets(mesh, &sheet);
    check_plans(mesh, &sheet);
    check_fills(mesh, &sheet);
    CHECK_OK(holefill_mesh_free(mesh));
    check_polyline();
    check_points(&sheet);
    sheet_free(&sheet);
    CHECK(holefill_handle_count() == 0);
    puts("every function: ok");
    return 0;
}
