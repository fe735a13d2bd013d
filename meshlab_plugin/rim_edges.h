// SPDX-License-Identifier: GPL-3.0-or-later
/* Finds boundary edges of a mesh. */
#ifndef HOLEFILL_MESHLAB_RIM_EDGES_H
#define HOLEFILL_MESHLAB_RIM_EDGES_H

#include <holefill.hpp>

#include <cstdint>
#include <vector>

/* The boundary edges of a mesh, each with its loop. O(b log b) for b edges; a look-up is O(log b). */
class RimEdges {
public:
    explicit RimEdges(const holefill::Mesh& mesh);

    /* The loop of the boundary edge that runs in its triangle from one vertex to the other; -1 if there is no such
     * boundary edge. */
    int64_t loop(uint64_t from, uint64_t to) const;

private:
    struct Edge {
        uint64_t from, to, loop;
    };
    std::vector<Edge> edges_;
};

#endif
