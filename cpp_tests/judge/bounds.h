// Largest allowed distance between our patch and CGAL's, by case and method: distances.txt.
#ifndef HOLEFILL_JUDGE_BOUNDS_H
#define HOLEFILL_JUDGE_BOUNDS_H

#include <map>
#include <string>
#include <utility>

namespace judge {

class Bounds {
public:
    // Lines of case, method and bound. If `path` is empty, there are no bounds.
    explicit Bounds(const std::string& path);

    // What is wrong with this distance; empty if it is within its bound. A negative distance means that there is none.
    std::string check(const std::string& name, const std::string& method, double distance);

    // Writes bounds for the measured distances to distances.txt in `folder`. Does nothing if `folder` is empty.
    void write(const std::string& folder) const;

private:
    using Key = std::pair<std::string, std::string>;
    bool has_file_;
    std::map<Key, double> bounds_, measured_;
};

}  // namespace judge

#endif
