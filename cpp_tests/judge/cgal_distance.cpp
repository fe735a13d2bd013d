// SPDX-License-Identifier: GPL-3.0-or-later
//
// Distances between surfaces, by CGAL's tree of boxes.

#include "cgal_mesh.h"
#include "peers.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>

#include <algorithm>
#include <vector>

namespace judge {

namespace {

using Facets = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Facets::iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

// The largest squared distance from points of `from` to the tree, and the mean square over the area.
std::pair<double, double> one_way(const Arrays& from, const Tree& tree) {
    double largest = 0.0, sum = 0.0, area = 0.0;
    for (const Triangle& t : from.triangles) {
        const Point &a = from.points[t[0]], &b = from.points[t[1]], &c = from.points[t[2]];
        const double weight = norm(area_vector(a, b, c));
        // Samples: corners, midpoints of sides, and centroid. This is exact for polynomials of degree three.
        const std::pair<Point, double> samples[] = {
            {a, 0.05}, {b, 0.05}, {c, 0.05}, {0.5 * (a + b), 2.0 / 15.0}, {0.5 * (b + c), 2.0 / 15.0},
            {0.5 * (c + a), 2.0 / 15.0}, {(1.0 / 3.0) * (a + b + c), 0.45}};
        for (const auto& [p, share] : samples) {
            const double d = tree.squared_distance(to_cgal(p));
            largest = std::max(largest, d);
            sum += weight * share * d;
        }
        area += weight;
    }
    return {largest, area > 0.0 ? sum / area : 0.0};
}

void add_facets(const Arrays& arrays, Facets& facets) {
    for (const Triangle& t : arrays.triangles) {
        const Kernel::Triangle_3 facet(to_cgal(arrays.points[t[0]]), to_cgal(arrays.points[t[1]]),
                                       to_cgal(arrays.points[t[2]]));
        if (!facet.is_degenerate()) facets.push_back(facet);
    }
}

}  // namespace

Distance distance_to(const Arrays& a, const Arrays& b) {
    Facets facets;
    add_facets(b, facets);
    const Tree tree(facets.begin(), facets.end());
    const auto [largest, square] = one_way(a, tree);
    return {std::sqrt(largest), std::sqrt(square)};
}

Distance distance(const Arrays& a, const Arrays& b) {
    Facets facets_a, facets_b;
    add_facets(a, facets_a);
    add_facets(b, facets_b);
    const Tree tree_a(facets_a.begin(), facets_a.end()), tree_b(facets_b.begin(), facets_b.end());
    const auto [largest_ab, square_ab] = one_way(a, tree_b);
    const auto [largest_ba, square_ba] = one_way(b, tree_a);
    return {std::sqrt(std::max(largest_ab, largest_ba)), std::sqrt(std::max(square_ab, square_ba))};
}

}  // namespace judge
