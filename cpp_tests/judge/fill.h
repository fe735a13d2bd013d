// Calls our library through its C++ header.
#ifndef HOLEFILL_JUDGE_FILL_H
#define HOLEFILL_JUDGE_FILL_H

#include "model.h"

#include <utility>

namespace judge {

// Parameters by name and value.
using Settings = std::vector<std::pair<std::string, std::string>>;

// Fills all loops of the case, except those to keep. Throws if the call itself fails.
Fill fill(const Case& c, const std::string& method, const Settings& settings = {});

// The triangulation of least weight, by the exact search only: of a closed polyline, as positions in it, or of the loop
// of a mesh through `edge`, as vertices of the mesh. Empty if there is none.
std::vector<Triangle> search_polyline(const std::vector<Point>& points);
std::vector<Triangle> search_loop(const Arrays& mesh, const Edge& edge);

// The vertices of all loops of a mesh, each in the direction of its triangles.
std::vector<std::vector<std::uint32_t>> loops(const Arrays& mesh);

}  // namespace judge

#endif
