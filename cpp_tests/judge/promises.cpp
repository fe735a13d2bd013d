#include "judges.h"
#include "topology.h"

#include <algorithm>
#include <cstring>
#include <set>

namespace judge {

namespace {

std::string edge_text(const Edge& e) { return std::to_string(e[0]) + "-" + std::to_string(e[1]); }

// The boundary that the report promises: that of the input without the filled loops.
std::vector<Edge> promised_boundary(const Fill& fill) {
    std::vector<Edge> closed, left;
    for (const Hole& hole : fill.holes) {
        if (!hole.filled) continue;
        for (std::size_t i = 0; i < hole.rim.size(); ++i)
            closed.push_back({hole.rim[i], hole.rim[(i + 1) % hole.rim.size()]});
    }
    std::sort(closed.begin(), closed.end());
    const std::vector<Edge> before = boundary_edges(fill.of->input.triangles);
    std::set_difference(before.begin(), before.end(), closed.begin(), closed.end(), std::back_inserter(left));
    return left;
}

}  // namespace

Findings judge_promises(const Fill& fill) {
    Findings findings;
    const auto object = [&](const char* check, const std::string& text) { findings.push_back({check, text}); };
    const Arrays &before = fill.of->input, &after = fill.output;
    const std::size_t n = before.points.size(), f = before.triangles.size();

    // The input is unchanged, bit for bit.
    if (after.points.size() < n || std::memcmp(after.points.data(), before.points.data(), n * sizeof(Point)) != 0)
        object("input-kept", "a vertex of the input has other bits");
    if (after.triangles.size() < f ||
        std::memcmp(after.triangles.data(), before.triangles.data(), f * sizeof(Triangle)) != 0)
        object("input-kept", "a triangle of the input has changed");
    if (!findings.empty()) return findings;

    // The report lists all new elements.
    std::size_t vertices = n, triangles = f;
    for (const Hole& hole : fill.holes) {
        if (!hole.filled && hole.vertex_count + hole.triangle_count > 0)
            object("report", "a hole that is not filled has a patch");
        if (hole.triangle_count > 0 && hole.first_triangle != triangles)
            object("report", "the triangles of a patch do not follow those before it");
        if (hole.vertex_count > 0 && hole.first_vertex != vertices)
            object("report", "the vertices of a patch do not follow those before it");
        vertices += hole.vertex_count;
        triangles += hole.triangle_count;
        if (!hole.filled && !hole.kept)
            object("filled", "the loop of " + std::to_string(hole.rim.size()) + " edges stays open: " + hole.reason);
    }
    if (vertices != after.points.size() || triangles != after.triangles.size())
        object("report", "the report does not account for everything that is new");
    const auto kept = static_cast<std::size_t>(
        std::count_if(fill.holes.begin(), fill.holes.end(), [](const Hole& h) { return h.kept; }));
    if (kept != fill.of->keep.size()) object("report", "other loops were kept than was asked");

    // New elements.
    std::vector<bool> used(after.points.size(), false);
    std::set<Triangle> sorted_new;
    for (std::size_t i = f; i < after.triangles.size(); ++i) {
        Triangle t = after.triangles[i];
        if (*std::max_element(t.begin(), t.end()) >= after.points.size()) {
            object("new-triangles", "a new triangle names a vertex that does not exist");
            return findings;
        }
        for (const std::uint32_t v : t) used[v] = true;
        std::sort(t.begin(), t.end());
        if (t[0] == t[1] || t[1] == t[2]) object("new-triangles", "a new triangle names a vertex twice");
        if (!sorted_new.insert(t).second) object("new-triangles", "two new triangles have the same corners");
    }
    for (std::size_t v = n; v < after.points.size(); ++v) {
        if (!used[v]) object("new-vertices", "a new vertex is in no triangle");
        for (const double x : after.points[v])
            if (!std::isfinite(x)) object("new-vertices", "a new vertex is not finite");
    }

    // The mesh is closed where promised, and open elsewhere.
    const std::vector<Edge> found = boundary_edges(after.triangles), promised = promised_boundary(fill);
    std::vector<Edge> difference;
    std::set_symmetric_difference(found.begin(), found.end(), promised.begin(), promised.end(),
                                  std::back_inserter(difference));
    if (!difference.empty())
        object("boundary", std::to_string(difference.size()) + " boundary edges differ from what was promised, " +
                               edge_text(difference.front()) + " for one");
    return findings;
}

}  // namespace judge
