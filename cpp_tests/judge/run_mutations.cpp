// Corrupts results. The judges must detect every corruption.
//
// If the numbers of the report would reveal a corruption, they are changed too.

#include "cases.h"
#include "commands.h"
#include "fill.h"
#include "judged.h"
#include "report.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <set>

namespace judge {

namespace {

using Random = std::mt19937_64;

// How far a vertex is pushed beyond the triangle, as a share of its distance to the triangle.
constexpr double PUSH = 0.05;

std::size_t pick(Random& random, std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

// The hole whose patch comes last; null if there is no patch.
Hole* last_patch(Fill& fill) {
    const auto at = std::find_if(fill.holes.rbegin(), fill.holes.rend(), [](const Hole& h) { return h.triangle_count > 0; });
    return at == fill.holes.rend() ? nullptr : &*at;
}

bool flip_patch_face(Fill& fill, Random& random) {
    const Hole* hole = last_patch(fill);
    if (!hole) return false;
    Triangle& t = fill.output.triangles[hole->first_triangle + pick(random, hole->triangle_count)];
    std::swap(t[1], t[2]);
    return true;
}

bool flip_input_face(Fill& fill, Random& random) {
    Triangle& t = fill.output.triangles[pick(random, fill.of->input.triangles.size())];
    std::swap(t[1], t[2]);
    return true;
}

bool move_input_vertex(Fill& fill, Random& random) {
    double& x = fill.output.points[pick(random, fill.of->input.points.size())][pick(random, 3)];
    x = std::nextafter(x, random() % 2 == 0 ? 1e300 : -1e300);
    return true;
}

bool drop_face(Fill& fill, Random& random) {
    Hole* hole = last_patch(fill);
    if (!hole) return false;
    const std::size_t f = hole->first_triangle + pick(random, hole->triangle_count);
    fill.output.triangles.erase(fill.output.triangles.begin() + static_cast<std::ptrdiff_t>(f));
    --hole->triangle_count;
    return true;
}

bool duplicate_face(Fill& fill, Random& random) {
    Hole* hole = last_patch(fill);
    if (!hole) return false;
    fill.output.triangles.push_back(fill.output.triangles[hole->first_triangle + pick(random, hole->triangle_count)]);
    ++hole->triangle_count;
    return true;
}

// Pushes a vertex of a patch through a triangle that is not near it in the mesh.
bool push_through(Fill& fill, Random& random) {
    const auto hole = std::find_if(fill.holes.begin(), fill.holes.end(), [](const Hole& h) { return h.vertex_count > 0; });
    if (hole == fill.holes.end()) return false;
    Arrays& mesh = fill.output;
    const auto v = static_cast<std::uint32_t>(hole->first_vertex + pick(random, hole->vertex_count));
    const auto has = [](const Triangle& t, std::uint32_t u) { return std::find(t.begin(), t.end(), u) != t.end(); };
    std::set<std::uint32_t> ring;
    for (const Triangle& t : mesh.triangles)
        if (has(t, v)) ring.insert(t.begin(), t.end());
    Point middle{};
    for (const std::uint32_t u : ring) middle = middle + (1.0 / static_cast<double>(ring.size())) * mesh.points[u];
    std::vector<const Triangle*> others;
    for (std::size_t f = hole->first_triangle; f < hole->first_triangle + hole->triangle_count; ++f) {
        const Triangle& t = mesh.triangles[f];
        if (std::none_of(t.begin(), t.end(), [&](std::uint32_t u) { return ring.count(u) > 0; })) others.push_back(&t);
    }
    if (others.empty()) return false;
    const Triangle& t = *others[pick(random, others.size())];
    const Point target = (1.0 / 3.0) * (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]);
    mesh.points[v] = target + PUSH * (target - middle);
    return true;
}

struct Mutation {
    const char* name;
    bool (*apply)(Fill&, Random&);
};
constexpr Mutation MUTATIONS[] = {
    {"flip a triangle of the patch", flip_patch_face}, {"flip a triangle of the input", flip_input_face},
    {"move a vertex of the input by one ulp", move_input_vertex}, {"drop a triangle of the patch", drop_face},
    {"duplicate a triangle of the patch", duplicate_face}, {"push a new vertex through the surface", push_through},
};

// The numbers of corruptions made, detected by any judge, and detected by each judge.
struct Tally {
    std::size_t made = 0, caught = 0;
    std::map<std::string, std::size_t> by;
};

// The judge that a check belongs to.
std::string judge_of(const std::string& check) {
    for (const char* name : {"cgal", "openmesh"})
        if (check.rfind(name, 0) == 0) return name;
    return "promises";
}

// The judges with findings about `fill` that they do not have about the correct result.
std::set<std::string> new_objectors(const Verdict& sound, const Fill& fill) {
    std::set<std::string> out;
    for (const Finding& finding : judge_all(fill).findings) {
        const auto same = [&](const Finding& f) { return f.check == finding.check && f.text == finding.text; };
        if (std::none_of(sound.findings.begin(), sound.findings.end(), same)) out.insert(judge_of(finding.check));
    }
    return out;
}

}  // namespace

bool run_mutations(const Arguments& arguments) {
    const std::vector<Case> generated = generated_cases();
    const std::vector<std::string> names = public_case_names(arguments.cases);
    std::map<std::string, Tally> tallies;
    std::mutex mutex;
    in_parallel(generated.size() + names.size(), [&](std::size_t i) {
        const bool is_public = i < names.size();
        const std::string& name = is_public ? names[i] : generated[i - names.size()].name;
        if (name.find(arguments.only) == std::string::npos) return;
        const Case c = is_public ? read_public_case(arguments.cases, name) : generated[i - names.size()];
        for (const std::string& method : methods()) {
            // Large public models are slow, so only one method is used there.
            if (is_public && method != methods()[i % methods().size()]) continue;
            const Fill sound = fill(c, method);
            const Verdict verdict = judge_all(sound);
            Random random(i);
            for (const Mutation& mutation : MUTATIONS) {
                Fill corrupt = sound;
                if (!mutation.apply(corrupt, random)) continue;
                const std::set<std::string> objectors = new_objectors(verdict, corrupt);
                const std::lock_guard<std::mutex> lock(mutex);
                Tally& tally = tallies[mutation.name];
                ++tally.made;
                tally.caught += !objectors.empty();
                for (const std::string& judge : objectors) ++tally.by[judge];
                if (objectors.empty()) {
                    std::printf("NOT CAUGHT %s %s: %s\n", name.c_str(), method.c_str(), mutation.name);
                    std::fflush(stdout);
                }
            }
        }
    });
    bool all = true;
    std::vector<std::vector<std::string>> rows;
    std::printf("%-40s %8s %8s %10s %8s %10s\n", "corruption", "made", "caught", "promises", "CGAL", "OpenMesh");
    for (const Mutation& mutation : MUTATIONS) {
        Tally& tally = tallies[mutation.name];
        std::printf("%-40s %8zu %8zu %10zu %8zu %10zu\n", mutation.name, tally.made, tally.caught, tally.by["promises"],
                    tally.by["cgal"], tally.by["openmesh"]);
        rows.push_back({mutation.name, std::to_string(tally.made), std::to_string(tally.caught),
                        std::to_string(tally.by["promises"]), std::to_string(tally.by["cgal"]),
                        std::to_string(tally.by["openmesh"])});
        all = all && tally.made > 0 && tally.caught == tally.made;
    }
    write_table(arguments.output, "mutations.md", {"corruption", "made", "caught", "by the promises", "by CGAL", "by OpenMesh"},
                rows);
    return all;
}

}  // namespace judge
