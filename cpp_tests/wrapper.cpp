// holefill.hpp: everything once, moves, exceptions, and exceptions out of callbacks.
#include "check.h"
#include "sheet.h"

#include <holefill.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <stdexcept>
#include <type_traits>
#include <utility>

static_assert(!std::is_copy_constructible_v<holefill::Mesh> && std::is_nothrow_move_constructible_v<holefill::Mesh>);
static_assert(!std::is_copy_constructible_v<holefill::Plan> && std::is_nothrow_move_assignable_v<holefill::Plan>);
static_assert(!std::is_copy_constructible_v<holefill::Report>);

namespace {

using Points = std::vector<std::array<double, 3>>;
using Triangles = std::vector<std::array<uint32_t, 3>>;

struct Arrays {
    Points positions;
    Triangles triangles;
    std::array<uint64_t, 2> hole_edge, rim_edge;
    uint64_t hole_count;
};

Arrays arrays() {
    Sheet sheet = sheet_new();
    Arrays a{Points(sheet.vertex_count), Triangles(sheet.triangle_count), {sheet.hole_edge[0], sheet.hole_edge[1]},
             {sheet.rim_edge[0], sheet.rim_edge[1]}, sheet.hole_count};
    std::copy_n(sheet.positions, 3 * sheet.vertex_count, a.positions[0].data());
    std::copy_n(sheet.triangles, 3 * sheet.triangle_count, a.triangles[0].data());
    sheet_free(&sheet);
    return a;
}

template <class Function>
HolefillStatus status_of(Function function) {
    try {
        function();
    } catch (const holefill::Exception& e) {
        CHECK(e.what()[0] != '\0');
        return e.status();
    }
    return HOLEFILL_STATUS_OK;
}

void everything_once() {
    using holefill::Target;
    const Arrays a = arrays();
    holefill::Mesh mesh = holefill::Mesh::from_arrays(a.positions, a.triangles);
    mesh.prepare();
    CHECK(mesh.info().vertex_count == a.positions.size());
    CHECK(mesh.defects().nonmanifold_edges == 0);
    CHECK(mesh.positions() == a.positions && mesh.triangles() == a.triangles);
    CHECK(mesh.positions<float>(a.positions.size() - 1).size() == 1);

    std::vector<float> heat(a.positions.size(), 2.0f);
    mesh.add_attribute(HOLEFILL_ELEMENT_VERTEX, "heat", 1, heat);
    const auto attributes = mesh.attributes(HOLEFILL_ELEMENT_VERTEX);
    CHECK(attributes.size() == 1 && attributes[0].name == "heat" && attributes[0].components == 1);

    CHECK(mesh.loop_count() == a.hole_count + 1 && mesh.loops().size() == a.hole_count + 1);
    const uint64_t id = mesh.find_loops(Target::edge(a.hole_edge[0], a.hole_edge[1])).at(0);
    const std::vector<uint64_t> loop = mesh.loop_vertices(id);
    CHECK(loop.size() == mesh.loop(id).edge_count);
    CHECK(mesh.find_loops(Target::vertices(loop)) == std::vector<uint64_t>{id});
    holefill::Selection holes;
    holes.keep = {a.rim_edge};
    CHECK(mesh.find_loops(holes).size() == a.hole_count);

    // Plans leave the mesh as it is and can be applied.
    const holefill::Plan plan = mesh.plan(Target::loop(id));
    const holefill::Patch patch = plan.patch(id);
    CHECK(patch.first_vertex == a.positions.size() && !patch.positions.empty() && !patch.triangles.empty());
    CHECK(plan.is_complete() && plan.report().hole(0).status == HOLEFILL_HOLE_FILLED);
    const holefill::Report predicted = mesh.plan(Target::loop(id), holefill::Options().method("auto")).report();
    const holefill::Hole hole = predicted.hole(0);
    CHECK(hole.prediction && hole.prediction->score_count > 0 && hole.prediction->chosen);
    const std::string json = predicted.json();
    CHECK(json.find("\"scores\"") != std::string::npos && json.find(hole.prediction->chosen) != std::string::npos);
    CHECK(!mesh.plan(Target::loop(id), holefill::Options().method("fair-c1")).report().hole(0).prediction);
    CHECK(mesh.positions() == a.positions);
    CHECK(mesh.apply(plan).is_complete());
    const Points filled = mesh.positions(a.positions.size());
    CHECK(filled == patch.positions);
    for (const float value : mesh.attribute<float>(HOLEFILL_ELEMENT_VERTEX, 0, a.positions.size())) {
        CHECK(value > 1.999f && value < 2.001f);
    }
    mesh.undo();
    CHECK(mesh.positions() == a.positions && mesh.triangles() == a.triangles);
    const holefill::Options simple = holefill::Options().method("fair-c1");
    const std::vector<int64_t> signed_id{static_cast<int64_t>(id)};
    const std::pair<Target, uint64_t> targets[] = {
        {Target::loop(id), 1},
        {Target::edge(a.hole_edge[0], a.hole_edge[1]), 1},
        {Target::vertices(loop), 1},
        {Target::loops(signed_id), 1},
        {Target::selected(holes), a.hole_count},
        {Target::all(), a.hole_count + 1},
    };
    for (const auto& [target, count] : targets) {
        CHECK(mesh.plan(target, simple).report().summary().filled == count);
        CHECK(mesh.fill(target, simple).summary().filled == count);
        mesh.undo();
    }

    holefill::Options options;
    uint64_t calls = 0, lines = 0;
    options.method("fair-c2").seed(7).density(0.8).max_new_vertices(100000).threads(1).time_budget(100.0);
    options.set("flat.exact-limit", "60");
    options.on_progress([&](const HolefillProgress&) { return ++calls > 0; });
    options.on_log([&](HolefillLogLevel, const char* message) { lines += message[0] != '\0'; });
    const holefill::Options copy = options;
    const holefill::Report report = mesh.fill(holes, copy);
    CHECK(report.summary().filled == a.hole_count && report.summary().kept == 1);
    CHECK(report.holes().size() == a.hole_count + 1 && calls > 0 && lines > 0);
    mesh.undo();
    CHECK(mesh.fill(simple).summary().filled == a.hole_count + 1);

    holefill::Mesh moved = std::move(mesh);
    CHECK(moved.loop_count() == a.hole_count + 1);
    CHECK(status_of([&] { mesh.info(); }) == HOLEFILL_STATUS_INVALID_HANDLE);
    mesh = std::move(moved);
    CHECK(mesh.loop_count() == a.hole_count + 1);
}

void failures_are_exceptions() {
    const Arrays a = arrays();
    CHECK(status_of([&] {
              holefill::Mesh::from_arrays(a.positions, Triangles{{0, 1, 1u << 30}});
          }) == HOLEFILL_STATUS_INDEX_OUT_OF_RANGE);
    holefill::Mesh mesh = holefill::Mesh::from_arrays(a.positions, a.triangles);
    CHECK(status_of([&] { (void)mesh.fill(holefill::Target::loop(999)); }) == HOLEFILL_STATUS_NOT_FOUND);
    CHECK(status_of([&] { (void)mesh.fill(holefill::Options().method("nonsense")); }) ==
          HOLEFILL_STATUS_INVALID_ARGUMENT);
    CHECK(status_of([&] { holefill::Options().set("nonsense", "1"); }) == HOLEFILL_STATUS_NOT_FOUND);
    holefill::Options stop;
    stop.on_progress([](const HolefillProgress&) { return false; });
    CHECK(status_of([&] { (void)mesh.fill(stop); }) == HOLEFILL_STATUS_CANCELLED);
    const holefill::Report late = mesh.fill(holefill::Options().time_budget(1e-9));
    CHECK(!late.is_complete() && late.summary().failed == a.hole_count + 1);
    CHECK(!mesh.plan(holefill::Options().time_budget(1e-9)).report().is_complete());
    CHECK(mesh.positions() == a.positions && mesh.triangles() == a.triangles);
}

struct Broken : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <class Function>
void check_throws_broken(Function function) {
    bool is_caught = false;
    try {
        function();
    } catch (const Broken& e) {
        is_caught = std::string(e.what()) == "from the callback";
    }
    CHECK(is_caught);
}

void callbacks_may_throw() {
    const Arrays a = arrays();
    holefill::Mesh mesh = holefill::Mesh::from_arrays(a.positions, a.triangles);
    for (const uint32_t threads : {1u, 2u}) {
        for (int after = 0; after < 4; ++after) {
            int calls = 0;
            holefill::Options options;
            options.method("fair-c1").threads(threads);
            options.on_progress([&](const HolefillProgress&) {
                if (calls++ == after) {
                    throw Broken("from the callback");
                }
                return true;
            });
            check_throws_broken([&] { (void)mesh.fill(options); });
            CHECK(mesh.positions() == a.positions && mesh.triangles() == a.triangles);
        }
    }
    holefill::Options options;
    options.method("fair-c1").on_log([](HolefillLogLevel, const char*) { throw Broken("from the callback"); });
    check_throws_broken([&] { (void)mesh.fill(options); });
}

void polylines() {
    Points points, normals;
    for (int i = 0; i < 40; ++i) {
        const double t = 6.283185307179586 * i / 40;
        points.push_back({std::cos(t), std::sin(t), 0.0});
        normals.push_back({0.6 * std::cos(t), 0.6 * std::sin(t), 0.8});
    }
    holefill::Mesh flat = holefill::Mesh::from_polyline(points);
    CHECK(flat.fill().summary().filled == 1);
    for (const auto& p : flat.positions()) {
        CHECK(std::abs(p[2]) < 1e-9);
    }
    holefill::Mesh cap = holefill::Mesh::from_polyline(points, normals);
    CHECK(cap.fill(holefill::Options().method("fair-c1")).summary().filled == 1);
    double highest = 0.0;
    for (const auto& p : cap.positions()) {
        highest = std::max(highest, p[2]);
    }
    CHECK(highest > 0.1);
}

void points() {
    Sheet sheet = sheet_new();
    const holefill::Rows<3> samples(sheet.positions, sheet.vertex_count);
    HolefillPointSummary summary{};
    holefill::Mesh plain = holefill::Mesh::from_points(samples);
    CHECK(plain.info().vertex_count == sheet.vertex_count);
    std::vector<std::array<float, 3>> down(sheet.vertex_count, {0.0f, 0.0f, -1.0f});
    std::vector<std::array<uint8_t, 3>> red(sheet.vertex_count, {255, 0, 0});
    holefill::PointOptions options;
    options.threads = 1;
    uint64_t questions = 0;
    options.on_progress = [&](const HolefillProgress&) { return ++questions > 0; };
    holefill::Mesh mesh = holefill::Mesh::from_points(samples, down, red, options, &summary);
    CHECK(summary.used == sheet.vertex_count && summary.triangle_count == mesh.info().triangle_count);
    CHECK(mesh.attributes(HOLEFILL_ELEMENT_VERTEX).at(0).name == "color");
    CHECK(mesh.attribute<uint8_t>(HOLEFILL_ELEMENT_VERTEX, 0).at(0) == 255);
    const auto positions = mesh.positions();
    const auto t = mesh.triangles().at(0);
    const auto &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
    CHECK((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0.0);
    CHECK(status_of([&] { holefill::Mesh::from_points(holefill::Rows<3>(sheet.positions, 3)); }) ==
          HOLEFILL_STATUS_INVALID_ARGUMENT);
    sheet_free(&sheet);

    // Enough points that there is time for a question.
    std::vector<std::array<double, 3>> many;
    for (int i = 0; i < 100; ++i) {
        for (int j = 0; j < 100; ++j) {
            many.push_back({double(i), double(j), std::sin(0.1 * i)});
        }
    }
    const auto make = [&] { holefill::Mesh::from_points(many, std::nullopt, std::nullopt, options); };
    options.on_progress = [](const HolefillProgress&) -> bool { throw Broken("from the callback"); };
    check_throws_broken(make);
    options.on_progress = [](const HolefillProgress&) { return false; };
    CHECK(status_of(make) == HOLEFILL_STATUS_CANCELLED);
}

} // namespace

int main() {
    everything_once();
    failures_are_exceptions();
    callbacks_may_throw();
    polylines();
    points();
    CHECK(holefill_handle_count() == 0);
    std::puts("wrapper: ok");
    return 0;
}
