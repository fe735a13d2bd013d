#include "cases.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>

namespace judge {

namespace {

// The edges of the objects in the list `key`, as `"key": [{"edge": [0, 1], ...}, ...]`.
std::vector<Edge> edges_of(const std::string& json, const std::string& key) {
    const std::size_t start = json.find("\"" + key + "\"");
    if (start == std::string::npos) throw std::runtime_error("meta.json has no " + key);
    std::size_t end = json.find('[', start);
    for (int depth = 0; end < json.size(); ++end) {
        depth += json[end] == '[' ? 1 : json[end] == ']' ? -1 : 0;
        if (depth == 0) break;
    }
    const std::string list = json.substr(start, end - start);
    static const std::regex edge("\"edge\"\\s*:\\s*\\[\\s*(\\d+)\\s*,\\s*(\\d+)\\s*\\]");
    std::vector<Edge> edges;
    for (std::sregex_iterator i(list.begin(), list.end(), edge), last; i != last; ++i)
        edges.push_back({static_cast<std::uint32_t>(std::stoul((*i)[1])),
                         static_cast<std::uint32_t>(std::stoul((*i)[2]))});
    return edges;
}

}  // namespace

std::vector<std::string> public_case_names(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none))
        if (std::filesystem::is_regular_file(entry.path() / "input.ply"))
            names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

Case read_public_case(const std::string& folder, const std::string& name) {
    const std::filesystem::path path = std::filesystem::path(folder) / name;
    Case c;
    c.name = name;
    c.input = read_ply((path / "input.ply").string());
    if (std::filesystem::exists(path / "truth.ply")) c.truth = read_ply((path / "truth.ply").string());
    std::ifstream meta(path / "meta.json");
    c.keep = edges_of({std::istreambuf_iterator<char>(meta), std::istreambuf_iterator<char>()}, "keep_loops");
    return c;
}

}  // namespace judge
