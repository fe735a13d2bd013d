#include "exceptions.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace judge {

Exceptions::Exceptions(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot open " + path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line.substr(0, line.find('#')));
        std::string name, methods, checks, reason;
        if (!(words >> name)) continue;
        words >> methods >> checks;
        std::getline(words >> std::ws, reason);
        if (reason.empty()) throw std::runtime_error("an exception without a reason: " + line);
        std::istringstream method_list(methods);
        for (std::string method; std::getline(method_list, method, ',');) {
            std::istringstream check_list(checks);
            for (std::string check; std::getline(check_list, check, ',');)
                if (!seen_.emplace(std::make_tuple(name, method, check), false).second)
                    throw std::runtime_error("an exception comes twice: " + line);
        }
    }
}

bool Exceptions::allow(const std::string& name, const std::string& method, const std::string& check) {
    const auto at = seen_.find({name, method, check});
    if (at == seen_.end()) return false;
    at->second = true;
    return true;
}

std::vector<std::string> Exceptions::unseen(const std::string& name, const std::string& method) const {
    std::vector<std::string> out;
    for (const auto& [key, was_seen] : seen_)
        if (!was_seen && std::get<0>(key) == name && std::get<1>(key) == method) out.push_back(std::get<2>(key));
    return out;
}

}  // namespace judge
