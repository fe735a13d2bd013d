// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <cstdio>

namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::string count(uint64_t n, const char* one, const char* more) {
    return std::to_string(n) + " " + (n == 1 ? one : more);
}

const char* name(HolefillClass loop_class) {
    switch (loop_class) {
    case HOLEFILL_CLASS_SIMPLE:
        return "hole";
    case HOLEFILL_CLASS_TOUCHING:
        return "touches another";
    case HOLEFILL_CLASS_ISLAND:
        return "island";
    case HOLEFILL_CLASS_OUTER_RIM:
        return "outer rim";
    case HOLEFILL_CLASS_NOT_ORIENTED:
        return "mixed orientation";
    case HOLEFILL_CLASS_OPEN_CHAIN:
        return "open chain";
    default:
        return "other";
    }
}

} // namespace

std::vector<Line> describe(const HolefillDefects& defects) {
    std::vector<Line> lines;
    if (defects.nonmanifold_edges > 0) {
        lines.push_back({true, count(defects.nonmanifold_edges, "edge has", "edges have") +
                                   " more than two faces: holes that run into such an edge stay open"});
    }
    if (defects.inconsistent_edges > 0) {
        lines.push_back({true, count(defects.inconsistent_edges, "edge lies", "edges lie") +
                                   " between faces of different orientation: a hole stays open if the orientation "
                                   "changes along its rim"});
    }
    if (defects.degenerate_triangles > 0) {
        lines.push_back({true, count(defects.degenerate_triangles, "face uses", "faces use") + " a vertex twice"});
    }
    if (defects.duplicate_triangles > 0) {
        lines.push_back({true, count(defects.duplicate_triangles, "face occurs", "faces occur") + " more than once"});
    }
    return lines;
}

Line describe(const holefill::Hole& hole) {
    Line line;
    line.text = "Hole " + std::to_string(hole.loop_id) + " (" + count(hole.edge_count, "edge", "edges") + ", perimeter " +
                number(hole.perimeter) + ", at vertices " + std::to_string(hole.edge[0]) + " and " +
                std::to_string(hole.edge[1]) + "): ";
    switch (hole.status) {
    case HOLEFILL_HOLE_FILLED:
        line.text += std::string("filled by ") + (hole.method ? hole.method : "the hole round it") + ", " +
                     count(hole.triangle_count, "face", "faces") + ", " +
                     count(hole.vertex_count, "vertex", "vertices");
        if (hole.self_intersections > 0) {
            line.is_warning = true;
            line.text += ", " + count(hole.self_intersections, "pair of faces intersects", "pairs of faces intersect");
        }
        break;
    case HOLEFILL_HOLE_KEPT:
        line.text += "not chosen";
        break;
    default:
        line.is_warning = true;
        line.text += "stays open";
    }
    if (!hole.reason.empty()) {
        line.text += ": " + hole.reason;
    }
    for (const holefill::Attempt& attempt : hole.tried) {
        line.text += "; not by " + attempt.method + ": " + attempt.reason;
    }
    return line;
}

std::string table_head() { return "  hole   edges    perimeter     diameter  planarity  kind               at vertices"; }

std::string table_row(const HolefillLoopInfo& loop) {
    char text[160];
    std::snprintf(text, sizeof text, "%6llu  %6llu  %11.5g  %11.5g  %9.4f  %-17s  %llu, %llu",
                  static_cast<unsigned long long>(loop.loop_id), static_cast<unsigned long long>(loop.edge_count),
                  loop.perimeter, loop.diameter, loop.planarity, name(loop.loop_class),
                  static_cast<unsigned long long>(loop.edge[0]), static_cast<unsigned long long>(loop.edge[1]));
    return text;
}
