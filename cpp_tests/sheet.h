/* A curved square sheet with holes, made in code: the mesh of the tests in C and C++; and what describes arrays. */
#ifndef HOLEFILL_TESTS_SHEET_H
#define HOLEFILL_TESTS_SHEET_H

#include <holefill.h>

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* Squares along each side, and how far apart the holes are. Each hole is a block of HOLE x HOLE squares. */
enum { SHEET_SIDE = 16, SHEET_PERIOD = 8, SHEET_HOLE = 3 };

typedef struct Sheet {
    double *positions;
    uint32_t *triangles;
    uint64_t vertex_count;
    uint64_t triangle_count;
    uint64_t hole_count;
    /* A directed boundary edge of the first hole, and of the outer rim. */
    uint32_t hole_edge[2];
    uint32_t rim_edge[2];
} Sheet;

static int sheet_is_open(int i, int j) {
    const int from = (SHEET_PERIOD - SHEET_HOLE) / 2;
    const int u = i % SHEET_PERIOD, v = j % SHEET_PERIOD;
    return u >= from && u < from + SHEET_HOLE && v >= from && v < from + SHEET_HOLE;
}

static uint32_t sheet_vertex(int i, int j) { return (uint32_t)(i * (SHEET_SIDE + 1) + j); }

/* Free it with sheet_free. The vertices inside the holes are isolated: they are not part of any triangle. */
static Sheet sheet_new(void) {
    Sheet s;
    const int n = SHEET_SIDE;
    uint64_t t = 0;
    int i, j;
    s.vertex_count = (uint64_t)(n + 1) * (uint64_t)(n + 1);
    s.positions = (double *)malloc((size_t)s.vertex_count * 3 * sizeof(double));
    s.triangles = (uint32_t *)malloc((size_t)n * n * 6 * sizeof(uint32_t));
    if (!s.positions || !s.triangles) {
        abort();
    }
    for (i = 0; i <= n; ++i) {
        for (j = 0; j <= n; ++j) {
            double *p = s.positions + 3 * sheet_vertex(i, j);
            p[0] = i;
            p[1] = j;
            p[2] = sin(0.2 * i) * cos(0.25 * j);
        }
    }
    for (i = 0; i < n; ++i) {
        for (j = 0; j < n; ++j) {
            const uint32_t a = sheet_vertex(i, j), b = sheet_vertex(i + 1, j), c = sheet_vertex(i + 1, j + 1),
                           d = sheet_vertex(i, j + 1);
            const uint32_t square[6] = {a, b, c, a, c, d};
            int k;
            if (sheet_is_open(i, j)) {
                continue;
            }
            for (k = 0; k < 6; ++k) {
                s.triangles[t++] = square[k];
            }
        }
    }
    s.triangle_count = t / 3;
    s.hole_count = (uint64_t)(n / SHEET_PERIOD) * (uint64_t)(n / SHEET_PERIOD);
    /* Squares before a hole end in an edge that runs in +j. */
    i = (SHEET_PERIOD - SHEET_HOLE) / 2;
    s.hole_edge[0] = sheet_vertex(i, i);
    s.hole_edge[1] = sheet_vertex(i, i + 1);
    s.rim_edge[0] = sheet_vertex(0, 0);
    s.rim_edge[1] = sheet_vertex(1, 0);
    return s;
}

static void sheet_free(Sheet *s) {
    free(s->positions);
    free(s->triangles);
}

/* Rows without gaps, to read and to write. */
static inline HolefillInput rows(const void *data, uint64_t count, HolefillType type) {
    HolefillInput made = HOLEFILL_INPUT_INIT;
    made.data = data;
    made.count = count;
    made.scalar_type = type;
    return made;
}

static inline HolefillOutput room(void *data, uint64_t count, HolefillType type) {
    HolefillOutput made = HOLEFILL_OUTPUT_INIT;
    made.data = data;
    made.count = count;
    made.scalar_type = type;
    return made;
}

/* A target of this kind. */
static inline HolefillTarget target(HolefillTargetKind kind) {
    HolefillTarget made = HOLEFILL_TARGET_INIT;
    made.kind = kind;
    return made;
}

#endif
