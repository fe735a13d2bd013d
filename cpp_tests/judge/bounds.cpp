#include "bounds.h"

#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace judge {

namespace {

// Over the diameter of the hole: what is closer counts as equal.
constexpr double NEGLIGIBLE = 1e-9;
// What is written leaves so much room.
constexpr double ROOM = 1.25;

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
    const auto bound = bounds_.find({name, method});
    if (bound == bounds_.end()) return "no bound is set";
    if (distance <= bound->second + NEGLIGIBLE) return "";
    std::ostringstream text;
    text << distance << " of the hole's diameter from CGAL's patch, the bound is " << bound->second;
    return text.str();
}

void Bounds::write(const std::string& folder) const {
    if (folder.empty()) return;
    std::ofstream file(folder + "/distances.txt");
    file << "# Largest distance between our patch and CGAL's, both ways, over the diameter of the largest hole: bounds.\n"
            "# Made by `judge cases --output FOLDER`, with a quarter of room, in two digits rounded up.\n";
    for (const auto& [key, distance] : measured_) {
        const double roomy = ROOM * distance;
        const double digit = roomy > 0.0 ? std::pow(10.0, std::floor(std::log10(roomy)) - 1.0) : 1.0;
        file << key.first << " " << key.second << " " << std::setprecision(6) << std::ceil(roomy / digit) * digit << "\n";
    }
    file.close();
    if (!file) throw std::runtime_error("cannot write into " + folder);
}

}  // namespace judge
