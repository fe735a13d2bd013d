// Compares our fairing with CGAL's, vertex by vertex, on the same refined patch.

#include "cases.h"
#include "commands.h"
#include "exceptions.h"
#include "fill.h"
#include "judged.h"
#include "peers.h"
#include "report.h"
#include "topology.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <mutex>
#include <set>

namespace judge {

namespace {

// Largest distance of a vertex, over the diameter of its hole.
constexpr double TOLERANCE = 1e-6;
// Number of holes of one case; the largest are taken.
constexpr std::size_t HOLES_OF_A_CASE = 3;
// Largest number of new vertices of a hole. The condition number of the equations of the sixth order grows with its
// third power. With 2,000 vertices, rounding alone makes the two solvers differ by the tolerance.
constexpr std::size_t MOST_VERTICES = 1500;
// Energies and distances count as different if they differ by more than this share.
constexpr double SAME = 1e-3;
// Rings of triangles that are copied round a patch. Fairing of the highest order reads two.
constexpr std::uint32_t RINGS = 3;

constexpr std::size_t ORDERS = 3;
constexpr const char* METHODS[ORDERS] = {"membrane", "fair-c1", "fair-c2"};

// A patch with the mesh round it; new vertices come last.
struct Local {
    Arrays mesh;
    std::size_t first_new = 0;
    // The number of each new vertex in the filled mesh.
    std::vector<std::uint32_t> numbers;
    // The rim, as vertices of `mesh`.
    std::vector<std::uint32_t> rim;
    // Whether the rings that fairing reads are complete.
    bool is_surrounded = true;
};

Local cut_out(const Fill& fill, const Hole& hole) {
    const Case& c = *fill.of;
    constexpr std::uint32_t FAR = 1000;
    std::vector<std::uint32_t> level(c.input.points.size(), FAR);
    for (const std::uint32_t v : hole.rim) level[v] = 0;
    std::vector<Triangle> around;
    for (std::uint32_t ring = 1; ring <= RINGS; ++ring) {
        std::vector<std::uint32_t> reached;
        for (const Triangle& t : c.input.triangles)
            if (std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return level[v] < ring; }))
                for (const std::uint32_t v : t)
                    if (level[v] == FAR) reached.push_back(v);
        for (const std::uint32_t v : reached) level[v] = ring;
    }
    Local local;
    for (const Triangle& t : c.input.triangles)
        if (std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return level[v] < RINGS; })) around.push_back(t);
    std::set<Edge> rim;
    for (std::size_t i = 0; i < hole.rim.size(); ++i) rim.insert({hole.rim[i], hole.rim[(i + 1) % hole.rim.size()]});
    for (const Edge& e : boundary_edges(around))
        if (rim.count(e) == 0 && std::min(level[e[0]], level[e[1]]) < RINGS) local.is_surrounded = false;

    std::map<std::uint32_t, std::uint32_t> numbers;
    const auto number = [&](std::uint32_t v) {
        const auto [at, is_new] = numbers.emplace(v, static_cast<std::uint32_t>(local.mesh.points.size()));
        if (is_new) local.mesh.points.push_back(fill.output.points[v]);
        return at->second;
    };
    const auto renumbered = [&](const Triangle& t) { return Triangle{number(t[0]), number(t[1]), number(t[2])}; };
    for (const Triangle& t : around) local.mesh.triangles.push_back(renumbered(t));
    local.first_new = local.mesh.points.size();
    for (std::size_t v = hole.first_vertex; v < hole.first_vertex + hole.vertex_count; ++v) {
        local.numbers.push_back(static_cast<std::uint32_t>(v));
        number(static_cast<std::uint32_t>(v));
    }
    for (std::size_t f = hole.first_triangle; f < hole.first_triangle + hole.triangle_count; ++f)
        local.mesh.triangles.push_back(renumbered(fill.output.triangles[f]));
    for (const std::uint32_t v : hole.rim) local.rim.push_back(number(v));
    return local;
}

Arrays with_points_of(const Local& local, const Fill& fill) {
    Arrays mesh = local.mesh;
    for (std::size_t i = 0; i < local.numbers.size(); ++i)
        mesh.points[local.first_new + i] = fill.output.points[local.numbers[i]];
    return mesh;
}

Arrays patch_of(const Arrays& mesh, std::size_t first_new) {
    Arrays patch{mesh.points, {}};
    for (const Triangle& t : mesh.triangles)
        if (*std::max_element(t.begin(), t.end()) >= first_new) patch.triangles.push_back(t);
    return patch;
}

// The energy of order 1 (area), 2 (squared mean curvature) or 3 (squared slope of the mean curvature) of the surface,
// over the patch and its rim, with cotangents and thirds of areas.
double energy(const Local& local, const Arrays& mesh, std::size_t order) {
    std::vector<Point> laplacian(mesh.points.size(), Point{});
    std::vector<double> area(mesh.points.size(), 0.0);
    const auto each_edge = [&](auto&& visit) {
        for (const Triangle& t : mesh.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const Point &p = mesh.points[t[k]], &a = mesh.points[t[(k + 1) % 3]], &b = mesh.points[t[(k + 2) % 3]];
                const double doubled = norm(area_vector(p, a, b));
                if (doubled > 0.0) visit(t[(k + 1) % 3], t[(k + 2) % 3], 0.5 * dot(a - p, b - p) / doubled);
            }
    };
    double total = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const double third = norm(area_vector(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]])) / 6.0;
        for (const std::uint32_t v : t) area[v] += third;
        if (*std::max_element(t.begin(), t.end()) >= local.first_new) total += 3.0 * third;
    }
    if (order == 1) return total;
    each_edge([&](std::uint32_t a, std::uint32_t b, double w) {
        laplacian[a] = laplacian[a] + w * (mesh.points[b] - mesh.points[a]);
        laplacian[b] = laplacian[b] + w * (mesh.points[a] - mesh.points[b]);
    });
    std::vector<bool> is_summed(mesh.points.size(), false);
    for (std::size_t v = local.first_new; v < mesh.points.size(); ++v) is_summed[v] = true;
    for (const std::uint32_t v : local.rim) is_summed[v] = true;
    total = 0.0;
    if (order == 2) {
        for (std::size_t v = 0; v < mesh.points.size(); ++v)
            if (is_summed[v] && area[v] > 0.0) total += dot(laplacian[v], laplacian[v]) / area[v];
        return total;
    }
    each_edge([&](std::uint32_t a, std::uint32_t b, double w) {
        if (!is_summed[a] && !is_summed[b]) return;
        const Point jump = (1.0 / area[a]) * laplacian[a] - (1.0 / area[b]) * laplacian[b];
        total += std::max(w, 0.0) * dot(jump, jump);
    });
    return total;
}

// Results for one method.
struct Tally {
    std::size_t compared = 0, within = 0, not_faired = 0;
    double largest = 0.0;
    // With the default weights: distances to CGAL's vertices, and which of the two is better.
    double largest_default = 0.0, sum_default = 0.0;
    std::array<std::size_t, 3> energy{}, truth{};
};

// 0, 1, 2: the first is smaller, both are the same, the second is smaller.
std::size_t smaller(double a, double b) {
    if (std::abs(a - b) <= SAME * std::max(std::abs(a), std::abs(b))) return 1;
    return a < b ? 0 : 2;
}

std::string counts(const std::array<std::size_t, 3>& c) {
    return std::to_string(c[0]) + " / " + std::to_string(c[1]) + " / " + std::to_string(c[2]);
}

}  // namespace

bool run_fairing(const Arguments& arguments) {
    Exceptions exceptions(arguments.exceptions);
    const std::vector<Case> generated = generated_cases();
    const std::vector<std::string> names = public_case_names(arguments.cases);
    Tally tallies[ORDERS];
    std::vector<std::vector<std::string>> rows;
    std::mutex mutex;
    bool all = true;
    in_parallel(generated.size() + names.size(), [&](std::size_t i) {
        const bool is_public = i < names.size();
        const std::string& name = is_public ? names[i] : generated[i - names.size()].name;
        if (name.find(arguments.only) == std::string::npos) return;
        const Case c = is_public ? read_public_case(arguments.cases, name) : generated[i - names.size()];
        for (std::size_t k = 0; k < ORDERS; ++k) {
            const Settings alone{{"fill.fallback", "off"}, {"fill.join-islands", "off"}, {"fair.weights", "voronoi"}};
            const auto with_passes = [&](Settings settings, const char* passes) {
                settings.emplace_back("fair.passes", passes);
                return fill(c, METHODS[k], settings);
            };
            const Fill start = with_passes(alone, "0"), ours = with_passes(alone, "1"),
                       by_default = fill(c, METHODS[k], {{"fill.fallback", "off"}, {"fill.join-islands", "off"}});
            std::vector<std::size_t> holes;
            for (std::size_t h = 0; h < start.holes.size(); ++h) {
                const Hole &a = start.holes[h], &b = ours.holes[h], &d = by_default.holes[h];
                const bool is_same = a.filled && b.filled && d.filled && a.vertex_count == b.vertex_count &&
                                     a.vertex_count == d.vertex_count && a.triangle_count == b.triangle_count &&
                                     a.first_vertex == b.first_vertex && a.first_vertex == d.first_vertex;
                if (is_same && a.vertex_count > 0 && a.vertex_count <= MOST_VERTICES) holes.push_back(h);
            }
            std::sort(holes.begin(), holes.end(), [&](std::size_t a, std::size_t b) {
                return start.holes[a].vertex_count > start.holes[b].vertex_count;
            });
            std::size_t taken = 0;
            for (const std::size_t h : holes) {
                if (taken == HOLES_OF_A_CASE) break;
                const Local local = cut_out(start, start.holes[h]);
                if (!local.is_surrounded) continue;
                ++taken;
                Arrays theirs = local.mesh;
                const bool is_faired = fair_by_cgal(theirs, local.first_new, static_cast<unsigned>(k));
                const Arrays our_mesh = with_points_of(local, ours), default_mesh = with_points_of(local, by_default);
                const double diameter = start.holes[h].diameter;
                const auto farthest = [&](const Arrays& mesh) {
                    double largest = 0.0;
                    for (std::size_t v = local.first_new; v < mesh.points.size(); ++v)
                        largest = std::max(largest, norm(mesh.points[v] - theirs.points[v]));
                    return largest / diameter;
                };
                const std::lock_guard<std::mutex> lock(mutex);
                Tally& tally = tallies[k];
                if (!is_faired) {
                    ++tally.not_faired;
                    continue;
                }
                ++tally.compared;
                const double apart = farthest(our_mesh), default_apart = farthest(default_mesh);
                tally.within += apart <= TOLERANCE;
                if (!(apart <= TOLERANCE)) {
                    const bool is_allowed = exceptions.allow(name, METHODS[k], FAIRING);
                    all = all && is_allowed;
                    std::printf("%s %s %s fairing: the hole of %zu edges: %.3g of its diameter from CGAL's\n",
                                is_allowed ? "allowed  " : "OBJECTION", name.c_str(), METHODS[k], local.rim.size(),
                                apart);
                }
                tally.largest = std::max(tally.largest, apart);
                tally.largest_default = std::max(tally.largest_default, default_apart);
                tally.sum_default += default_apart;
                const double our_energy = energy(local, default_mesh, k + 1), their_energy = energy(local, theirs, k + 1);
                ++tally.energy[smaller(our_energy, their_energy)];
                std::vector<std::string> row{name, METHODS[k], std::to_string(local.rim.size()),
                                             std::to_string(local.numbers.size()), scientific(apart),
                                             scientific(default_apart), scientific(our_energy / their_energy)};
                if (!c.truth.triangles.empty()) {
                    // From the patch to the truth only, because the truth also has the other holes.
                    const double near = distance_to(patch_of(default_mesh, local.first_new), c.truth).rms / diameter,
                                 far = distance_to(patch_of(theirs, local.first_new), c.truth).rms / diameter;
                    ++tally.truth[smaller(near, far)];
                    row.push_back(scientific(near));
                    row.push_back(scientific(far));
                } else {
                    row.insert(row.end(), 2, "–");
                }
                rows.push_back(std::move(row));
            }
            const std::lock_guard<std::mutex> lock(mutex);
            for (const std::string& check : exceptions.unseen(name, METHODS[k], true)) {
                all = false;
                std::printf("OBJECTION %s %s %s: is listed as an exception, but does not happen\n", name.c_str(), METHODS[k],
                            check.c_str());
            }
        }
    });
    std::vector<std::vector<std::string>> totals;
    for (std::size_t k = 0; k < ORDERS; ++k) {
        const Tally& t = tallies[k];
        const double mean = t.sum_default / static_cast<double>(std::max<std::size_t>(t.compared, 1));
        std::printf("%-8s %3zu holes, %3zu within %.0e, largest %.1e; default weights: mean %.1e, largest %.1e; energy lower / "
                    "same / higher: %s; truth nearer / same / farther: %s\n",
                    METHODS[k], t.compared, t.within, TOLERANCE, t.largest, mean, t.largest_default,
                    counts(t.energy).c_str(), counts(t.truth).c_str());
        if (t.not_faired > 0) std::printf("%zu holes that CGAL does not fair\n", t.not_faired);
        totals.push_back({METHODS[k], std::to_string(t.compared), std::to_string(t.within), scientific(t.largest),
                          scientific(mean), scientific(t.largest_default), counts(t.energy), counts(t.truth)});
        all = all && (t.compared >= 10 || !arguments.only.empty());
    }
    write_table(arguments.output, "fairing-totals.md",
                {"method", "holes", "within 1e-6", "largest, its weights", "mean, our weights", "largest, our weights",
                 "energy lower / same / higher", "truth nearer / same / farther"},
                totals);
    std::sort(rows.begin(), rows.end());
    write_table(arguments.output, "fairing.md",
                {"case", "method", "rim", "new vertices", "to CGAL, its weights", "to CGAL, our weights",
                 "energy over CGAL's", "ours to the truth", "CGAL's to the truth"},
                rows);
    return all;
}

}  // namespace judge
