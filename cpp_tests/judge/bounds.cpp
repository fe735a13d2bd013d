#include "bounds.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace judge {

namespace {

// A bound is ROOM times the measured distance, and at least LEAST: where two triangulations are equally good, rounding
// chooses.
constexpr double ROOM = 2.0, LEAST = 0.02;
// Methods whose patches must be similar to CGAL's. The others have one bound for all cases.
constexpr const char* LIKE_CGAL[] = {"fair-c1", "fair-c2"};
// Means every case that is not listed.
constexpr const char* ANY = "*";

}  // namespace

Bounds::Bounds(const std::string& path) : has_file_(!path.empty()) {
    if (!has_file_) return;
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot open " + path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line.substr(0, line.find('#')));
        Key key;
        double bound = 0.0;
        if (!(words >> key.first)) continue;
        if (!(words >> key.second >> bound)) throw std::runtime_error("a bound without a number: " + line);
        bounds_[key] = bound;
    }
}

std::string Bounds::check(const std::string& name, const std::string& method, double distance) {
    if (distance < 0.0) return "";
    measured_[{name, method}] = distance;
    if (!has_file_) return "";
    auto bound = bounds_.find({name, method});
    if (bound == bounds_.end()) bound = bounds_.find({ANY, method});
    if (bound == bounds_.end()) return "no bound is set";
    if (distance <= bound->second) return "";
    std::ostringstream text;
    text << distance << " of the hole's diameter from CGAL's patch, the bound is " << bound->second;
    return text.str();
}

void Bounds::write(const std::string& folder) const {
    if (folder.empty()) return;
    std::ofstream file(folder + "/distances.txt");
    file << "# Largest distance between our patch and CGAL's, both ways, over the diameter of the largest hole: bounds.\n"
            "# Made by `judge cases --output FOLDER`: twice the measured distance, rounded up to two digits, and at least 0.02.\n"
            "# Methods without a counterpart in CGAL have one bound for all cases.\n";
    for (const auto& [key, bound] : bounds_)
        if (key.first == ANY) file << ANY << " " << key.second << " " << bound << "\n";
    for (const auto& [key, distance] : measured_) {
        if (std::find(std::begin(LIKE_CGAL), std::end(LIKE_CGAL), key.second) == std::end(LIKE_CGAL)) continue;
        const double roomy = std::max(ROOM * distance, LEAST);
        const double digit = std::pow(10.0, std::floor(std::log10(roomy)) - 1.0);
        file << key.first << " " << key.second << " " << std::setprecision(6) << std::ceil(roomy / digit) * digit << "\n";
    }
    file.close();
    if (!file) throw std::runtime_error("cannot write into " + folder);
}

}  // namespace judge
