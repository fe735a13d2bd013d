// SPDX-License-Identifier: GPL-3.0-or-later
//
// CGAL's triangulation of a loop by the full search.

#include "cgal_mesh.h"
#include "weights.h"

#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

#include <iterator>

namespace judge {

std::vector<Triangle> search_by_cgal(const Loop& loop) {
    std::vector<Kernel::Point_3> points, apexes;
    for (const Point& p : loop.points) points.push_back(to_cgal(p));
    for (const Point& p : loop.apexes) apexes.push_back(to_cgal(p));
    std::vector<CGAL::Triple<int, int, int>> found;
    // Every option is set, because the default of the planar search differs from its documentation.
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        points, apexes, std::back_inserter(found),
        CGAL::parameters::use_delaunay_triangulation(false)
            .use_2d_constrained_delaunay_triangulation(false)
            .do_not_use_cubic_algorithm(false));
    std::vector<Triangle> triangles;
    for (const auto& t : found)
        triangles.push_back({static_cast<std::uint32_t>(t.first), static_cast<std::uint32_t>(t.second),
                             static_cast<std::uint32_t>(t.third)});
    return triangles;
}

}  // namespace judge
