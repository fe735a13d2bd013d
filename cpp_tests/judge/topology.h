// Edges of triangle lists, counted without any mesh library.
#ifndef HOLEFILL_JUDGE_TOPOLOGY_H
#define HOLEFILL_JUDGE_TOPOLOGY_H

#include "model.h"

#include <cstdint>
#include <vector>

namespace judge {

// Every directed edge of the triangles that has no partner in the other direction, sorted; as often as it has none.
std::vector<Edge> boundary_edges(const std::vector<Triangle>& triangles);

// Vertices that are used minus edges plus triangles.
long euler_characteristic(const Arrays& mesh);

std::size_t isolated_vertices(const Arrays& mesh);

// New triangles, and those of the input that come near one: that share a vertex with it, or whose bounding box meets
// that of the patch. As indices, ascending.
std::vector<std::size_t> patch_and_surroundings(const Fill& fill);

}  // namespace judge

#endif
