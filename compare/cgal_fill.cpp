// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fills the holes of one PLY mesh with CGAL's Polygon_mesh_processing, and reports time and memory.
//
//   cgal_fill INPUT.ply OUTPUT.ply [--continuity 0|1|2] [--method fair|refine|triangulate|cubic]
//             [--cdt2] [--keep V0,V1]... [--limit-seconds S] [--json FILE]
//
// The output has the vertices and faces of the input first, in the same order and bit for bit, and
// then the new ones. `-` as OUTPUT writes no mesh. `--keep V0,V1` names a loop by a directed boundary
// edge as in its face. `--method cubic` is only the exact O(m^3) search, on the polyline of the loop.
// `--cdt2` allows the planar search space. CGAL 5.5 documents it as the default, but leaves it off.
// Every option of the CGAL calls is set explicitly.
//
// Times: "cpu" is the processor time of this process around the calls named, "wall" the clock.
// Exit status: 0 all holes filled, 3 some failed (the output is still written), 2 bad usage,
// 1 cannot read or write, 4 the limit of processor seconds was reached.
// If CGAL rejects some faces (non-manifold input), the report has "build.ok": false. The holes of the
// other faces are still filled.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/assertions_behaviour.h>
#include <CGAL/version.h>

#include "mesh_file.h"

#include <array>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Vertex = Mesh::Vertex_index;
using Halfedge = Mesh::Halfedge_index;
using Face = Mesh::Face_index;
using judge::Arrays;
using judge::Triangle;

namespace {

enum class Method { Fair, Refine, Triangulate, Cubic };

struct Options {
    std::string input, output, json;
    unsigned continuity = 1;
    Method method = Method::Fair;
    bool cdt2 = false;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> keep;
    double limit_seconds = 0.0;
};

struct Usage : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct HoleReport {
    std::size_t edges = 0, new_vertices = 0, new_triangles = 0;
    std::pair<std::uint32_t, std::uint32_t> edge{0, 0};
    double cpu = 0.0;
    const char* status = "failed";
    std::string reason;
};

struct Clock {
    double cpu = 0.0, wall = 0.0;
};

double seconds_of(clockid_t id) {
    timespec t{};
    clock_gettime(id, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Clock now() { return {seconds_of(CLOCK_PROCESS_CPUTIME_ID), seconds_of(CLOCK_MONOTONIC)}; }

Clock since(const Clock& start) {
    const Clock end = now();
    return {end.cpu - start.cpu, end.wall - start.wall};
}

// ---------------------------------------------------------------------------------- arguments

std::pair<std::uint32_t, std::uint32_t> parse_edge(const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) throw Usage("an edge is written V0,V1, not '" + text + "'");
    try {
        return {static_cast<std::uint32_t>(std::stoul(text.substr(0, comma))),
                static_cast<std::uint32_t>(std::stoul(text.substr(comma + 1)))};
    } catch (const std::logic_error&) {
        throw Usage("an edge is written V0,V1, not '" + text + "'");
    }
}

Method parse_method(const std::string& name) {
    if (name == "fair") return Method::Fair;
    if (name == "refine") return Method::Refine;
    if (name == "triangulate") return Method::Triangulate;
    if (name == "cubic") return Method::Cubic;
    throw Usage("--method is fair, refine, triangulate or cubic, not '" + name + "'");
}

Options parse(int argc, char** argv) {
    Options options;
    std::vector<std::string> paths;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const auto value = [&]() -> std::string {
            if (i + 1 >= argc) throw Usage(argument + " needs a value");
            return argv[++i];
        };
        if (argument == "--continuity") {
            const std::string text = value();
            if (text != "0" && text != "1" && text != "2") throw Usage("--continuity is 0, 1 or 2");
            options.continuity = static_cast<unsigned>(text[0] - '0');
        } else if (argument == "--method") {
            options.method = parse_method(value());
        } else if (argument == "--cdt2") {
            options.cdt2 = true;
        } else if (argument == "--keep") {
            options.keep.push_back(parse_edge(value()));
        } else if (argument == "--limit-seconds") {
            options.limit_seconds = std::atof(value().c_str());
            if (!(options.limit_seconds > 0.0)) throw Usage("--limit-seconds is a positive number");
        } else if (argument == "--json") {
            options.json = value();
        } else if (argument.size() > 1 && argument[0] == '-') {
            throw Usage("unknown option " + argument);
        } else {
            paths.push_back(argument);
        }
    }
    if (paths.size() != 2) throw Usage("INPUT.ply and OUTPUT.ply are needed");
    options.input = paths[0];
    options.output = paths[1];
    return options;
}

// ------------------------------------------------------------------------------------- mesh

// Adds the faces in order. Faces that CGAL rejects are tried again at the end, because the reason may
// be the order. Returns the indices of the triangles that CGAL does not accept.
std::vector<std::size_t> build(const Arrays& arrays, Mesh& mesh) {
    mesh.reserve(static_cast<Mesh::size_type>(arrays.points.size()),
                 static_cast<Mesh::size_type>(arrays.triangles.size() * 3 / 2 + 1),
                 static_cast<Mesh::size_type>(arrays.triangles.size()));
    for (const auto& p : arrays.points) mesh.add_vertex(Point(p[0], p[1], p[2]));
    std::vector<std::size_t> refused;
    const auto add = [&](std::size_t i) {
        const Triangle& t = arrays.triangles[i];
        return mesh.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])) != Mesh::null_face();
    };
    for (std::size_t i = 0; i < arrays.triangles.size(); ++i)
        if (!add(i)) refused.push_back(i);
    std::vector<std::size_t> out;
    for (const std::size_t i : refused)
        if (!add(i)) out.push_back(i);
    return out;
}

std::vector<Halfedge> cycle_of(const Mesh& mesh, Halfedge start) {
    std::vector<Halfedge> cycle;
    Halfedge h = start;
    do {
        cycle.push_back(h);
        h = mesh.next(h);
    } while (h != start);
    return cycle;
}

std::uint32_t id(Vertex v) { return static_cast<std::uint32_t>(v); }

// Triangulates the polyline of the loop, with the apexes outside, by the exact search. The triangles become faces.
bool fill_cubic(Mesh& mesh, Halfedge border, std::vector<Face>& faces) {
    std::vector<Point> points, apexes;
    std::vector<Vertex> vertices;
    for (const Halfedge h : cycle_of(mesh, border)) {
        vertices.push_back(mesh.source(h));
        points.push_back(mesh.point(mesh.source(h)));
        apexes.push_back(mesh.point(mesh.target(mesh.next(mesh.opposite(h)))));
    }
    std::vector<CGAL::Triple<int, int, int>> triangles;
    PMP::triangulate_hole_polyline(points, apexes, std::back_inserter(triangles),
                                   PMP::parameters::use_delaunay_triangulation(false)
                                       .use_2d_constrained_delaunay_triangulation(false)
                                       .do_not_use_cubic_algorithm(false));
    for (const auto& t : triangles) {
        const auto at = [&](int i) { return vertices[static_cast<std::size_t>(i)]; };
        const Face face = mesh.add_face(at(t.first), at(t.second), at(t.third));
        if (face == Mesh::null_face()) return false;
        faces.push_back(face);
    }
    return !triangles.empty();
}

// Returns the reason for a failure, or an empty text.
std::string fill(Mesh& mesh, Halfedge border, const Options& options, std::vector<Face>& faces,
                 std::vector<Vertex>& vertices) {
    const auto base = PMP::parameters::use_delaunay_triangulation(true)
                          .use_2d_constrained_delaunay_triangulation(options.cdt2)
                          .do_not_use_cubic_algorithm(false);
    switch (options.method) {
        case Method::Cubic:
            return fill_cubic(mesh, border, faces) ? "" : "no triangulation";
        case Method::Triangulate:
            PMP::triangulate_hole(mesh, border, std::back_inserter(faces), base);
            break;
        case Method::Refine:
            PMP::triangulate_and_refine_hole(
                mesh, border, std::back_inserter(faces), std::back_inserter(vertices),
                PMP::parameters::use_delaunay_triangulation(true)
                    .use_2d_constrained_delaunay_triangulation(options.cdt2)
                    .do_not_use_cubic_algorithm(false)
                    .density_control_factor(std::sqrt(2.0)));
            break;
        case Method::Fair: {
            const bool faired = std::get<0>(PMP::triangulate_refine_and_fair_hole(
                mesh, border, std::back_inserter(faces), std::back_inserter(vertices),
                base.density_control_factor(std::sqrt(2.0))
                    .fairing_continuity(options.continuity)));
            if (!faces.empty() && !faired) return "fairing failed";
            break;
        }
    }
    return faces.empty() ? "no triangulation" : "";
}

// ----------------------------------------------------------------------------------- report

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out.push_back('\\');
        out.push_back(static_cast<unsigned char>(c) < 0x20 ? ' ' : c);
    }
    return out + "\"";
}

// From /proc, because ru_maxrss of a new process still has the size of its parent.
long peak_kilobytes() {
    std::ifstream file("/proc/self/status");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("VmHWM:", 0) == 0) return std::atol(line.c_str() + 6);
    return 0;
}

struct Report {
    std::size_t vertices = 0, triangles = 0, refused = 0, kept = 0;
    Clock read, build, loops, fill;
    std::vector<HoleReport> holes;

    std::string text(const char* status) const {
        std::size_t filled = 0, new_vertices = 0, new_triangles = 0;
        for (const HoleReport& hole : holes) {
            filled += std::strcmp(hole.status, "filled") == 0;
            new_vertices += hole.new_vertices;
            new_triangles += hole.new_triangles;
        }
        std::ostringstream out;
        const auto clock = [&](const char* name, const Clock& c) {
            out << quoted(name) << ": {\"cpu\": " << c.cpu << ", \"wall\": " << c.wall << "}";
        };
        out << std::setprecision(9) << "{\"program\": \"CGAL " << CGAL_VERSION_STR
            << "\", \"status\": " << quoted(status) << ", \"input\": {\"vertices\": " << vertices
            << ", \"triangles\": " << triangles << "}, \"build\": {\"ok\": "
            << (refused == 0 ? "true" : "false") << ", \"refused_triangles\": " << refused
            << "}, \"seconds\": {";
        clock("read", read);
        out << ", ";
        clock("build", build);
        out << ", ";
        clock("loops", loops);
        out << ", ";
        clock("fill", fill);
        out << "}, \"peak_kilobytes\": " << peak_kilobytes() << ", \"loops\": "
            << holes.size() + kept << ", \"kept\": " << kept << ", \"filled\": " << filled
            << ", \"failed\": " << holes.size() - filled << ", \"new_vertices\": " << new_vertices
            << ", \"new_triangles\": " << new_triangles << ", \"holes\": [";
        for (std::size_t i = 0; i < holes.size(); ++i) {
            const HoleReport& h = holes[i];
            out << (i == 0 ? "" : ", ") << "{\"edge\": [" << h.edge.first << ", " << h.edge.second
                << "], \"edges\": " << h.edges << ", \"status\": " << quoted(h.status)
                << ", \"reason\": " << quoted(h.reason) << ", \"new_vertices\": " << h.new_vertices
                << ", \"new_triangles\": " << h.new_triangles << ", \"cpu\": " << h.cpu << "}";
        }
        out << "]}\n";
        return out.str();
    }
};

void write_text(const std::string& path, const std::string& text) {
    if (path.empty()) return;
    std::ofstream file(path);
    file << text;
    file.close();
    if (!file) throw std::runtime_error("cannot write " + path);
}

// The limit stops the whole process, because CGAL's fairing cannot be canceled. A clock timer checks the
// processor time at intervals. A timer of processor time would be wrong: while it runs, Linux counts that
// time in whole ticks, which is too coarse for a small fill. The output of the handler is prepared
// before the fill starts.
constexpr suseconds_t LIMIT_CHECK_MICROSECONDS = 200'000;
std::string limit_json, limit_path;
double limit_seconds = 0.0, limit_start = 0.0;

extern "C" void on_limit(int) {
    if (seconds_of(CLOCK_PROCESS_CPUTIME_ID) - limit_start < limit_seconds) return;
    const int file = open(limit_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file >= 0) {
        const ssize_t written = write(file, limit_json.data(), limit_json.size());
        (void)written;
        close(file);
    }
    _exit(4);
}

void set_timer(suseconds_t microseconds) {
    itimerval timer{};
    timer.it_value.tv_usec = microseconds;
    timer.it_interval.tv_usec = microseconds;
    setitimer(ITIMER_REAL, &timer, nullptr);
}

void start_limit(const Options& options, const Report& report) {
    if (options.limit_seconds <= 0.0) return;
    limit_json = report.text("limit");
    limit_path = options.json.empty() ? "/dev/null" : options.json;
    limit_seconds = options.limit_seconds;
    limit_start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    std::signal(SIGALRM, on_limit);
    set_timer(LIMIT_CHECK_MICROSECONDS);
}

void stop_limit() { set_timer(0); }

// ------------------------------------------------------------------------------------- main

std::vector<Halfedge> holes_to_fill(const Mesh& mesh, const Options& options, Report& report) {
    std::vector<Halfedge> cycles;
    PMP::extract_boundary_cycles(mesh, std::back_inserter(cycles));
    std::set<Halfedge> kept;
    for (const auto& [v0, v1] : options.keep) {
        Halfedge h = Mesh::null_halfedge();
        if (v0 < mesh.number_of_vertices() && v1 < mesh.number_of_vertices())
            h = mesh.halfedge(Vertex(v0), Vertex(v1));
        if (h == Mesh::null_halfedge() || !mesh.is_border(mesh.opposite(h)))
            throw Usage("--keep " + std::to_string(v0) + "," + std::to_string(v1) +
                        " is not a boundary edge as in its face");
        for (const Halfedge b : cycle_of(mesh, mesh.opposite(h))) kept.insert(b);
    }
    std::vector<Halfedge> out;
    for (const Halfedge h : cycles) {
        if (kept.count(h) != 0)
            ++report.kept;
        else
            out.push_back(h);
    }
    return out;
}

void fill_holes(Mesh& mesh, const std::vector<Halfedge>& holes, const Options& options,
                Report& report) {
    report.holes.resize(holes.size());
    for (std::size_t i = 0; i < holes.size(); ++i) {
        HoleReport& hole = report.holes[i];
        hole.edges = cycle_of(mesh, holes[i]).size();
        hole.edge = {id(mesh.target(holes[i])), id(mesh.source(holes[i]))};
    }
    start_limit(options, report);
    const Clock start = now();
    for (std::size_t i = 0; i < holes.size(); ++i) {
        HoleReport& hole = report.holes[i];
        std::vector<Face> faces;
        std::vector<Vertex> vertices;
        const double hole_start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
        try {
            hole.reason = fill(mesh, holes[i], options, faces, vertices);
        } catch (const std::exception& error) {
            hole.reason = error.what();
        }
        hole.cpu = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - hole_start;
        hole.status = hole.reason.empty() ? "filled" : "failed";
        hole.new_vertices = vertices.size();
        hole.new_triangles = faces.size();
    }
    report.fill = since(start);
    stop_limit();
}

Arrays result(const Mesh& mesh, Arrays arrays, std::size_t taken_faces) {
    for (std::size_t v = arrays.points.size(); v < mesh.num_vertices(); ++v) {
        const Point& p = mesh.point(Vertex(static_cast<std::uint32_t>(v)));
        arrays.points.push_back({p.x(), p.y(), p.z()});
    }
    for (std::size_t f = taken_faces; f < mesh.num_faces(); ++f) {
        const Halfedge h = mesh.halfedge(Face(static_cast<std::uint32_t>(f)));
        arrays.triangles.push_back(
            {id(mesh.source(h)), id(mesh.target(h)), id(mesh.target(mesh.next(h)))});
    }
    return arrays;
}

int run(const Options& options) {
    CGAL::set_error_behaviour(CGAL::THROW_EXCEPTION);
    Report report;
    Clock start = now();
    Arrays arrays = judge::read_ply(options.input);
    report.read = since(start);
    report.vertices = arrays.points.size();
    report.triangles = arrays.triangles.size();

    Mesh mesh;
    start = now();
    const std::vector<std::size_t> refused = build(arrays, mesh);
    report.build = since(start);
    report.refused = refused.size();
    if (!refused.empty())
        std::cerr << "cgal_fill: build: failed: Surface_mesh refuses " << refused.size()
                  << " triangles, the first is " << refused.front() << "\n";
    const std::size_t taken_faces = mesh.num_faces();

    start = now();
    const std::vector<Halfedge> holes = holes_to_fill(mesh, options, report);
    report.loops = since(start);
    fill_holes(mesh, holes, options, report);

    bool all = true;
    for (const HoleReport& hole : report.holes) {
        if (std::strcmp(hole.status, "filled") == 0) continue;
        all = false;
        std::cerr << "cgal_fill: the loop of " << hole.edges << " edges through " << hole.edge.first
                  << "," << hole.edge.second << ": " << hole.reason << "\n";
    }
    if (options.output != "-")
        judge::write_ply(options.output, result(mesh, std::move(arrays), taken_faces));
    write_text(options.json, report.text(all ? "filled" : "failed"));
    return all ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(parse(argc, argv));
    } catch (const Usage& error) {
        std::cerr << "cgal_fill: " << error.what() << "\n"
                  << "usage: cgal_fill INPUT.ply OUTPUT.ply [--continuity 0|1|2]\n"
                     "       [--method fair|refine|triangulate|cubic] [--cdt2] [--keep V0,V1]...\n"
                     "       [--limit-seconds S] [--json FILE]\n";
        return 2;
    } catch (const std::exception& error) {
        std::cerr << "cgal_fill: " << error.what() << "\n";
        return 1;
    }
}
