// What CGAL makes of the same input, and how far two surfaces are apart.
#ifndef HOLEFILL_JUDGE_PEERS_H
#define HOLEFILL_JUDGE_PEERS_H

#include "model.h"

namespace judge {

// CGAL's hole filling of a case: triangulate, refine, fair, each hole by itself.
struct PeerFill {
    Arrays output;
    // Loops that were to be filled, and those that were.
    std::size_t holes = 0, filled = 0;
    // Of the filling alone.
    double seconds = 0.0;
    // Why there is nothing at all; empty otherwise.
    std::string failure;
};

// `continuity` 0, 1 or 2; below 0 the triangulation alone.
PeerFill fill_by_cgal(const Case& c, int continuity);

// Moves the vertices of `mesh` from `first` on by CGAL's fairing with its own weights. Says whether it did.
bool fair_by_cgal(Arrays& mesh, std::size_t first, unsigned continuity);

// How far two surfaces are apart, both ways, from points spread over every triangle.
struct Distance {
    double largest = 0.0, rms = 0.0;
};
Distance distance(const Arrays& a, const Arrays& b);
// From `a` to `b` only.
Distance distance_to(const Arrays& a, const Arrays& b);

}  // namespace judge

#endif
