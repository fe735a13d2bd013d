// The commands of the program: its first argument.
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
    // File of bounds for distances to CGAL's patches; no bounds if empty.
    std::string bounds;
    // The meshes of CGAL's tests; need not exist.
    std::string data;
    // Folder for tables and pictures; none are written if empty.
    std::string output;
};

// Each returns true if there are no objections, and prints its work and its objections on the standard output.
bool run_cases(const Arguments& arguments);
bool run_mutations(const Arguments& arguments);
bool run_inputs(const Arguments& arguments);
// Writes the tables of the other commands to one page.
bool run_report(const Arguments& arguments);
#ifdef JUDGE_CGAL
bool run_weights(const Arguments& arguments);
bool run_fairing(const Arguments& arguments);
#endif

}  // namespace judge

#endif
