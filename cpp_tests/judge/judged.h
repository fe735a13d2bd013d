// A fill with all that the judges say of it.
#ifndef HOLEFILL_JUDGE_JUDGED_H
#define HOLEFILL_JUDGE_JUDGED_H

#include "judges.h"

#include <functional>

namespace judge {

// The same order everywhere.
inline const std::vector<std::string>& methods() {
    static const std::vector<std::string> names{"flat", "fair-c1", "fair-c2", "hpde", "unfold-area", "mls", "auto"};
    return names;
}

struct Verdict {
    Findings findings;
#ifdef JUDGE_CGAL
    CgalMeasures cgal;
#endif
#ifdef JUDGE_OPENMESH
    OpenMeshMeasures openmesh;
#endif
};

// What every judge that was built says.
inline Verdict judge_all(const Fill& fill) {
    Verdict verdict;
    const auto take = [&](Findings findings) {
        verdict.findings.insert(verdict.findings.end(), findings.begin(), findings.end());
    };
    take(judge_promises(fill));
#ifdef JUDGE_CGAL
    take(judge_by_cgal(fill, verdict.cgal));
#endif
#ifdef JUDGE_OPENMESH
    take(judge_by_openmesh(fill, verdict.openmesh));
#endif
    return verdict;
}

// Calls `work(i)` for all i below `count`, some at the same time. What it throws is thrown again.
void in_parallel(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace judge

#endif
