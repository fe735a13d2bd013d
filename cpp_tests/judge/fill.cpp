#include "fill.h"

#include <holefill.hpp>

#include <chrono>

namespace judge {

namespace {

std::vector<Hole> read_holes(const holefill::Mesh& mesh, const holefill::Report& report) {
    std::vector<Hole> holes;
    for (const holefill::Hole& from : report.holes()) {
        Hole hole;
        for (const std::uint64_t v : mesh.loop_vertices(from.loop_id))
            hole.rim.push_back(static_cast<std::uint32_t>(v));
        hole.diameter = mesh.loop(from.loop_id).diameter;
        hole.filled = from.status == HOLEFILL_HOLE_FILLED;
        hole.kept = from.status == HOLEFILL_HOLE_KEPT;
        hole.first_vertex = from.first_vertex;
        hole.vertex_count = from.vertex_count;
        hole.first_triangle = from.first_triangle;
        hole.triangle_count = from.triangle_count;
        hole.self_intersections = from.self_intersections;
        hole.seconds = from.seconds;
        hole.method = from.HolefillHole::method ? from.HolefillHole::method : "";
        hole.reason = from.reason;
        for (const holefill::Attempt& attempt : from.tried)
            hole.reason += (hole.reason.empty() ? "" : "; ") + attempt.method + ": " + attempt.reason;
        holes.push_back(std::move(hole));
    }
    return holes;
}

std::vector<Triangle> searched(const holefill::Mesh& mesh, std::uint64_t loop) {
    holefill::Options options;
    options.method("flat").threads(1);
    options.set("flat.exact-limit", "2048");
    options.set("fill.fallback", "off");
    options.set("fill.join-islands", "off");
    const holefill::Plan plan = mesh.plan(holefill::Target::loop(loop), options);
    std::vector<Triangle> triangles;
    if (plan.report().hole(0).status != HOLEFILL_HOLE_FILLED) return triangles;
    for (const auto& t : plan.patch(loop).triangles)
        triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                             static_cast<std::uint32_t>(t[2])});
    return triangles;
}

}  // namespace

Fill fill(const Case& c, const std::string& method, const Settings& settings) {
    holefill::Mesh mesh = holefill::Mesh::from_arrays(c.input.points, c.input.triangles);
    mesh.prepare();
    holefill::Selection selection;
    for (const Edge& e : c.keep) selection.keep.push_back({e[0], e[1]});
    holefill::Options options;
    options.method(method).threads(1);
    for (const auto& [name, value] : settings) options.set(name.c_str(), value.c_str());

    const auto start = std::chrono::steady_clock::now();
    const holefill::Report report = mesh.fill(selection, options);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;

    Fill out;
    out.of = &c;
    out.method = method;
    out.seconds = taken.count();
    out.output.points = mesh.positions<double>();
    out.output.triangles = mesh.triangles<std::uint32_t>();
    out.holes = read_holes(mesh, report);
    return out;
}

std::vector<Triangle> search_polyline(const std::vector<Point>& points) {
    return searched(holefill::Mesh::from_polyline(points), 0);
}

std::vector<Triangle> search_loop(const Arrays& arrays, const Edge& edge) {
    const holefill::Mesh mesh = holefill::Mesh::from_arrays(arrays.points, arrays.triangles);
    return searched(mesh, mesh.find_loops(holefill::Target::edge(edge[0], edge[1])).at(0));
}

std::vector<std::vector<std::uint32_t>> loops(const Arrays& arrays) {
    const holefill::Mesh mesh = holefill::Mesh::from_arrays(arrays.points, arrays.triangles);
    std::vector<std::vector<std::uint32_t>> out(mesh.loop_count());
    for (std::size_t i = 0; i < out.size(); ++i)
        for (const std::uint64_t v : mesh.loop_vertices(i)) out[i].push_back(static_cast<std::uint32_t>(v));
    return out;
}

}  // namespace judge
