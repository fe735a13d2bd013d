// The meshes of CGAL's own tests of hole filling, and inputs that have no patch there.

#include "cases.h"
#include "commands.h"
#include "exceptions.h"
#include "fill.h"
#include "judged.h"
#include "report.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace judge {

namespace {

// The face that CGAL's test removes from its elephant for a hole of three edges. With a neighbor removed, the hole has
// four.
constexpr std::size_t REMOVED_FACE = 228;

// Files of CGAL's data: the file of the test, and others with holes.
constexpr const char* FILES[] = {"mech-holes-shark", "hole", "holes", "open_cube", "double-torus-3-holes", "elephant-with-holes"};

Case elephant(const Arrays& whole, bool is_quad) {
    Case c;
    c.name = is_quad ? "elephant_quad_hole" : "elephant_triangle_hole";
    c.input = whole;
    const Triangle removed = whole.triangles.at(REMOVED_FACE);
    const auto shares = [&](const Triangle& t) {
        return std::count_if(t.begin(), t.end(), [&](std::uint32_t v) {
            return std::find(removed.begin(), removed.end(), v) != removed.end();
        });
    };
    std::vector<Triangle>& triangles = c.input.triangles;
    triangles.erase(triangles.begin() + REMOVED_FACE);
    if (is_quad)
        triangles.erase(std::find_if(triangles.begin(), triangles.end(), [&](const Triangle& t) { return shares(t) == 2; }));
    return c;
}

// Two triangles whose four outer edges have no patch without new vertices. One diagonal is the common edge of the
// triangles; along the other, three vertices are on one line.
Case made_collinear() {
    Case c;
    c.name = "made_collinear";
    c.input.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
    c.input.triangles = {{0, 1, 3}, {1, 2, 3}};
    return c;
}

// Findings for an input that no patch can close: the library does not reject it with a reason, or makes a patch without
// reporting its intersections. The mesh must be as promised in each case.
Findings judge_refusal(const Fill& filled) {
    Findings findings;
    for (const Finding& finding : judge_promises(filled))
        if (finding.check != "filled") findings.push_back(finding);
    for (const Hole& hole : filled.holes) {
        if (!hole.filled && hole.reason.empty()) findings.push_back({"reason", "a hole is refused without a reason"});
        if (hole.filled && hole.self_intersections == 0) findings.push_back({"refusal", "filled, though nothing can"});
    }
    return findings;
}

}  // namespace

bool run_inputs(const Arguments& arguments) {
    Exceptions exceptions(arguments.exceptions);
    const Case refused = made_collinear();
    std::vector<Case> cases{refused};
    // For a rim that passes through a vertex twice, CGAL has no patch. For us it is two rims.
    for (const Case& c : generated_cases())
        if (c.name == "made_touching") cases.push_back(c);
    if (std::filesystem::is_directory(arguments.data)) {
        const Arrays whole = read_off(arguments.data + "/elephant.off");
        cases.push_back(elephant(whole, false));
        cases.push_back(elephant(whole, true));
        for (const char* file : FILES) cases.push_back({file, read_off(arguments.data + "/" + file + ".off"), {}, {}});
    } else {
        std::printf("SKIPPED: the meshes of CGAL's tests are missing\n");
    }
    std::size_t objections = 0, allowed = 0;
    std::vector<std::vector<std::string>> rows;
    for (const Case& c : cases) {
        for (const std::string& method : methods()) {
            const Fill filled = fill(c, method);
            std::vector<std::string> names;
            for (const Finding& finding : c.name == refused.name ? judge_refusal(filled) : judge_all(filled).findings) {
                const bool is_allowed = exceptions.allow(c.name, method, finding.check);
                ++(is_allowed ? allowed : objections);
                if (is_allowed) names.push_back(finding.check);
                std::printf("%s %s %s %s: %s\n", is_allowed ? "allowed  " : "OBJECTION", c.name.c_str(), method.c_str(),
                            finding.check.c_str(), finding.text.c_str());
            }
            for (const std::string& check : exceptions.unseen(c.name, method)) {
                ++objections;
                std::printf("OBJECTION %s %s %s: is listed as an exception, but does not happen\n", c.name.c_str(),
                            method.c_str(), check.c_str());
            }
            const auto closed = std::count_if(filled.holes.begin(), filled.holes.end(), [](const Hole& h) { return h.filled; });
            std::string list;
            for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
            rows.push_back({c.name, method, std::to_string(closed) + " of " + std::to_string(filled.holes.size()),
                            list.empty() ? "–" : list});
        }
    }
    write_table(arguments.output, "inputs.md", {"input", "method", "filled", "allowed"}, rows);
    std::printf("%zu inputs by %zu methods: %zu objections, %zu allowed by name\n", cases.size(), methods().size(),
                objections, allowed);
    return objections == 0;
}

}  // namespace judge
