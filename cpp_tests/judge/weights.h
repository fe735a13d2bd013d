// Computes the weight of a triangulated loop, without the two libraries.
#ifndef HOLEFILL_JUDGE_WEIGHTS_H
#define HOLEFILL_JUDGE_WEIGHTS_H

#include "model.h"

#include <optional>

namespace judge {

// A closed loop of points, and the apex of the triangle outside each edge (from a point to the next one). There are no
// apexes if there are no triangles outside.
struct Loop {
    std::vector<Point> points, apexes;
};

struct Weight {
    // Largest angle between the normals of two triangles at an edge, in radians.
    double angle = 0.0;
    double area = 0.0;
};

// The weight of triangles over the positions of the loop, in its direction. No value if they do not span it: if an edge
// of the loop is not used once in its direction, or another edge is not used once in each direction.
std::optional<Weight> weigh(const Loop& loop, const std::vector<Triangle>& triangles);

#ifdef JUDGE_CGAL
// The triangulation by CGAL's cubic search; empty if there is none.
std::vector<Triangle> search_by_cgal(const Loop& loop);
#endif

}  // namespace judge

#endif
