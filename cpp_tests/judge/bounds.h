// How far our patch and CGAL's may be apart, by case and method: distances.txt.
#ifndef HOLEFILL_JUDGE_BOUNDS_H
#define HOLEFILL_JUDGE_BOUNDS_H

#include <map>
#include <string>
#include <utility>

namespace judge {

class Bounds {
public:
    // Lines of case, method and bound. No file when `path` is empty: nothing is bounded then.
    explicit Bounds(const std::string& path);

    // What is wrong with this distance; empty when it is within its bound. Negative: there is none.
    std::string check(const std::string& name, const std::string& method, double distance);

    // Writes bounds for what was measured to distances.txt in `folder`; nothing when that is empty.
    void write(const std::string& folder) const;

private:
    using Key = std::pair<std::string, std::string>;
    bool has_file_;
    std::map<Key, double> bounds_, measured_;
};

}  // namespace judge

#endif
