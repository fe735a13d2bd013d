// Findings that are allowed, by name and with a reason: exceptions.txt.
#ifndef HOLEFILL_JUDGE_EXCEPTIONS_H
#define HOLEFILL_JUDGE_EXCEPTIONS_H

#include "model.h"

#include <map>
#include <string>
#include <tuple>

namespace judge {

// Allows what the file names; says afterwards what it names in vain.
class Exceptions {
public:
    // Throws std::runtime_error when a line has no reason or comes twice.
    explicit Exceptions(const std::string& path);

    // Whether the finding is allowed. It counts as seen then.
    bool allow(const std::string& name, const std::string& method, const std::string& check);

    // Exceptions for this case and method that were not seen.
    std::vector<std::string> unseen(const std::string& name, const std::string& method) const;

private:
    // Whether it was seen, by case, method and check.
    std::map<std::tuple<std::string, std::string, std::string>, bool> seen_;
};

}  // namespace judge

#endif
