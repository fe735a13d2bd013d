// SPDX-License-Identifier: GPL-3.0-or-later
//
// CGAL's hole filling, and its fairing alone.

#include "cgal_mesh.h"
#include "peers.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/fair.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <chrono>
#include <cmath>
#include <iterator>
#include <set>

namespace PMP = CGAL::Polygon_mesh_processing;

namespace judge {

namespace {

bool fill_hole(CgalMesh& mesh, CgalMesh::Halfedge_index border, int continuity) {
    std::vector<CgalMesh::Face_index> faces;
    std::vector<CgalMesh::Vertex_index> vertices;
    // Every option is set, because the default of the planar search differs from its documentation.
    const auto options = CGAL::parameters::use_delaunay_triangulation(true)
                             .use_2d_constrained_delaunay_triangulation(false)
                             .do_not_use_cubic_algorithm(false);
    if (continuity < 0) {
        PMP::triangulate_hole(mesh, border, std::back_inserter(faces), options);
        return !faces.empty();
    }
    const bool is_faired = std::get<0>(PMP::triangulate_refine_and_fair_hole(
        mesh, border, std::back_inserter(faces), std::back_inserter(vertices),
        CGAL::parameters::use_delaunay_triangulation(true)
            .use_2d_constrained_delaunay_triangulation(false)
            .do_not_use_cubic_algorithm(false)
            .density_control_factor(std::sqrt(2.0))
            .fairing_continuity(static_cast<unsigned>(continuity))));
    return is_faired && !faces.empty();
}

Arrays to_arrays(const CgalMesh& mesh) {
    Arrays arrays;
    for (const auto v : mesh.vertices()) arrays.points.push_back(from_cgal(mesh.point(v)));
    for (const auto f : mesh.faces()) {
        const auto h = mesh.halfedge(f);
        arrays.triangles.push_back({mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))});
    }
    return arrays;
}

}  // namespace

PeerFill fill_by_cgal(const Case& c, int continuity) {
    PeerFill out;
    CgalMesh mesh;
    if (!refused(build(c.input, mesh)).empty()) {
        out.failure = "Surface_mesh does not take the input";
        return out;
    }
    std::set<CgalMesh::Halfedge_index> kept;
    for (const Edge& e : c.keep) {
        const auto start = mesh.opposite(mesh.halfedge(CgalMesh::Vertex_index(e[0]), CgalMesh::Vertex_index(e[1])));
        for (auto h = start; kept.insert(h).second;) h = mesh.next(h);
    }
    std::vector<CgalMesh::Halfedge_index> cycles;
    PMP::extract_boundary_cycles(mesh, std::back_inserter(cycles));
    const auto start = std::chrono::steady_clock::now();
    for (const auto cycle : cycles) {
        if (kept.count(cycle) > 0) continue;
        ++out.holes;
        try {
            out.filled += fill_hole(mesh, cycle, continuity);
        } catch (const std::exception&) {
            // An assertion of CGAL failed: the hole counts as not filled.
        }
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    out.seconds = taken.count();
    out.output = to_arrays(mesh);
    return out;
}

bool fair_by_cgal(Arrays& arrays, std::size_t first, unsigned continuity) {
    CgalMesh mesh;
    if (!refused(build(arrays, mesh)).empty()) return false;
    std::vector<CgalMesh::Vertex_index> vertices;
    for (std::size_t v = first; v < arrays.points.size(); ++v)
        vertices.push_back(CgalMesh::Vertex_index(static_cast<std::uint32_t>(v)));
    if (!PMP::fair(mesh, vertices, CGAL::parameters::fairing_continuity(continuity))) return false;
    for (const auto v : vertices) arrays.points[v] = from_cgal(mesh.point(v));
    return true;
}

}  // namespace judge
