#include "weights.h"

#include <algorithm>
#include <map>

namespace judge {

std::optional<Weight> weigh(const Loop& loop, const std::vector<Triangle>& triangles) {
    const auto m = static_cast<std::uint32_t>(loop.points.size());
    if (triangles.size() + 2 != m) return std::nullopt;
    const auto unit_normal = [](const Point& a, const Point& b, const Point& c) {
        const Point n = area_vector(a, b, c);
        return (1.0 / norm(n)) * n;
    };
    // The normal on the left of each directed edge.
    std::map<Edge, Point> sides;
    Weight weight;
    for (const Triangle& t : triangles) {
        for (const std::uint32_t v : t)
            if (v >= m) return std::nullopt;
        const Point &a = loop.points[t[0]], &b = loop.points[t[1]], &c = loop.points[t[2]];
        weight.area += 0.5 * norm(area_vector(a, b, c));
        const Point normal = unit_normal(a, b, c);
        for (std::size_t k = 0; k < 3; ++k)
            if (!sides.emplace(Edge{t[k], t[(k + 1) % 3]}, normal).second) return std::nullopt;
    }
    // Twice the arc tangent is accurate near 0 and near a half turn.
    const auto turn = [&](const Point& p, const Point& q) {
        weight.angle = std::max(weight.angle, 2.0 * std::atan2(norm(p - q), norm(p + q)));
    };
    std::size_t rim = 0;
    for (const auto& [edge, normal] : sides) {
        const auto across = sides.find({edge[1], edge[0]});
        const bool is_rim = (edge[0] + 1) % m == edge[1];
        if (is_rim == (across != sides.end())) return std::nullopt;
        if (!is_rim) {
            turn(normal, across->second);
            continue;
        }
        ++rim;
        if (!loop.apexes.empty())
            turn(normal, unit_normal(loop.points[edge[1]], loop.points[edge[0]], loop.apexes[edge[0]]));
    }
    if (rim != m) return std::nullopt;
    return weight;
}

}  // namespace judge
