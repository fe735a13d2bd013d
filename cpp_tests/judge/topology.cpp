#include "topology.h"

#include <algorithm>
#include <limits>

namespace judge {

std::vector<Edge> boundary_edges(const std::vector<Triangle>& triangles) {
    // An edge with its lower vertex first, and its direction.
    struct Side {
        std::uint32_t low, high;
        bool descends;
    };
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), a > b});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i;
        long surplus = 0;
        for (; end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high; ++end)
            surplus += sides[end].descends ? -1 : 1;
        const Edge e = surplus > 0 ? Edge{sides[i].low, sides[i].high} : Edge{sides[i].high, sides[i].low};
        for (long k = 0; k < std::labs(surplus); ++k) edges.push_back(e);
        i = end;
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

long euler_characteristic(const Arrays& mesh) {
    std::vector<Edge> edges;
    std::vector<bool> used(mesh.points.size(), false);
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            used[t[k]] = true;
            edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
        }
    std::sort(edges.begin(), edges.end());
    const long edge_count = std::unique(edges.begin(), edges.end()) - edges.begin();
    return std::count(used.begin(), used.end(), true) - edge_count + static_cast<long>(mesh.triangles.size());
}

std::size_t isolated_vertices(const Arrays& mesh) {
    std::vector<bool> used(mesh.points.size(), false);
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) used[v] = true;
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
}

std::vector<std::size_t> patch_and_surroundings(const Fill& fill) {
    const Arrays& mesh = fill.output;
    const std::size_t old = fill.of->input.triangles.size();
    struct Box {
        Point low, high;
    };
    const auto box_of = [&](std::size_t first, std::size_t end) {
        constexpr double inf = std::numeric_limits<double>::infinity();
        Box box{{inf, inf, inf}, {-inf, -inf, -inf}};
        for (std::size_t f = first; f < end; ++f)
            for (const std::uint32_t v : mesh.triangles[f])
                for (std::size_t k = 0; k < 3; ++k) {
                    box.low[k] = std::min(box.low[k], mesh.points[v][k]);
                    box.high[k] = std::max(box.high[k], mesh.points[v][k]);
                }
        return box;
    };
    std::vector<Box> boxes;
    std::vector<bool> at_patch(mesh.points.size(), false);
    for (const Hole& hole : fill.holes)
        if (hole.triangle_count > 0)
            boxes.push_back(box_of(hole.first_triangle, hole.first_triangle + hole.triangle_count));
    for (std::size_t f = old; f < mesh.triangles.size(); ++f)
        for (const std::uint32_t v : mesh.triangles[f]) at_patch[v] = true;
    std::vector<std::size_t> near;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        bool is_near = f >= old || at_patch[t[0]] || at_patch[t[1]] || at_patch[t[2]];
        if (!is_near) {
            const Box box = box_of(f, f + 1);
            is_near = std::any_of(boxes.begin(), boxes.end(), [&](const Box& b) {
                for (std::size_t k = 0; k < 3; ++k)
                    if (b.low[k] > box.high[k] || box.low[k] > b.high[k]) return false;
                return true;
            });
        }
        if (is_near) near.push_back(f);
    }
    return near;
}

}  // namespace judge
