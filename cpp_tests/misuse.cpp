// Wrong use of the C interface in the shared library: every status that a mistake can have, and the mesh stays as it was, bit
// for bit. The tests in Rust have every function, every argument and every field.
#include "check.h"
#include "sheet.h"

#include <holefill.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <limits>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace {

std::set<HolefillStatus> seen;

HolefillStatus note(HolefillStatus status) {
    seen.insert(status);
    return status;
}

#define CHECK_FAILS(call, expected) CHECK_STATUS(note(call), expected)

struct Fixture {
    Sheet sheet = sheet_new();
    HolefillMesh mesh{};

    Fixture() {
        const HolefillInput positions = input();
        const HolefillInput triangles = corners();
        CHECK_OK(holefill_mesh_from_arrays(&positions, &triangles, &mesh, nullptr));
    }
    Fixture(const Fixture&) = delete;
    Fixture& operator=(const Fixture&) = delete;
    ~Fixture() {
        holefill_mesh_free(mesh);
        sheet_free(&sheet);
    }
    HolefillInput input() const { return {sheet.positions, sheet.vertex_count, 0, HOLEFILL_TYPE_F64, 0}; }
    HolefillInput corners() const { return {sheet.triangles, sheet.triangle_count, 0, HOLEFILL_TYPE_U32, 0}; }

    // FNV-1a over everything that the mesh consists of.
    uint64_t hash() const {
        HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
        CHECK_OK(holefill_mesh_info(mesh, &info, nullptr));
        std::vector<double> positions(3 * info.vertex_count);
        std::vector<uint32_t> triangles(3 * info.triangle_count);
        const HolefillOutput p{positions.data(), info.vertex_count, 0, HOLEFILL_TYPE_F64, 0};
        const HolefillOutput t{triangles.data(), info.triangle_count, 0, HOLEFILL_TYPE_U32, 0};
        CHECK_OK(holefill_mesh_read_positions(mesh, 0, &p, nullptr));
        CHECK_OK(holefill_mesh_read_triangles(mesh, 0, &t, nullptr));
        uint64_t hash = 1469598103934665603u;
        const auto add = [&](const void* data, std::size_t size) {
            const auto* bytes = static_cast<const unsigned char*>(data);
            for (std::size_t i = 0; i < size; ++i) {
                hash = (hash ^ bytes[i]) * 1099511628211u;
            }
        };
        add(positions.data(), positions.size() * sizeof(double));
        add(triangles.data(), triangles.size() * sizeof(uint32_t));
        return hash;
    }
};

void handles() {
    Fixture f;
    HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
    CHECK_OK(holefill_mesh_free(HolefillMesh{0}));
    CHECK_FAILS(holefill_mesh_info(HolefillMesh{0}, &info, nullptr), HOLEFILL_STATUS_INVALID_HANDLE);
    CHECK_FAILS(holefill_mesh_info(HolefillMesh{0x1234567890abcdefu}, &info, nullptr),
                HOLEFILL_STATUS_INVALID_HANDLE);

    HolefillMesh other{};
    const HolefillInput positions = f.input(), triangles = f.corners();
    CHECK_OK(holefill_mesh_from_arrays(&positions, &triangles, &other, nullptr));
    CHECK_OK(holefill_mesh_free(other));
    CHECK_FAILS(holefill_mesh_free(other), HOLEFILL_STATUS_INVALID_HANDLE);
    CHECK_FAILS(holefill_mesh_info(other, &info, nullptr), HOLEFILL_STATUS_INVALID_HANDLE);

    // A place that is used again does not bring the old handle back to life.
    HolefillMesh next{};
    CHECK_OK(holefill_mesh_from_arrays(&positions, &triangles, &next, nullptr));
    CHECK(next.id != other.id);
    CHECK_FAILS(holefill_mesh_info(other, &info, nullptr), HOLEFILL_STATUS_INVALID_HANDLE);
    CHECK_OK(holefill_mesh_free(next));

    // The wrong kind.
    HolefillPlan plan{};
    CHECK_OK(holefill_mesh_plan(f.mesh, nullptr, nullptr, &plan, nullptr));
    CHECK_FAILS(holefill_mesh_info(HolefillMesh{plan.id}, &info, nullptr), HOLEFILL_STATUS_INVALID_HANDLE);
    CHECK_FAILS(holefill_plan_free(HolefillPlan{f.mesh.id}), HOLEFILL_STATUS_INVALID_HANDLE);

    // A plan is of one mesh, and of that mesh as it was.
    Fixture stranger;
    CHECK_FAILS(holefill_plan_apply(plan, stranger.mesh, nullptr, nullptr, nullptr), HOLEFILL_STATUS_STALE_PLAN);
    CHECK_OK(holefill_plan_free(plan));
    CHECK_FAILS(holefill_plan_free(plan), HOLEFILL_STATUS_INVALID_HANDLE);
    CHECK_FAILS(holefill_mesh_undo(f.mesh, nullptr), HOLEFILL_STATUS_NOTHING_TO_UNDO);
}

void arrays() {
    Fixture f;
    const HolefillInput good = f.input(), corners = f.corners();
    const uint64_t huge = std::numeric_limits<uint64_t>::max();
    std::vector<double> not_finite(f.sheet.positions, f.sheet.positions + 3 * f.sheet.vertex_count);
    not_finite[100] = std::nan("");
    const uint64_t wide[3] = {0, 1, huge};
    const int64_t negative[3] = {0, 1, -2};
    struct Case {
        HolefillInput positions, triangles;
        HolefillStatus expected;
    };
    const auto changed = [](HolefillInput input, auto HolefillInput::*field, auto value) {
        input.*field = value;
        return input;
    };
    const Case cases[] = {
        {changed(good, &HolefillInput::data, nullptr), corners, HOLEFILL_STATUS_NULL_POINTER},
        {changed(good, &HolefillInput::count, huge / 3), corners, HOLEFILL_STATUS_OVERFLOW},
        {changed(good, &HolefillInput::stride, huge), corners, HOLEFILL_STATUS_OVERFLOW},
        {changed(good, &HolefillInput::stride, 1), corners, HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(good, &HolefillInput::scalar_type, 12345), corners, HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(good, &HolefillInput::reserved, 1), corners, HOLEFILL_STATUS_INVALID_STRUCT},
        {changed(good, &HolefillInput::data, not_finite.data()), corners, HOLEFILL_STATUS_NOT_FINITE},
        {good, {wide, 1, 0, HOLEFILL_TYPE_U64, 0}, HOLEFILL_STATUS_INDEX_OUT_OF_RANGE},
        {good, {negative, 1, 0, HOLEFILL_TYPE_I64, 0}, HOLEFILL_STATUS_INVALID_ARGUMENT},
        {good, changed(corners, &HolefillInput::scalar_type, HOLEFILL_TYPE_F32), HOLEFILL_STATUS_INVALID_ARGUMENT},
    };
    HolefillMesh mesh{77};
    for (const Case& c : cases) {
        CHECK_FAILS(holefill_mesh_from_arrays(&c.positions, &c.triangles, &mesh, nullptr), c.expected);
        const HolefillStatus status =
            note(holefill_mesh_from_points(&c.positions, nullptr, nullptr, nullptr, &mesh, nullptr, nullptr));
        CHECK(c.triangles.data != corners.data || c.triangles.scalar_type != corners.scalar_type ||
              status == c.expected);
        if (status == HOLEFILL_STATUS_OK) {
            CHECK_OK(holefill_mesh_free(std::exchange(mesh, HolefillMesh{77})));
        }
        CHECK(mesh.id == 77);
    }

    // Rows that are not aligned and lie apart are read as they are.
    const std::size_t stride = 3 * sizeof(double) + 5;
    std::vector<unsigned char> bytes(f.sheet.vertex_count * stride + 1);
    for (uint64_t i = 0; i < f.sheet.vertex_count; ++i) {
        std::memcpy(bytes.data() + 1 + i * stride, f.sheet.positions + 3 * i, 3 * sizeof(double));
    }
    const HolefillInput apart{bytes.data() + 1, f.sheet.vertex_count, stride, HOLEFILL_TYPE_F64, 0};
    CHECK_OK(holefill_mesh_from_arrays(&apart, &corners, &mesh, nullptr));
    Fixture same;
    std::swap(same.mesh, mesh);
    CHECK(same.hash() == f.hash());
    CHECK_OK(holefill_mesh_free(mesh));

    // Nothing at all is a mesh without loops.
    const HolefillInput none{nullptr, 0, 0, HOLEFILL_TYPE_F64, 0};
    const HolefillInput no_triangles{nullptr, 0, 0, HOLEFILL_TYPE_U32, 0};
    CHECK_OK(holefill_mesh_from_arrays(&none, &no_triangles, &mesh, nullptr));
    CHECK_OK(holefill_mesh_fill_all(mesh, nullptr));
    CHECK_OK(holefill_mesh_free(mesh));
}

void wrong_structs_and_values() {
    Fixture f;
    const uint64_t before = f.hash();
    const auto fill = [&](const HolefillTarget* target, const HolefillFillOptions& options) {
        return holefill_mesh_fill(f.mesh, target, &options, nullptr, nullptr);
    };
    const HolefillFillOptions init = HOLEFILL_FILL_OPTIONS_INIT;
    const auto changed = [&](auto HolefillFillOptions::*field, auto value) {
        HolefillFillOptions options = init;
        options.*field = value;
        return options;
    };
    const std::pair<HolefillFillOptions, HolefillStatus> options[] = {
        {changed(&HolefillFillOptions::struct_size, 0), HOLEFILL_STATUS_INVALID_STRUCT},
        {changed(&HolefillFillOptions::struct_size, 12), HOLEFILL_STATUS_INVALID_STRUCT},
        {changed(&HolefillFillOptions::version, 0), HOLEFILL_STATUS_INVALID_STRUCT},
        {changed(&HolefillFillOptions::method, "no such method"), HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(&HolefillFillOptions::time_budget, -1.0), HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(&HolefillFillOptions::density, HUGE_VAL), HOLEFILL_STATUS_INVALID_ARGUMENT},
        {changed(&HolefillFillOptions::threads, 1000000), HOLEFILL_STATUS_LIMIT},
        {changed(&HolefillFillOptions::parameters, HolefillParameters{99}), HOLEFILL_STATUS_INVALID_HANDLE},
    };
    for (const auto& [given, expected] : options) {
        CHECK_FAILS(fill(nullptr, given), expected);
    }

    // A struct of a later header that has grown: fine while what it has more is zero. One of an earlier header that is
    // shorter: what it does not have counts as zero, whatever stands there.
    struct Later {
        HolefillFillOptions known;
        uint64_t unknown[4];
    } later{HOLEFILL_FILL_OPTIONS_INIT, {0, 0, 0, 0}};
    later.known.struct_size = sizeof later;
    later.known.method = "flat";
    later.unknown[3] = 1;
    CHECK_FAILS(fill(nullptr, later.known), HOLEFILL_STATUS_INVALID_STRUCT);
    CHECK(f.hash() == before);
    later.unknown[3] = 0;
    CHECK_OK(fill(nullptr, later.known));
    CHECK_OK(holefill_mesh_undo(f.mesh, nullptr));
    HolefillFillOptions earlier = init;
    earlier.struct_size = offsetof(HolefillFillOptions, time_budget);
    earlier.time_budget = -1.0;
    CHECK_OK(fill(nullptr, earlier));
    CHECK_OK(holefill_mesh_undo(f.mesh, nullptr));
    HolefillMeshInfo short_info = HOLEFILL_MESH_INFO_INIT;
    short_info.struct_size = offsetof(HolefillMeshInfo, undo_count);
    short_info.undo_count = 77;
    CHECK_OK(holefill_mesh_info(f.mesh, &short_info, nullptr));
    CHECK(short_info.input_triangle_count == f.sheet.triangle_count && short_info.undo_count == 77);

    HolefillTarget target = HOLEFILL_TARGET_INIT;
    target.kind = 99;
    CHECK_FAILS(fill(&target, init), HOLEFILL_STATUS_INVALID_ARGUMENT);
    target.kind = HOLEFILL_TARGET_VERTICES;
    CHECK_FAILS(fill(&target, init), HOLEFILL_STATUS_NULL_POINTER);
    target.kind = HOLEFILL_TARGET_LOOP;
    target.loop_id = 10000;
    CHECK_FAILS(fill(&target, init), HOLEFILL_STATUS_NOT_FOUND);
    target.kind = HOLEFILL_TARGET_EDGE;
    target.edge[0] = f.sheet.hole_edge[1];
    target.edge[1] = f.sheet.hole_edge[0];
    CHECK_FAILS(fill(&target, init), HOLEFILL_STATUS_NOT_FOUND);
    uint64_t count = 0, id = 0;
    CHECK_FAILS(holefill_mesh_select(f.mesh, nullptr, &id, 1, &count, nullptr), HOLEFILL_STATUS_BUFFER_TOO_SMALL);
    CHECK(count == f.sheet.hole_count + 1);
    CHECK(f.hash() == before);
}

struct Stop {
    uint64_t after;
    uint64_t calls = 0;
};

int32_t stop(const HolefillProgress*, void* data) {
    Stop& s = *static_cast<Stop*>(data);
    return ++s.calls > s.after ? 1 : 0;
}

void cancel_at_every_call() {
    Fixture f;
    const uint64_t before = f.hash();
    HolefillFillOptions options = HOLEFILL_FILL_OPTIONS_INIT;
    options.threads = 1;
    options.method = "fair-c1";
    options.progress = stop;
    // Within a hole the callback is asked by the clock, so a slow machine has many calls: later ones are sampled.
    for (uint64_t after = 0;; after += 1 + after / 8) {
        Stop s{after};
        options.progress_data = &s;
        const HolefillStatus status = holefill_mesh_fill(f.mesh, nullptr, &options, nullptr, nullptr);
        if (status == HOLEFILL_STATUS_OK) {
            CHECK(s.calls >= f.sheet.hole_count);
            break;
        }
        CHECK_FAILS(status, HOLEFILL_STATUS_CANCELLED);
        CHECK(f.hash() == before);
    }
}

int32_t use_the_mesh(const HolefillProgress*, void* data) {
    const auto* f = static_cast<const Fixture*>(data);
    HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
    CHECK_FAILS(holefill_mesh_info(f->mesh, &info, nullptr), HOLEFILL_STATUS_BUSY);
    CHECK_FAILS(holefill_mesh_fill_all(f->mesh, nullptr), HOLEFILL_STATUS_BUSY);
    return 0;
}

void use_from_a_callback() {
    Fixture f;
    HolefillFillOptions options = HOLEFILL_FILL_OPTIONS_INIT;
    options.method = "flat";
    options.progress = use_the_mesh;
    options.progress_data = &f;
    CHECK_OK(holefill_mesh_fill(f.mesh, nullptr, &options, nullptr, nullptr));
}

void free_while_another_thread_fills() {
    for (int round = 0; round < 20; ++round) {
        Fixture f;
        std::atomic<bool> started{false};
        HolefillFillOptions options = HOLEFILL_FILL_OPTIONS_INIT;
        options.method = "fair-c1";
        options.progress = [](const HolefillProgress*, void* data) -> int32_t {
            static_cast<std::atomic<bool>*>(data)->store(true);
            return 0;
        };
        options.progress_data = &started;
        HolefillStatus status = HOLEFILL_STATUS_PANIC;
        std::thread filler(
            [&] { status = holefill_mesh_fill(f.mesh, nullptr, &options, nullptr, nullptr); });
        while (!started) {
            std::this_thread::yield();
        }
        CHECK_OK(holefill_mesh_free(f.mesh));
        HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
        CHECK_FAILS(holefill_mesh_info(f.mesh, &info, nullptr), HOLEFILL_STATUS_INVALID_HANDLE);
        filler.join();
        CHECK_OK(status);
        f.mesh = HolefillMesh{};
    }
}

void budget() {
    Fixture f;
    const uint64_t before = f.hash();
    HolefillFillOptions options = HOLEFILL_FILL_OPTIONS_INIT;
    options.time_budget = 1e-9;
    HolefillReport report{};
    CHECK_FAILS(holefill_mesh_fill(f.mesh, nullptr, &options, &report, nullptr), HOLEFILL_STATUS_INCOMPLETE);
    HolefillHole hole = HOLEFILL_HOLE_INIT;
    CHECK_OK(holefill_report_hole(report, 0, &hole, nullptr));
    CHECK(hole.status == HOLEFILL_HOLE_FAILED && hole.cause == HOLEFILL_CAUSE_LIMIT);
    CHECK_OK(holefill_report_free(report));
    CHECK(f.hash() == before);
}

void unfillable() {
    // Two triangles whose boundary runs the wrong way along one of them.
    const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const uint32_t triangles[] = {0, 1, 2, 1, 2, 3};
    const HolefillInput p{positions, 4, 0, HOLEFILL_TYPE_F64, 0}, t{triangles, 2, 0, HOLEFILL_TYPE_U32, 0};
    HolefillMesh mesh{};
    CHECK_OK(holefill_mesh_from_arrays(&p, &t, &mesh, nullptr));
    uint64_t count = 0;
    CHECK_OK(holefill_mesh_loop_count(mesh, &count, nullptr));
    CHECK(count > 0);
    HolefillTarget target = HOLEFILL_TARGET_INIT;
    target.kind = HOLEFILL_TARGET_LOOP;
    CHECK_FAILS(holefill_mesh_fill(mesh, &target, nullptr, nullptr, nullptr), HOLEFILL_STATUS_TOPOLOGY);
    CHECK_OK(holefill_mesh_free(mesh));
}

} // namespace

int main() {
    handles();
    arrays();
    wrong_structs_and_values();
    cancel_at_every_call();
    use_from_a_callback();
    free_while_another_thread_fills();
    budget();
    unfillable();
    CHECK(holefill_handle_count() == 0);
    // Memory that runs out and panics are provoked in the tests of the library itself.
    for (const HolefillStatus status :
         {HOLEFILL_STATUS_INCOMPLETE, HOLEFILL_STATUS_NULL_POINTER, HOLEFILL_STATUS_INVALID_HANDLE,
          HOLEFILL_STATUS_INVALID_ARGUMENT, HOLEFILL_STATUS_INVALID_STRUCT, HOLEFILL_STATUS_BUFFER_TOO_SMALL,
          HOLEFILL_STATUS_BUSY, HOLEFILL_STATUS_CANCELLED, HOLEFILL_STATUS_NOT_FOUND, HOLEFILL_STATUS_NOT_FINITE,
          HOLEFILL_STATUS_INDEX_OUT_OF_RANGE, HOLEFILL_STATUS_OVERFLOW, HOLEFILL_STATUS_TOPOLOGY, HOLEFILL_STATUS_LIMIT,
          HOLEFILL_STATUS_STALE_PLAN, HOLEFILL_STATUS_NOTHING_TO_UNDO}) {
        if (seen.count(status) == 0) {
            std::fprintf(stderr, "%s was never provoked\n", holefill_status_name(status));
            return 1;
        }
    }
    std::puts("misuse: every mistake has its status");
    return 0;
}
