// Allowed findings, each with a reason: exceptions.txt.
#ifndef HOLEFILL_JUDGE_EXCEPTIONS_H
#define HOLEFILL_JUDGE_EXCEPTIONS_H

#include "model.h"

#include <map>
#include <string>
#include <tuple>

namespace judge {

// The check of `judge fairing`; all others are made by `judge cases` and `judge inputs`.
inline const std::string FAIRING = "fairing";

// Allows the findings that the file names, and lists those that did not occur.
class Exceptions {
public:
    // Throws std::runtime_error if a line has no reason or occurs twice.
    explicit Exceptions(const std::string& path);

    // Whether the finding is allowed. An allowed finding counts as seen.
    bool allow(const std::string& name, const std::string& method, const std::string& check);

    // Checks that are excepted for this case and method but were not seen: either only fairing, or all others.
    std::vector<std::string> unseen(const std::string& name, const std::string& method,
                                    bool is_fairing = false) const;

private:
    // Whether it was seen, by case, method and check.
    std::map<std::tuple<std::string, std::string, std::string>, bool> seen_;
};

}  // namespace judge

#endif
