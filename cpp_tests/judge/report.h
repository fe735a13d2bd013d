// Tables and pictures of a run.
#ifndef HOLEFILL_JUDGE_REPORT_H
#define HOLEFILL_JUDGE_REPORT_H

#include <string>
#include <vector>

namespace judge {

// A number with three digits: 0.0123, 1.2e-05.
std::string scientific(double value);

// Writes a table in Markdown. Throws std::runtime_error if that fails. Does nothing if `folder` is empty.
void write_table(const std::string& folder, const std::string& file, const std::vector<std::string>& head,
                 const std::vector<std::vector<std::string>>& rows);

}  // namespace judge

#endif
