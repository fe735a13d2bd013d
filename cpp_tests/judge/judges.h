// The judges. Each looks at a fill by itself and says what speaks against it.
#ifndef HOLEFILL_JUDGE_JUDGES_H
#define HOLEFILL_JUDGE_JUDGES_H

#include "model.h"

namespace judge {

// What the library promises, compared with what it returned; no mesh library has a part in it.
Findings judge_promises(const Fill& fill);

#ifdef JUDGE_CGAL
// What CGAL measured besides its findings.
struct CgalMeasures {
    bool is_closed = false;
    // 0 unless it is closed.
    double volume = 0.0;
    std::size_t intersections = 0, needles = 0;
};
Findings judge_by_cgal(const Fill& fill, CgalMeasures& measures);
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
