// What the program does, by its first argument.
#ifndef HOLEFILL_JUDGE_COMMANDS_H
#define HOLEFILL_JUDGE_COMMANDS_H

#include <string>

namespace judge {

struct Arguments {
    // Public cases; need not exist.
    std::string cases;
    std::string exceptions;
    // Only cases whose name contains this.
    std::string only;
    // Bounds for distances to CGAL's patches; not bounded when empty.
    std::string bounds;
    // The meshes of CGAL's tests; need not exist.
    std::string data;
    // Where tables and pictures go; nowhere when empty.
    std::string output;
};

// Each returns whether all is well, and says on the standard output what it did and what is not.
bool run_cases(const Arguments& arguments);
bool run_mutations(const Arguments& arguments);
bool run_inputs(const Arguments& arguments);
// Puts the tables of the others into one page.
bool run_report(const Arguments& arguments);
#ifdef JUDGE_CGAL
bool run_weights(const Arguments& arguments);
bool run_fairing(const Arguments& arguments);
#endif

}  // namespace judge

#endif
