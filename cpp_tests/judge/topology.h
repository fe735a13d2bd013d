// Counts edges of triangle lists, without a mesh library.
#ifndef HOLEFILL_JUDGE_TOPOLOGY_H
#define HOLEFILL_JUDGE_TOPOLOGY_H

#include "model.h"

#include <cstdint>
#include <vector>

namespace judge {

// The directed edges of the triangles without a partner in the other direction, sorted, with repetitions.
std::vector<Edge> boundary_edges(const std::vector<Triangle>& triangles);

// Used vertices minus edges plus triangles.
long euler_characteristic(const Arrays& mesh);

std::size_t isolated_vertices(const Arrays& mesh);

// Indices, ascending, of the new triangles and of the input triangles near them: those with a common vertex, or whose
// bounding box meets that of the patch.
std::vector<std::size_t> patch_and_surroundings(const Fill& fill);

}  // namespace judge

#endif
