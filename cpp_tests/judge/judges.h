// The judges. Each checks a fill independently and returns its findings.
#ifndef HOLEFILL_JUDGE_JUDGES_H
#define HOLEFILL_JUDGE_JUDGES_H

#include "model.h"

namespace judge {

// Compares the result with the promises of the library. Uses no mesh library.
Findings judge_promises(const Fill& fill);

#ifdef JUDGE_CGAL
// Figures that CGAL measures besides its findings.
struct CgalMeasures {
    bool is_closed = false;
    // 0 unless the mesh is closed.
    double volume = 0.0;
    std::size_t intersections = 0, needles = 0;
};
Findings judge_by_cgal(const Fill& fill, CgalMeasures& measures);

// The number of pairs of intersecting triangles, at least one of them new, in any filling of the case.
std::size_t count_intersections_by_cgal(const Case& c, const Arrays& output);
#endif

#ifdef JUDGE_OPENMESH
struct OpenMeshMeasures {
    std::size_t least_valence = 0, largest_valence = 0;
    double mean_valence = 0.0;
};
Findings judge_by_openmesh(const Fill& fill, OpenMeshMeasures& measures);
#endif

}  // namespace judge

#endif
