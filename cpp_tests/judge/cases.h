// The cases: real and published models if they are available, and meshes made in code.
#ifndef HOLEFILL_JUDGE_CASES_H
#define HOLEFILL_JUDGE_CASES_H

#include "model.h"

#include <vector>

namespace judge {

// Surfaces with known holes: the same in every run.
std::vector<Case> generated_cases();

// The cases below `folder`, by name. Each is a folder with `input.ply`, `meta.json` and optionally `truth.ply`.
// Empty if there is no such folder.
std::vector<std::string> public_case_names(const std::string& folder);
Case read_public_case(const std::string& folder, const std::string& name);

}  // namespace judge

#endif
