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
    // Where tables and pictures go; nowhere when empty.
    std::string output;
};

// Each returns whether all is well, and says on the standard output what it did and what is not.
bool run_cases(const Arguments& arguments);
bool run_mutations(const Arguments& arguments);
#ifdef JUDGE_CGAL
bool run_weights(const Arguments& arguments);
#endif

}  // namespace judge

#endif
