// SPDX-License-Identifier: GPL-3.0-or-later
#include "rules.h"

#include "rim_edges.h"

#include <array>
#include <vector>

holefill::Selection to_selection(const Exchange& exchange, const Rules& rules) {
    holefill::Selection selection;
    selection.max_edges = rules.max_edges;
    selection.max_perimeter = rules.max_perimeter;
    selection.keep_largest = rules.keep_largest;
    if (!rules.touch_selection) {
        return selection;
    }
    const RimEdges rims(exchange.mesh());
    std::vector<bool> is_touched(static_cast<std::size_t>(exchange.mesh().loop_count()));
    for (const std::array<uint32_t, 3>& face : exchange.selected_faces()) {
        for (std::size_t k = 0; k < 3; ++k) {
            const int64_t loop = rims.loop(face[k], face[(k + 1) % 3]);
            if (loop >= 0) {
                is_touched[static_cast<std::size_t>(loop)] = true;
            }
        }
    }
    // Lists the loops to keep, not the loops to fill: an empty list of loops to fill means all loops.
    for (const HolefillLoopInfo& loop : exchange.mesh().loops()) {
        if (!is_touched[static_cast<std::size_t>(loop.loop_id)]) {
            selection.keep.push_back({loop.edge[0], loop.edge[1]});
        }
    }
    return selection;
}
