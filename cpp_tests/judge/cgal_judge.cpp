// SPDX-License-Identifier: GPL-3.0-or-later
//
// CGAL's predicates on a filled mesh.

#include "cgal_mesh.h"
#include "judges.h"
#include "topology.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>

#include <algorithm>

namespace PMP = CGAL::Polygon_mesh_processing;

namespace judge {

namespace {

// A triangle whose longest edge is so many times its shortest is a needle.
constexpr double NEEDLE_RATIO = 20.0;

// The number of pairs of triangles that intersect, one of them new.
std::size_t count_intersections(const Fill& fill, const CgalMesh& mesh) {
    std::vector<CgalMesh::Face_index> faces;
    for (const std::size_t f : patch_and_surroundings(fill)) faces.push_back(CgalMesh::Face_index(f));
    std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> pairs;
    PMP::self_intersections<CGAL::Sequential_tag>(faces, mesh, std::back_inserter(pairs));
    const std::size_t old = fill.of->input.triangles.size();
    return static_cast<std::size_t>(std::count_if(
        pairs.begin(), pairs.end(), [&](const auto& p) { return std::max<std::size_t>(p.first, p.second) >= old; }));
}

// New triangles without area, and needles. Where the shortest edge of a needle joins two vertices of the input, the rim
// forces it.
std::pair<std::size_t, std::size_t> count_bad_shapes(const Fill& fill, const CgalMesh& mesh) {
    const std::size_t old_vertices = fill.of->input.points.size();
    std::size_t degenerate = 0, needles = 0;
    for (std::size_t f = fill.of->input.triangles.size(); f < fill.output.triangles.size(); ++f) {
        const CgalMesh::Face_index face(static_cast<std::uint32_t>(f));
        if (PMP::is_degenerate_triangle_face(face, mesh)) {
            ++degenerate;
            continue;
        }
        const auto shortest = PMP::is_needle_triangle_face(face, mesh, NEEDLE_RATIO);
        needles += shortest != CgalMesh::null_halfedge() &&
                   std::max<std::size_t>(mesh.source(shortest), mesh.target(shortest)) >= old_vertices;
    }
    return {degenerate, needles};
}

}  // namespace

Findings judge_by_cgal(const Fill& fill, CgalMeasures& measures) {
    Findings findings;
    const auto object = [&](const char* check, const std::string& text) { findings.push_back({check, text}); };

    if (!PMP::is_polygon_soup_a_polygon_mesh(fill.output.triangles) &&
        PMP::is_polygon_soup_a_polygon_mesh(fill.of->input.triangles))
        object("cgal-manifold", "the result is no polygon mesh, but the input was one");
    CgalMesh mesh;
    const std::vector<std::size_t> refused = build(fill.output, mesh);
    if (!refused.empty()) {
        object("cgal-manifold", "Surface_mesh refuses " + std::to_string(refused.size()) + " triangles, the first is " +
                                    std::to_string(refused.front()));
        return findings;
    }
    if (!CGAL::is_valid_polygon_mesh(mesh)) object("cgal-manifold", "not a valid polygon mesh");

    const bool is_promised_closed = std::all_of(fill.holes.begin(), fill.holes.end(), [](const Hole& h) { return h.filled; });
    measures.is_closed = CGAL::is_closed(mesh);
    if (is_promised_closed != measures.is_closed)
        object("cgal-closed", measures.is_closed ? "closed, though loops were to stay open" : "not closed");
    std::vector<CgalMesh::Halfedge_index> cycles;
    PMP::extract_boundary_cycles(mesh, std::back_inserter(cycles));
    const auto open = static_cast<std::size_t>(
        std::count_if(fill.holes.begin(), fill.holes.end(), [](const Hole& h) { return !h.filled; }));
    if (cycles.size() != open)
        object("cgal-boundaries", std::to_string(cycles.size()) + " boundaries instead of " + std::to_string(open));

    measures.intersections = count_intersections(fill, mesh);
    std::size_t reported = 0;
    for (const Hole& hole : fill.holes) reported += hole.self_intersections;
    if (measures.intersections > 0)
        object("cgal-intersections", std::to_string(measures.intersections) + " pairs of triangles intersect");
    if (measures.intersections != reported)
        object("cgal-count", std::to_string(measures.intersections) + " pairs of triangles intersect, the report says " +
                                 std::to_string(reported));

    const auto [degenerate, needles] = count_bad_shapes(fill, mesh);
    measures.needles = needles;
    if (degenerate > 0) object("cgal-degenerate", std::to_string(degenerate) + " new triangles have no area");
    if (needles > 0) object("cgal-needles", std::to_string(needles) + " needles that the rim does not force");

    if (measures.is_closed) {
        measures.volume = PMP::volume(mesh);
        if (!(measures.volume > 0.0)) object("cgal-volume", "the volume is " + std::to_string(measures.volume));
        if (!PMP::is_outward_oriented(mesh)) object("cgal-outward", "not oriented outwards");
    }
    return findings;
}

}  // namespace judge
