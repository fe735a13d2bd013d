// Wrong use of the C interface in the shared library: every status that a mistake can have, and the mesh stays as it was, bit
// for bit. The tests in Rust have every function, every argument, every field and every moment to stop.
#include "check.h"
#include "sheet.h"

#include <holefill.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace {

HolefillMesh make(const HolefillInput& positions, const HolefillInput& triangles) {
    HolefillMesh mesh{};
    CHECK_OK(holefill_mesh_from_arrays(&positions, &triangles, &mesh, nullptr));
    return mesh;
}

struct Fixture {
    Sheet sheet = sheet_new();
    HolefillInput positions = rows(sheet.positions, sheet.vertex_count, HOLEFILL_TYPE_F64);
    HolefillInput triangles = rows(sheet.triangles, sheet.triangle_count, HOLEFILL_TYPE_U32);
    HolefillMesh mesh = make(positions, triangles);

    Fixture() = default;
    Fixture(const Fixture&) = delete;
    Fixture& operator=(const Fixture&) = delete;
    ~Fixture() {
        holefill_mesh_free(mesh);
        sheet_free(&sheet);
    }

    // Everything that the mesh consists of.
    std::pair<std::vector<double>, std::vector<uint32_t>> state() const {
        HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
        CHECK_OK(holefill_mesh_info(mesh, &info, nullptr));
        std::vector<double> points(3 * info.vertex_count);
        std::vector<uint32_t> corners(3 * info.triangle_count);
        const HolefillOutput p = room(points.data(), info.vertex_count, HOLEFILL_TYPE_F64);
        const HolefillOutput t = room(corners.data(), info.triangle_count, HOLEFILL_TYPE_U32);
        CHECK_OK(holefill_mesh_read_positions(mesh, 0, &p, nullptr));
        CHECK_OK(holefill_mesh_read_triangles(mesh, 0, &t, nullptr));
        return {points, corners};
    }
};

template <class T, class Field, class Value>
T changed(T value, Field T::*field, Value to) {
    value.*field = to;
    return value;
}

std::set<HolefillStatus> seen;

// Checks a mistake that must not change the mesh.
void refuse(const Fixture& f, HolefillStatus status, HolefillStatus expected) {
    static const auto before = f.state();
    CHECK_STATUS(status, expected);
    CHECK(f.state() == before);
    seen.insert(status);
}

void handles(const Fixture& f) {
    HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
    HolefillPlan plan{};
    CHECK_OK(holefill_mesh_free(HolefillMesh{0}));
    CHECK_OK(holefill_mesh_plan(f.mesh, nullptr, nullptr, &plan, nullptr));
    const HolefillMesh freed = make(f.positions, f.triangles);
    CHECK_OK(holefill_mesh_free(freed));
    // A place that is used again does not bring the old handle back to life.
    const HolefillMesh next = make(f.positions, f.triangles);
    for (const uint64_t id : {uint64_t{0}, uint64_t{0x1234567890abcdef}, freed.id, plan.id}) {
        refuse(f, holefill_mesh_info(HolefillMesh{id}, &info, nullptr), HOLEFILL_STATUS_INVALID_HANDLE);
    }
    refuse(f, holefill_mesh_free(freed), HOLEFILL_STATUS_INVALID_HANDLE);
    refuse(f, holefill_plan_free(HolefillPlan{f.mesh.id}), HOLEFILL_STATUS_INVALID_HANDLE);
    // A plan is of one mesh.
    refuse(f, holefill_plan_apply(plan, next, nullptr, nullptr, nullptr), HOLEFILL_STATUS_STALE_PLAN);
    CHECK_OK(holefill_mesh_free(next));
    CHECK_OK(holefill_plan_free(plan));
    refuse(f, holefill_plan_free(plan), HOLEFILL_STATUS_INVALID_HANDLE);
    refuse(f, holefill_mesh_undo(f.mesh, nullptr), HOLEFILL_STATUS_NOTHING_TO_UNDO);
}

void arrays(const Fixture& f) {
    const HolefillInput &good = f.positions, &corners = f.triangles;
    const uint64_t huge = std::numeric_limits<uint64_t>::max();
    std::vector<double> not_finite(f.sheet.positions, f.sheet.positions + 3 * f.sheet.vertex_count);
    not_finite[100] = std::nan("");
    const uint64_t wide[3] = {0, 1, huge};
    const int64_t negative[3] = {0, 1, -2};
    struct {
        HolefillInput positions, triangles;
        HolefillStatus expected;
    } const cases[] = {
        {changed(good, &HolefillInput::data, nullptr), corners, HOLEFILL_STATUS_NULL_POINTER},
        {changed(good, &HolefillInput::count, huge / 3), corners, HOLEFILL_STATUS_OVERFLOW},
        {changed(good, &HolefillInput::stride, huge), corners, HOLEFILL_STATUS_OVERFLOW},
        {changed(good, &HolefillInput::stride, 1), corners, HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(good, &HolefillInput::scalar_type, 12345), corners, HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(good, &HolefillInput::reserved, 1), corners, HOLEFILL_STATUS_INVALID_STRUCT},
        {changed(good, &HolefillInput::data, not_finite.data()), corners, HOLEFILL_STATUS_NOT_FINITE},
        {good, rows(wide, 1, HOLEFILL_TYPE_U64), HOLEFILL_STATUS_INDEX_OUT_OF_RANGE},
        {good, rows(negative, 1, HOLEFILL_TYPE_I64), HOLEFILL_STATUS_INVALID_ARGUMENT},
        {good, changed(corners, &HolefillInput::scalar_type, HOLEFILL_TYPE_F32), HOLEFILL_STATUS_INVALID_ARGUMENT},
    };
    HolefillMesh mesh{77};
    for (const auto& c : cases) {
        refuse(f, holefill_mesh_from_arrays(&c.positions, &c.triangles, &mesh, nullptr), c.expected);
        if (std::memcmp(&c.triangles, &corners, sizeof corners) == 0) {
            refuse(f, holefill_mesh_from_points(&c.positions, nullptr, nullptr, nullptr, &mesh, nullptr, nullptr),
                   c.expected);
        }
        CHECK(mesh.id == 77);
    }
    // Nothing at all is a mesh without loops.
    mesh = make(rows(nullptr, 0, HOLEFILL_TYPE_F64), rows(nullptr, 0, HOLEFILL_TYPE_U32));
    CHECK_OK(holefill_mesh_fill_all(mesh, nullptr));
    CHECK_OK(holefill_mesh_free(mesh));
}

int32_t stop(const HolefillProgress*, void*) { return 1; }

void options(const Fixture& f) {
    using Options = HolefillFillOptions;
    const Options init = HOLEFILL_FILL_OPTIONS_INIT;
    // A struct of a later header that has grown: what it has more must be zero.
    struct {
        Options known;
        uint64_t unknown;
    } later{changed(init, &Options::struct_size, uint32_t{sizeof later}), 1};
    const struct {
        Options options;
        HolefillStatus expected;
    } cases[] = {
        {changed(init, &Options::struct_size, 0), HOLEFILL_STATUS_INVALID_STRUCT},
        {changed(init, &Options::struct_size, 12), HOLEFILL_STATUS_INVALID_STRUCT},
        {changed(init, &Options::version, 0), HOLEFILL_STATUS_INVALID_STRUCT},
        {changed(init, &Options::method, "no such method"), HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(init, &Options::time_budget, -1.0), HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(init, &Options::density, HUGE_VAL), HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(init, &Options::threads, 1000000), HOLEFILL_STATUS_LIMIT},
        {changed(init, &Options::parameters, HolefillParameters{99}), HOLEFILL_STATUS_INVALID_HANDLE},
        {changed(init, &Options::time_budget, 1e-9), HOLEFILL_STATUS_INCOMPLETE},
        {changed(init, &Options::progress, &stop), HOLEFILL_STATUS_CANCELLED},
    };
    for (const auto& c : cases) {
        refuse(f, holefill_mesh_fill(f.mesh, nullptr, &c.options, nullptr, nullptr), c.expected);
    }
    refuse(f, holefill_mesh_fill(f.mesh, nullptr, &later.known, nullptr, nullptr), HOLEFILL_STATUS_INVALID_STRUCT);
}

void targets(const Fixture& f) {
    HolefillTarget far = changed(target(HOLEFILL_TARGET_LOOP), &HolefillTarget::loop_id, 10000);
    HolefillTarget turned = target(HOLEFILL_TARGET_EDGE);
    turned.edge[0] = f.sheet.hole_edge[1];
    turned.edge[1] = f.sheet.hole_edge[0];
    const struct {
        HolefillTarget target;
        HolefillStatus expected;
    } cases[] = {
        {target(99), HOLEFILL_STATUS_INVALID_ARGUMENT},
        {target(HOLEFILL_TARGET_VERTICES), HOLEFILL_STATUS_NULL_POINTER},
        {far, HOLEFILL_STATUS_NOT_FOUND},
        {turned, HOLEFILL_STATUS_NOT_FOUND},
    };
    for (const auto& c : cases) {
        refuse(f, holefill_mesh_fill(f.mesh, &c.target, nullptr, nullptr, nullptr), c.expected);
    }
    uint64_t count = 0, id = 0;
    refuse(f, holefill_mesh_find_loops(f.mesh, nullptr, &id, 1, &count, nullptr), HOLEFILL_STATUS_BUFFER_TOO_SMALL);
    CHECK(count == f.sheet.hole_count + 1);

    // Two triangles whose boundary runs the wrong way along one of them.
    const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const uint32_t triangles[] = {0, 1, 2, 1, 2, 3};
    const HolefillMesh mesh = make(rows(positions, 4, HOLEFILL_TYPE_F64), rows(triangles, 2, HOLEFILL_TYPE_U32));
    const HolefillTarget first = target(HOLEFILL_TARGET_LOOP);
    refuse(f, holefill_mesh_fill(mesh, &first, nullptr, nullptr, nullptr), HOLEFILL_STATUS_TOPOLOGY);
    CHECK_OK(holefill_mesh_free(mesh));
}

int32_t use_the_mesh(const HolefillProgress*, void* data) {
    const auto* f = static_cast<const Fixture*>(data);
    HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
    CHECK_STATUS(holefill_mesh_info(f->mesh, &info, nullptr), HOLEFILL_STATUS_BUSY);
    CHECK_STATUS(holefill_mesh_fill_all(f->mesh, nullptr), HOLEFILL_STATUS_BUSY);
    seen.insert(HOLEFILL_STATUS_BUSY);
    return 0;
}

void use_from_a_callback(Fixture& f) {
    HolefillFillOptions options = HOLEFILL_FILL_OPTIONS_INIT;
    options.method = "flat";
    options.progress = use_the_mesh;
    options.progress_data = &f;
    CHECK_OK(holefill_mesh_fill(f.mesh, nullptr, &options, nullptr, nullptr));
}

} // namespace

int main() {
    {
        Fixture f;
        handles(f);
        arrays(f);
        options(f);
        targets(f);
        use_from_a_callback(f);
    }
    CHECK(holefill_handle_count() == 0);
    // Memory that runs out and panics are provoked in the tests of the library itself.
    seen.insert({HOLEFILL_STATUS_OK, HOLEFILL_STATUS_OUT_OF_MEMORY, HOLEFILL_STATUS_POISONED, HOLEFILL_STATUS_PANIC});
    for (HolefillStatus status = 0; std::strcmp(holefill_status_name(status), "UNKNOWN") != 0; ++status) {
        if (seen.count(status) == 0) {
            std::fprintf(stderr, "%s was never provoked\n", holefill_status_name(status));
            return 1;
        }
    }
    std::puts("misuse: every mistake has its status");
    return 0;
}
