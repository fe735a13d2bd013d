// CGAL's filling of the same input, and the distance of two surfaces.
#ifndef HOLEFILL_JUDGE_PEERS_H
#define HOLEFILL_JUDGE_PEERS_H

#include "model.h"

namespace judge {

// CGAL's hole filling of a case: triangulate, refine, fair, for each hole separately.
struct PeerFill {
    Arrays output;
    // Numbers of loops to fill, and of loops filled.
    std::size_t holes = 0, filled = 0;
    // Time of the filling alone.
    double seconds = 0.0;
    // The reason if there is no result; empty otherwise.
    std::string failure;
};

// `continuity` is 0, 1 or 2; below 0, only the triangulation.
PeerFill fill_by_cgal(const Case& c, int continuity);

// Moves the vertices of `mesh` from `first` on by CGAL's fairing with its own weights. Returns false if that fails.
bool fair_by_cgal(Arrays& mesh, std::size_t first, unsigned continuity);

// Two-way distances of two surfaces, from samples in every triangle.
struct Distance {
    double largest = 0.0, rms = 0.0;
};
Distance distance(const Arrays& a, const Arrays& b);
// From `a` to `b` only.
Distance distance_to(const Arrays& a, const Arrays& b);

}  // namespace judge

#endif
