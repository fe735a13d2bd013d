/* Fills all holes of a mesh and prints the result for each, in C.
 *
 *   fill_all [OUT.obj]
 *
 * The program makes the mesh: a paraboloid with some triangles missing. The outer rim stays open. */
#include <holefill.h>

#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 30 };

static uint32_t vertex_at(int i, int j) { return (uint32_t)(i * (SIDE + 1) + j); }

/* Whether the square (i, j) is missing: two holes, one of them not convex. */
static int is_missing(int i, int j) {
    const int is_block = i >= 4 && i < 10 && j >= 4 && j < 9;
    const int is_corner = i >= 16 && i < 24 && j >= 14 && j < 26 && (i < 20 || j < 18);
    return is_block || is_corner;
}

static int fail(HolefillError error, HolefillStatus status) {
    char message[512] = "";
    uint64_t length = 0;
    holefill_error_message(error, message, sizeof message, &length);
    fprintf(stderr, "%s: %s\n", holefill_status_name(status), message);
    holefill_error_free(error);
    return 1;
}

static int print_report(HolefillReport report) {
    HolefillError error = {0};
    HolefillSummary summary = HOLEFILL_SUMMARY_INIT;
    HolefillStatus status = holefill_report_summary(report, &summary, &error);
    uint64_t i;
    for (i = 0; status == HOLEFILL_STATUS_OK && i < summary.hole_count; ++i) {
        HolefillHole hole = HOLEFILL_HOLE_INIT;
        char reason[512] = "";
        uint64_t length = 0;
        status = holefill_report_hole(report, i, &hole, &error);
        if (status == HOLEFILL_STATUS_OK) {
            holefill_report_reason(report, i, reason, sizeof reason, &length, NULL);
            printf("loop %llu, %llu edges: %s, %llu new triangles %s\n", (unsigned long long)hole.loop_id,
                   (unsigned long long)hole.edge_count, hole.method ? hole.method : "open",
                   (unsigned long long)hole.triangle_count, reason);
        }
    }
    return status == HOLEFILL_STATUS_OK ? 0 : fail(error, status);
}

static int write_obj(HolefillMesh mesh, const char *path) {
    HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
    HolefillOutput output = HOLEFILL_OUTPUT_INIT;
    double *positions = NULL;
    uint32_t *triangles = NULL;
    FILE *file = NULL;
    uint64_t i;
    int is_written = 0;
    holefill_mesh_info(mesh, &info, NULL);
    positions = (double *)malloc((size_t)info.vertex_count * 3 * sizeof *positions);
    triangles = (uint32_t *)malloc((size_t)info.triangle_count * 3 * sizeof *triangles);
    file = fopen(path, "w");
    if (positions && triangles && file) {
        output.data = positions;
        output.count = info.vertex_count;
        output.scalar_type = HOLEFILL_TYPE_F64;
        is_written = holefill_mesh_read_positions(mesh, 0, &output, NULL) == HOLEFILL_STATUS_OK;
        output.data = triangles;
        output.count = info.triangle_count;
        output.scalar_type = HOLEFILL_TYPE_U32;
        is_written = is_written && holefill_mesh_read_triangles(mesh, 0, &output, NULL) == HOLEFILL_STATUS_OK;
        for (i = 0; i < info.vertex_count; ++i) {
            const double *p = positions + 3 * i;
            fprintf(file, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
        }
        for (i = 0; i < info.triangle_count; ++i) {
            const uint32_t *t = triangles + 3 * i;
            fprintf(file, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
        }
    }
    if (file && fclose(file) != 0) {
        is_written = 0;
    }
    free(positions);
    free(triangles);
    if (!is_written) {
        fprintf(stderr, "cannot write %s\n", path);
    }
    return is_written ? 0 : 1;
}

int main(int argc, char **argv) {
    static float positions[(SIDE + 1) * (SIDE + 1)][3];
    static uint32_t triangles[2 * SIDE * SIDE][3];
    HolefillInput position_input = {positions, (SIDE + 1) * (SIDE + 1), 0, HOLEFILL_TYPE_F32, 0};
    HolefillInput triangle_input = {triangles, 0, 0, HOLEFILL_TYPE_U32, 0};
    HolefillSelection selection = HOLEFILL_SELECTION_INIT;
    HolefillTarget target = HOLEFILL_TARGET_INIT;
    HolefillMesh mesh = {0};
    HolefillReport report = {0};
    HolefillError error = {0};
    HolefillStatus status;
    int i, j, result = 0;

    for (i = 0; i <= SIDE; ++i) {
        for (j = 0; j <= SIDE; ++j) {
            float *p = positions[vertex_at(i, j)];
            const float x = 2.0f * (float)i / SIDE - 1.0f, y = 2.0f * (float)j / SIDE - 1.0f;
            p[0] = x;
            p[1] = y;
            p[2] = 1.0f - 0.5f * (x * x + y * y);
        }
    }
    for (i = 0; i < SIDE; ++i) {
        for (j = 0; j < SIDE; ++j) {
            const uint32_t a = vertex_at(i, j), b = vertex_at(i + 1, j), c = vertex_at(i + 1, j + 1);
            uint32_t *t = triangles[triangle_input.count];
            if (is_missing(i, j)) {
                continue;
            }
            /* The next row is the other half of the square. */
            t[0] = t[3] = a;
            t[1] = b;
            t[2] = t[4] = c;
            t[5] = vertex_at(i, j + 1);
            triangle_input.count += 2;
        }
    }

    status = holefill_mesh_from_arrays(&position_input, &triangle_input, &mesh, &error);
    if (status != HOLEFILL_STATUS_OK) {
        return fail(error, status);
    }
    selection.keep_largest = 1;
    target.selection = &selection;
    status = holefill_mesh_fill(mesh, &target, NULL, &report, &error);
    if (status != HOLEFILL_STATUS_OK && status != HOLEFILL_STATUS_INCOMPLETE) {
        holefill_mesh_free(mesh);
        return fail(error, status);
    }
    result = print_report(report);
    if (argc > 1 && result == 0) {
        result = write_obj(mesh, argv[1]);
    }
    holefill_report_free(report);
    holefill_mesh_free(mesh);
    holefill_error_free(error);
    return result != 0 || status != HOLEFILL_STATUS_OK;
}
