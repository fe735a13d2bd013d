// SPDX-License-Identifier: GPL-3.0-or-later
#include "rim_edges.h"

#include <algorithm>
#include <tuple>

RimEdges::RimEdges(const holefill::Mesh& mesh) {
    for (const HolefillLoopInfo& loop : mesh.loops()) {
        const std::vector<uint64_t> vertices = mesh.loop_vertices(loop.loop_id);
        // An open chain has one edge less than vertices.
        for (uint64_t i = 0; i < loop.edge_count; ++i) {
            edges_.push_back({vertices[i], vertices[(i + 1) % vertices.size()], loop.loop_id});
        }
    }
    std::sort(edges_.begin(), edges_.end(),
              [](const Edge& a, const Edge& b) { return std::tie(a.from, a.to) < std::tie(b.from, b.to); });
}

int64_t RimEdges::loop(uint64_t from, uint64_t to) const {
    const auto place = std::lower_bound(
        edges_.begin(), edges_.end(), Edge{from, to, 0},
        [](const Edge& a, const Edge& b) { return std::tie(a.from, a.to) < std::tie(b.from, b.to); });
    const bool is_there = place != edges_.end() && place->from == from && place->to == to;
    return is_there ? static_cast<int64_t>(place->loop) : -1;
}
