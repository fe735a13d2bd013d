// Wrong use of the C interface: each mistake has its status, and the mesh stays as it was, bit for bit.
#include "check.h"
#include "sheet.h"

#include <holefill.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <set>
#include <thread>
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
    CHECK_OK(holefill_mesh_plan_selected(f.mesh, nullptr, nullptr, &plan, nullptr));
    CHECK_FAILS(holefill_mesh_info(HolefillMesh{plan.id}, &info, nullptr), HOLEFILL_STATUS_INVALID_HANDLE);
    CHECK_FAILS(holefill_plan_free(HolefillPlan{f.mesh.id}), HOLEFILL_STATUS_INVALID_HANDLE);
    HolefillReport report{};
    CHECK_FAILS(holefill_plan_report(HolefillPlan{f.mesh.id}, &report, nullptr), HOLEFILL_STATUS_INVALID_HANDLE);
    CHECK_FAILS(holefill_report_free(HolefillReport{plan.id}), HOLEFILL_STATUS_INVALID_HANDLE);
    HolefillSummary summary = HOLEFILL_SUMMARY_INIT;
    CHECK_FAILS(holefill_report_summary(HolefillReport{plan.id}, &summary, nullptr), HOLEFILL_STATUS_INVALID_HANDLE);
    CHECK_FAILS(holefill_parameters_free(HolefillParameters{plan.id}), HOLEFILL_STATUS_INVALID_HANDLE);
    CHECK_FAILS(holefill_error_free(HolefillError{plan.id}), HOLEFILL_STATUS_INVALID_HANDLE);

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
    HolefillMesh mesh{77};
    const auto try_positions = [&](HolefillInput input) {
        return holefill_mesh_from_arrays(&input, &corners, &mesh, nullptr);
    };
    const auto try_triangles = [&](HolefillInput input) {
        return holefill_mesh_from_arrays(&good, &input, &mesh, nullptr);
    };
    const uint64_t huge = std::numeric_limits<uint64_t>::max();
    HolefillInput bad = good;
    bad.data = nullptr;
    CHECK_FAILS(try_positions(bad), HOLEFILL_STATUS_NULL_POINTER);
    for (const uint64_t count : {huge, huge / 3, huge / 24 + 1}) {
        bad = good;
        bad.count = count;
        const HolefillStatus status = note(try_positions(bad));
        CHECK(status == HOLEFILL_STATUS_OVERFLOW || status == HOLEFILL_STATUS_INVALID_ARGUMENT ||
              status == HOLEFILL_STATUS_LIMIT);
        bad = corners;
        bad.count = count;
        CHECK(try_triangles(bad) != HOLEFILL_STATUS_OK);
    }
    bad = good;
    bad.stride = huge;
    CHECK_FAILS(try_positions(bad), HOLEFILL_STATUS_OVERFLOW);
    bad = good;
    bad.stride = 1;
    CHECK_FAILS(try_positions(bad), HOLEFILL_STATUS_INVALID_ARGUMENT);
    bad = good;
    bad.scalar_type = HOLEFILL_TYPE_U8;
    CHECK_FAILS(try_positions(bad), HOLEFILL_STATUS_INVALID_ARGUMENT);
    bad = good;
    bad.scalar_type = 12345;
    CHECK_FAILS(try_positions(bad), HOLEFILL_STATUS_INVALID_ARGUMENT);
    bad = corners;
    bad.scalar_type = HOLEFILL_TYPE_F32;
    CHECK_FAILS(try_triangles(bad), HOLEFILL_STATUS_INVALID_ARGUMENT);

    std::vector<double> positions(f.sheet.positions, f.sheet.positions + 3 * f.sheet.vertex_count);
    bad = good;
    bad.data = positions.data();
    for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        positions[100] = value;
        CHECK_FAILS(try_positions(bad), HOLEFILL_STATUS_NOT_FINITE);
    }
    std::vector<uint32_t> triangles(f.sheet.triangles, f.sheet.triangles + 3 * f.sheet.triangle_count);
    bad = corners;
    bad.data = triangles.data();
    for (const uint64_t index : {f.sheet.vertex_count, uint64_t{0xffffffff}}) {
        triangles[50] = static_cast<uint32_t>(index);
        CHECK_FAILS(try_triangles(bad), HOLEFILL_STATUS_INDEX_OUT_OF_RANGE);
    }
    const std::vector<uint64_t> wide{0, 1, huge};
    CHECK_FAILS(try_triangles({wide.data(), 1, 0, HOLEFILL_TYPE_U64, 0}), HOLEFILL_STATUS_INDEX_OUT_OF_RANGE);
    // Outputs are written on success only.
    CHECK(mesh.id == 77);

    // Rows that are not aligned and lie apart are read as they are.
    const std::size_t stride = 3 * sizeof(double) + 5;
    std::vector<unsigned char> bytes(f.sheet.vertex_count * stride + 1);
    for (uint64_t i = 0; i < f.sheet.vertex_count; ++i) {
        std::memcpy(bytes.data() + 1 + i * stride, f.sheet.positions + 3 * i, 3 * sizeof(double));
    }
    CHECK_OK(try_positions({bytes.data() + 1, f.sheet.vertex_count, stride, HOLEFILL_TYPE_F64, 0}));
    Fixture same;
    std::swap(same.mesh, mesh);
    CHECK(same.hash() == f.hash());
    CHECK_OK(holefill_mesh_free(mesh));

    // Nothing at all is a mesh without loops.
    const HolefillInput none{nullptr, 0, 0, HOLEFILL_TYPE_F64, 0};
    const HolefillInput no_triangles{nullptr, 0, 0, HOLEFILL_TYPE_U32, 0};
    uint64_t count = 9;
    CHECK_OK(holefill_mesh_from_arrays(&none, &no_triangles, &mesh, nullptr));
    CHECK_OK(holefill_mesh_loop_count(mesh, &count, nullptr));
    CHECK(count == 0);
    CHECK_OK(holefill_mesh_fill_selected(mesh, nullptr, nullptr, nullptr, nullptr));
    CHECK_OK(holefill_mesh_free(mesh));
}

void points() {
    Fixture f;
    const HolefillInput good = f.input();
    HolefillMesh mesh{77};
    HolefillPointSummary summary = HOLEFILL_POINT_SUMMARY_INIT;
    const auto from = [&](const HolefillInput* points, const HolefillInput* normals, const HolefillInput* colors) {
        return holefill_mesh_from_points(points, normals, colors, nullptr, &mesh, &summary, nullptr);
    };
    const auto in_every_place = [&](const HolefillInput& bad, HolefillStatus expected) {
        CHECK_FAILS(from(&bad, nullptr, nullptr), expected);
        CHECK_FAILS(from(&good, &bad, nullptr), expected);
        CHECK_FAILS(from(&good, nullptr, &bad), expected);
    };
    CHECK_FAILS(from(nullptr, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_from_points(&good, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    const uint64_t huge = std::numeric_limits<uint64_t>::max();
    HolefillInput bad = good;
    bad.data = nullptr;
    in_every_place(bad, HOLEFILL_STATUS_NULL_POINTER);
    for (const uint64_t count : {huge, huge / 2, huge / 24, uint64_t{1} << 60}) {
        bad = good;
        bad.count = count;
        in_every_place(bad, HOLEFILL_STATUS_OVERFLOW);
        bad = good;
        bad.stride = count;
        in_every_place(bad, HOLEFILL_STATUS_OVERFLOW);
    }
    bad = good;
    bad.stride = 8;
    in_every_place(bad, HOLEFILL_STATUS_INVALID_ARGUMENT);
    bad = good;
    bad.scalar_type = HOLEFILL_TYPE_U64;
    in_every_place(bad, HOLEFILL_STATUS_INVALID_ARGUMENT);
    bad = good;
    bad.reserved = 1;
    in_every_place(bad, HOLEFILL_STATUS_INVALID_STRUCT);
    bad = good;
    bad.count -= 1;
    CHECK_FAILS(from(&good, &bad, nullptr), HOLEFILL_STATUS_INVALID_ARGUMENT);
    CHECK_FAILS(from(&good, nullptr, &bad), HOLEFILL_STATUS_INVALID_ARGUMENT);
    bad.count = 3;
    CHECK_FAILS(from(&bad, nullptr, nullptr), HOLEFILL_STATUS_INVALID_ARGUMENT);
    std::vector<double> spoiled(f.sheet.positions, f.sheet.positions + 3 * f.sheet.vertex_count);
    spoiled[4] = std::nan("");
    bad = good;
    bad.data = spoiled.data();
    CHECK_FAILS(from(&bad, nullptr, nullptr), HOLEFILL_STATUS_NOT_FINITE);
    CHECK_FAILS(from(&good, &bad, nullptr), HOLEFILL_STATUS_NOT_FINITE);

    const auto with = [&](const HolefillPointOptions& options) {
        return holefill_mesh_from_points(&good, nullptr, nullptr, &options, &mesh, &summary, nullptr);
    };
    HolefillPointOptions options = HOLEFILL_POINT_OPTIONS_INIT;
    options.struct_size = 8;
    CHECK_FAILS(with(options), HOLEFILL_STATUS_INVALID_STRUCT);
    options = HOLEFILL_POINT_OPTIONS_INIT;
    options.version = 0;
    CHECK_FAILS(with(options), HOLEFILL_STATUS_INVALID_STRUCT);
    for (const double value : {-1.0, std::nan(""), HUGE_VAL}) {
        options = HOLEFILL_POINT_OPTIONS_INIT;
        options.radius = value;
        CHECK_FAILS(with(options), HOLEFILL_STATUS_INVALID_ARGUMENT);
        options = HOLEFILL_POINT_OPTIONS_INIT;
        options.time_budget = value;
        CHECK_FAILS(with(options), HOLEFILL_STATUS_INVALID_ARGUMENT);
    }
    options = HOLEFILL_POINT_OPTIONS_INIT;
    options.neighbours = 1000;
    CHECK_FAILS(with(options), HOLEFILL_STATUS_INVALID_ARGUMENT);
    options = HOLEFILL_POINT_OPTIONS_INIT;
    options.threads = 1000000;
    CHECK_FAILS(with(options), HOLEFILL_STATUS_LIMIT);
    options = HOLEFILL_POINT_OPTIONS_INIT;
    options.time_budget = 1e-9;
    CHECK_FAILS(with(options), HOLEFILL_STATUS_LIMIT);
    CHECK(mesh.id == 77 && summary.triangle_count == 0);
    summary.version = 0;
    CHECK_FAILS(from(&good, nullptr, nullptr), HOLEFILL_STATUS_INVALID_STRUCT);
    CHECK(mesh.id == 77);
}

void null_pointers() {
    Fixture f;
    const uint64_t before = f.hash();
    const HolefillInput positions = f.input(), triangles = f.corners();
    HolefillMesh mesh{};
    HolefillPlan plan{};
    CHECK_FAILS(holefill_mesh_from_arrays(nullptr, &triangles, &mesh, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_from_arrays(&positions, nullptr, &mesh, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_from_arrays(&positions, &triangles, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_from_polyline(nullptr, nullptr, &mesh, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_from_polyline(&positions, nullptr, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_info(f.mesh, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_defects(f.mesh, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_read_positions(f.mesh, 0, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_read_triangles(f.mesh, 0, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    const HolefillOutput nowhere{nullptr, 1, 0, HOLEFILL_TYPE_F64, 0};
    CHECK_FAILS(holefill_mesh_read_positions(f.mesh, 0, &nowhere, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_add_attribute(f.mesh, HOLEFILL_ELEMENT_VERTEX, nullptr, 1, &positions, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_add_attribute(f.mesh, HOLEFILL_ELEMENT_VERTEX, "a", 1, nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_attribute_count(f.mesh, HOLEFILL_ELEMENT_VERTEX, nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_OK(holefill_mesh_add_attribute(f.mesh, HOLEFILL_ELEMENT_VERTEX, "a", 3, &positions, nullptr));
    CHECK_FAILS(holefill_mesh_attribute_info(f.mesh, HOLEFILL_ELEMENT_VERTEX, 0, nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_attribute_name(f.mesh, HOLEFILL_ELEMENT_VERTEX, 0, nullptr, 0, nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_read_attribute(f.mesh, HOLEFILL_ELEMENT_VERTEX, 0, 0, nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_loop_count(f.mesh, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_loop_info(f.mesh, 0, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_read_loop(f.mesh, 0, 0, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_find_edge(f.mesh, f.sheet.hole_edge[0], f.sheet.hole_edge[1], nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    uint64_t count = 0;
    CHECK_FAILS(holefill_mesh_find_vertices(f.mesh, nullptr, nullptr, 0, &count, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_select(f.mesh, nullptr, nullptr, 5, &count, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_select(f.mesh, nullptr, nullptr, 0, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_fill_vertices(f.mesh, nullptr, nullptr, nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_fill_loops(f.mesh, nullptr, nullptr, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_plan_loop(f.mesh, 0, nullptr, nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_plan_edge(f.mesh, f.sheet.hole_edge[0], f.sheet.hole_edge[1], nullptr, nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_plan_vertices(f.mesh, nullptr, nullptr, &plan, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_plan_loops(f.mesh, nullptr, nullptr, &plan, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_mesh_plan_selected(f.mesh, nullptr, nullptr, nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_parameters_new(nullptr, nullptr), HOLEFILL_STATUS_NULL_POINTER);
    HolefillParameters parameters{};
    CHECK_OK(holefill_parameters_new(&parameters, nullptr));
    CHECK_FAILS(holefill_parameters_set(parameters, nullptr, "1", nullptr), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_parameters_set(parameters, "refine.density", nullptr, nullptr),
                HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_parameters_set(parameters, "refine.density", "-1", nullptr),
                HOLEFILL_STATUS_INVALID_ARGUMENT);
    CHECK_OK(holefill_parameters_free(parameters));
    CHECK_FAILS(holefill_fill_options_init(nullptr, 0), HOLEFILL_STATUS_NULL_POINTER);
    CHECK_FAILS(holefill_selection_init(nullptr, 0), HOLEFILL_STATUS_NULL_POINTER);
    CHECK(f.hash() == before);
}

void wrong_structs_and_values() {
    Fixture f;
    const uint64_t before = f.hash();
    const auto fill = [&](const HolefillFillOptions& options) {
        return holefill_mesh_fill_selected(f.mesh, nullptr, &options, nullptr, nullptr);
    };
    HolefillFillOptions options = HOLEFILL_FILL_OPTIONS_INIT;
    for (const uint32_t size : {0u, 1u, 8u, static_cast<uint32_t>(sizeof options) - 1}) {
        options.struct_size = size;
        CHECK_FAILS(fill(options), HOLEFILL_STATUS_INVALID_STRUCT);
    }
    options = HOLEFILL_FILL_OPTIONS_INIT;
    options.version = 0;
    CHECK_FAILS(fill(options), HOLEFILL_STATUS_INVALID_STRUCT);
    options = HOLEFILL_FILL_OPTIONS_INIT;
    options.method = "no such method";
    CHECK_FAILS(fill(options), HOLEFILL_STATUS_INVALID_ARGUMENT);
    for (const double value : {-1.0, std::nan(""), HUGE_VAL}) {
        options = HOLEFILL_FILL_OPTIONS_INIT;
        options.time_budget = value;
        CHECK_FAILS(fill(options), HOLEFILL_STATUS_INVALID_ARGUMENT);
        options = HOLEFILL_FILL_OPTIONS_INIT;
        options.density = value;
        CHECK_FAILS(fill(options), HOLEFILL_STATUS_INVALID_ARGUMENT);
    }
    options = HOLEFILL_FILL_OPTIONS_INIT;
    options.threads = 1000000;
    CHECK_FAILS(fill(options), HOLEFILL_STATUS_LIMIT);
    options = HOLEFILL_FILL_OPTIONS_INIT;
    options.parameters.id = 99;
    CHECK_FAILS(fill(options), HOLEFILL_STATUS_INVALID_HANDLE);

    // A struct of a later header that has grown: fine while what it has more is zero.
    struct Later {
        HolefillFillOptions known;
        uint64_t unknown[4];
    } later{HOLEFILL_FILL_OPTIONS_INIT, {0, 0, 0, 0}};
    later.known.struct_size = sizeof later;
    later.unknown[3] = 1;
    CHECK_FAILS(fill(later.known), HOLEFILL_STATUS_INVALID_STRUCT);
    CHECK(f.hash() == before);
    later.unknown[3] = 0;
    CHECK_OK(fill(later.known));
    CHECK_OK(holefill_mesh_undo(f.mesh, nullptr));
    CHECK(f.hash() == before);

    CHECK_FAILS(holefill_mesh_fill_loop(f.mesh, 10000, nullptr, nullptr, nullptr), HOLEFILL_STATUS_NOT_FOUND);
    CHECK_FAILS(holefill_mesh_fill_edge(f.mesh, 0, 0, nullptr, nullptr, nullptr), HOLEFILL_STATUS_NOT_FOUND);
    CHECK_FAILS(holefill_mesh_fill_edge(f.mesh, f.sheet.hole_edge[1], f.sheet.hole_edge[0], nullptr, nullptr, nullptr),
                HOLEFILL_STATUS_NOT_FOUND);
    const uint32_t chain[3] = {0, 1, 2};
    const HolefillInput rows{chain, 3, 0, HOLEFILL_TYPE_U32, 0};
    CHECK_FAILS(holefill_mesh_fill_vertices(f.mesh, &rows, nullptr, nullptr, nullptr), HOLEFILL_STATUS_NOT_FOUND);
    std::vector<double> buffer(3);
    const HolefillOutput output{buffer.data(), 1, 0, HOLEFILL_TYPE_F64, 0};
    CHECK_FAILS(holefill_mesh_read_positions(f.mesh, 1u << 30, &output, nullptr), HOLEFILL_STATUS_NOT_FOUND);
    CHECK_FAILS(holefill_mesh_read_positions(f.mesh, std::numeric_limits<uint64_t>::max(), &output, nullptr),
                HOLEFILL_STATUS_NOT_FOUND);
    uint64_t count = 0, id = 0;
    CHECK_FAILS(holefill_mesh_select(f.mesh, nullptr, &id, 1, &count, nullptr), HOLEFILL_STATUS_BUFFER_TOO_SMALL);
    CHECK(count == f.sheet.hole_count + 1);
    CHECK_FAILS(holefill_mesh_attribute_count(f.mesh, 99, &count, nullptr), HOLEFILL_STATUS_INVALID_ARGUMENT);
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
        const HolefillStatus status = holefill_mesh_fill_selected(f.mesh, nullptr, &options, nullptr, nullptr);
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
    CHECK_FAILS(holefill_mesh_fill_selected(f->mesh, nullptr, nullptr, nullptr, nullptr), HOLEFILL_STATUS_BUSY);
    return 0;
}

void use_from_a_callback() {
    Fixture f;
    HolefillFillOptions options = HOLEFILL_FILL_OPTIONS_INIT;
    options.progress = use_the_mesh;
    options.progress_data = &f;
    CHECK_OK(holefill_mesh_fill_selected(f.mesh, nullptr, &options, nullptr, nullptr));
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
            [&] { status = holefill_mesh_fill_selected(f.mesh, nullptr, &options, nullptr, nullptr); });
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
    CHECK_FAILS(holefill_mesh_fill_loop(f.mesh, 0, &options, &report, nullptr), HOLEFILL_STATUS_INCOMPLETE);
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
    CHECK_FAILS(holefill_mesh_fill_loop(mesh, 0, nullptr, nullptr, nullptr), HOLEFILL_STATUS_TOPOLOGY);
    CHECK_OK(holefill_mesh_free(mesh));
}

} // namespace

int main() {
    handles();
    arrays();
    points();
    null_pointers();
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
