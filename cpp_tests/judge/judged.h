// A fill with the findings of all judges.
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

// The findings of all judges that were built.
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

// Calls `work(i)` for all i below `count`, some in parallel. Exceptions of `work` are thrown again.
void in_parallel(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace judge

#endif
