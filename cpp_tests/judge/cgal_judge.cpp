// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checks a filled mesh with CGAL's predicates.

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
#include <array>

namespace PMP = CGAL::Polygon_mesh_processing;

namespace judge {

namespace {

// A triangle is a needle if its longest edge is at least this many times its shortest.
constexpr double NEEDLE_RATIO = 20.0;

// Whether two triangles intersect in more than corners at the same place. CGAL's predicate for faces recognizes common
// corners only by their vertices. So where a surface touches itself in two vertices at one place, it counts all pairs
// of faces there.
bool intersect_beside_common_places(const CgalMesh& mesh, CgalMesh::Face_index f, CgalMesh::Face_index g) {
    using Corners = std::array<Kernel::Point_3, 3>;
    const auto corners_of = [&](CgalMesh::Face_index face) {
        const CgalMesh::Halfedge_index h = mesh.halfedge(face);
        return Corners{mesh.point(mesh.source(h)), mesh.point(mesh.target(h)), mesh.point(mesh.target(mesh.next(h)))};
    };
    Corners a = corners_of(f), b = corners_of(g);
    // Common corners come first, in the same order.
    std::size_t common = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto same = std::find(b.begin() + static_cast<std::ptrdiff_t>(common), b.end(), a[i]);
        if (same == b.end()) continue;
        std::swap(a[common], a[i]);
        std::iter_swap(b.begin() + static_cast<std::ptrdiff_t>(common), same);
        ++common;
    }
    const Kernel::Triangle_3 first(a[0], a[1], a[2]), second(b[0], b[1], b[2]);
    switch (common) {
    case 0:
        return CGAL::do_intersect(first, second);
    case 1:
        return CGAL::do_intersect(first, Kernel::Segment_3(b[1], b[2])) ||
               CGAL::do_intersect(second, Kernel::Segment_3(a[1], a[2]));
    case 2:
        return CGAL::coplanar(a[0], a[1], a[2], b[2]) &&
               CGAL::coplanar_orientation(a[0], a[1], a[2], b[2]) == CGAL::POSITIVE;
    default:
        return true;
    }
}

// The number of pairs of triangles that intersect, one of them new.
std::size_t count_intersections(const Fill& fill, const CgalMesh& mesh, const Faces& face_of) {
    Faces faces;
    for (const std::size_t f : patch_and_surroundings(fill)) faces.push_back(face_of[f]);
    std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> pairs;
    PMP::self_intersections<CGAL::Sequential_tag>(faces, mesh, std::back_inserter(pairs));
    std::vector<bool> is_new(mesh.number_of_faces(), false);
    for (std::size_t f = fill.of->input.triangles.size(); f < face_of.size(); ++f) is_new[face_of[f]] = true;
    return static_cast<std::size_t>(std::count_if(pairs.begin(), pairs.end(), [&](const auto& p) {
        return (is_new[p.first] || is_new[p.second]) && intersect_beside_common_places(mesh, p.first, p.second);
    }));
}

// Six times the volume of the cone over the triangles, with its tip in the middle of the vertices. It is negative if an
// open mesh is inside out.
double lean(const Arrays& mesh) {
    Point middle{};
    for (const Point& p : mesh.points) middle = middle + (1.0 / static_cast<double>(mesh.points.size())) * p;
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles)
        sum += dot(mesh.points[t[0]] - middle, area_vector(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]));
    return sum;
}

// New triangles without area, and needles. If the shortest edge of a needle joins two vertices of the input, the rim
// forces the needle.
std::pair<std::size_t, std::size_t> count_bad_shapes(const Fill& fill, const CgalMesh& mesh, const Faces& face_of) {
    const std::size_t old_vertices = fill.of->input.points.size();
    std::size_t degenerate = 0, needles = 0;
    for (std::size_t f = fill.of->input.triangles.size(); f < face_of.size(); ++f) {
        const CgalMesh::Face_index face = face_of[f];
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

std::size_t count_intersections_by_cgal(const Case& c, const Arrays& output) {
    const std::size_t old = c.input.triangles.size();
    if (output.triangles.size() <= old) return 0;
    Fill fill{&c, "", output, {}, 0.0};
    Hole whole;
    whole.first_triangle = old;
    whole.triangle_count = output.triangles.size() - old;
    fill.holes.push_back(whole);
    CgalMesh mesh;
    const Faces face_of = build(output, mesh);
    return refused(face_of).empty() ? count_intersections(fill, mesh, face_of) : 0;
}

Findings judge_by_cgal(const Fill& fill, CgalMeasures& measures) {
    Findings findings;
    const auto object = [&](const char* check, const std::string& text) { findings.push_back({check, text}); };

    if (!PMP::is_polygon_soup_a_polygon_mesh(fill.output.triangles) &&
        PMP::is_polygon_soup_a_polygon_mesh(fill.of->input.triangles))
        object("cgal-manifold", "the result is no polygon mesh, but the input was one");
    CgalMesh mesh;
    const Faces face_of = build(fill.output, mesh);
    if (const std::vector<std::size_t> without = refused(face_of); !without.empty()) {
        object("cgal-manifold", "Surface_mesh refuses " + std::to_string(without.size()) + " triangles, the first is " +
                                    std::to_string(without.front()));
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

    measures.intersections = count_intersections(fill, mesh, face_of);
    std::size_t reported = 0;
    for (const Hole& hole : fill.holes) reported += hole.self_intersections;
    if (measures.intersections > 0)
        object("cgal-intersections", std::to_string(measures.intersections) + " pairs of triangles intersect");
    if (measures.intersections != reported)
        object("cgal-count", std::to_string(measures.intersections) + " pairs of triangles intersect, the report says " +
                                 std::to_string(reported));

    const auto [degenerate, needles] = count_bad_shapes(fill, mesh, face_of);
    measures.needles = needles;
    if (degenerate > 0) object("cgal-degenerate", std::to_string(degenerate) + " new triangles have no area");
    if (needles > 0) object("cgal-needles", std::to_string(needles) + " needles that the rim does not force");

    if (measures.is_closed) {
        measures.volume = PMP::volume(mesh);
        const bool is_outward = lean(fill.of->input) > 0.0;
        if (!(is_outward ? measures.volume > 0.0 : measures.volume < 0.0))
            object("cgal-volume", "the volume is " + std::to_string(measures.volume));
        if (PMP::is_outward_oriented(mesh) != is_outward) object("cgal-outward", "not oriented as the input is");
    }
    return findings;
}

}  // namespace judge
