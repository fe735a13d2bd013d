// The weight of a triangulated loop, computed without either library.
#ifndef HOLEFILL_JUDGE_WEIGHTS_H
#define HOLEFILL_JUDGE_WEIGHTS_H

#include "model.h"

#include <optional>

namespace judge {

// A closed loop of points, and the apex of the triangle outside each edge (from a point to the next one); no apexes when
// nothing is known outside.
struct Loop {
    std::vector<Point> points, apexes;
};

struct Weight {
    // Largest angle between the normals of two triangles at an edge, in radians.
    double angle = 0.0;
    double area = 0.0;
};

// The weight of triangles over the positions of the loop, which run as it does; nothing when they do not span it: when an
// edge of the loop is not used once in its direction, or another edge not once in each.
std::optional<Weight> weigh(const Loop& loop, const std::vector<Triangle>& triangles);

#ifdef JUDGE_CGAL
// The triangulation by CGAL's cubic search; empty when there is none.
std::vector<Triangle> search_by_cgal(const Loop& loop);
#endif

}  // namespace judge

#endif
