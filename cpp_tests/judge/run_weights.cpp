// Compares the exact search with CGAL's: both must find the same least weight for every loop.

#include "cases.h"
#include "commands.h"
#include "fill.h"
#include "judged.h"
#include "report.h"
#include "weights.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <mutex>
#include <random>

namespace judge {

namespace {

constexpr double PI = 3.14159265358979323846;
// Weights are different if they differ by more than this: angles relative to a half turn, areas relative to the area.
constexpr double TOLERANCE = 1e-9;
// Angles closer than this are equal up to rounding.
constexpr double TIE = 1e-12;
// Noise that breaks ties, over the size of the loop.
constexpr double ROUGHNESS = 1e-6;
constexpr std::size_t LARGEST = 200;
// Number of loops of each generated kind. Their sizes are from 3 to LARGEST.
constexpr std::size_t LOOPS_OF_A_KIND = 110;
// Largest number of loops from one case.
constexpr std::size_t LOOPS_OF_A_CASE = 25;

struct Task {
    std::string kind;
    Loop loop;
    // The loop in a mesh with a triangle outside each edge, and the vertex of each position of the loop. Empty for a
    // loop without triangles outside.
    Arrays mesh;
    std::vector<std::uint32_t> vertices;
};

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

std::vector<Point> made_points(const std::string& kind, std::size_t m, Random& random) {
    std::vector<Point> points;
    const Point axis{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    const double phase = uniform(random, 0, 2 * PI), turns = std::floor(uniform(random, 1, 4));
    for (std::size_t i = 0; i < m; ++i) {
        const double a = 2.0 * PI * (static_cast<double>(i) + uniform(random, -0.3, 0.3)) / static_cast<double>(m);
        const double r = uniform(random, 0.9, 1.1);
        Point p{r * std::cos(a), r * std::sin(a), 0.0};
        if (kind == "random") {
            p = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
        } else if (kind == "tilted planar") {
            p = {p[0], p[1], axis[0] * p[0] + axis[1] * p[1]};
        } else if (kind == "curved") {
            p[2] = 0.6 * std::cos(2.0 * a + phase) + 0.2 * std::sin(3.0 * a);
        } else if (kind == "twisted") {
            // Winds round a torus.
            const double b = turns * a + phase;
            p = {(2.0 + r * std::cos(b)) * std::cos(a), (2.0 + r * std::cos(b)) * std::sin(a), r * std::sin(b)};
        }
        points.push_back(p);
    }
    return points;
}

// The search keeps only the best triangle below each chord, so its result depends on the start of the loop. In a mesh,
// the library always starts at the vertex farthest from the middle.
void begin_as_the_library(Task& task) {
    std::vector<Point>& points = task.loop.points;
    Point middle{};
    for (const Point& p : points) middle = middle + (1.0 / static_cast<double>(points.size())) * p;
    const auto farthest = std::max_element(points.begin(), points.end(), [&](const Point& a, const Point& b) {
        return norm(a - middle) < norm(b - middle);
    });
    const std::ptrdiff_t first = farthest - points.begin();
    const auto turn = [first](auto& list) { std::rotate(list.begin(), list.begin() + first, list.end()); };
    turn(points);
    turn(task.loop.apexes);
    turn(task.vertices);
}

// A collar of triangles outside the loop, two at each edge, with the same roughness as the loop.
void add_collar(Task& task, Random& random) {
    const std::size_t m = task.loop.points.size();
    Point middle{};
    for (const Point& p : task.loop.points) middle = middle + (1.0 / static_cast<double>(m)) * p;
    task.mesh.points = task.loop.points;
    for (const Point& p : task.loop.points) {
        const Point out = (1.0 / norm(p - middle)) * (p - middle);
        task.mesh.points.push_back(p + 0.3 * out + Point{uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1),
                                                          uniform(random, -0.1, 0.1)});
    }
    for (std::uint32_t i = 0; i < m; ++i) {
        const auto n = static_cast<std::uint32_t>(m);
        const std::uint32_t j = (i + 1) % n;
        task.mesh.triangles.push_back({j, i, i + n});
        task.mesh.triangles.push_back({j, i + n, j + n});
        task.loop.apexes.push_back(task.mesh.points[i + n]);
        task.vertices.push_back(i);
    }
    begin_as_the_library(task);
}

// From 3 to LARGEST, small sizes more often.
std::size_t size_of(std::size_t k, std::size_t count) {
    const double share = static_cast<double>(k) / static_cast<double>(count - 1);
    return static_cast<std::size_t>(std::lround(3.0 * std::pow(LARGEST / 3.0, share)));
}

void add_made(std::vector<Task>& tasks) {
    Random random(11);
    for (const char* kind : {"random", "planar", "tilted planar", "curved", "twisted"})
        for (const bool has_collar : {false, true})
            for (std::size_t k = 0; k < LOOPS_OF_A_KIND; ++k) {
                Task task;
                task.kind = std::string(kind) + (has_collar ? ", with triangles outside" : "");
                task.loop.points = made_points(kind, size_of(k, LOOPS_OF_A_KIND), random);
                if (has_collar) add_collar(task, random);
                tasks.push_back(std::move(task));
            }
}

// The rims of a case, without rims that touch each other, and without rims with a chord that is a mesh edge.
void add_rims(std::vector<Task>& tasks, const Case& c, const std::string& kind) {
    std::map<Edge, std::uint32_t> apexes;
    for (const Triangle& t : c.input.triangles)
        for (std::size_t k = 0; k < 3; ++k) apexes[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
    const std::vector<std::vector<std::uint32_t>> rims = loops(c.input);
    std::map<std::uint32_t, std::size_t> uses;
    for (const auto& rim : rims)
        for (const std::uint32_t v : rim) ++uses[v];
    std::size_t taken = 0;
    for (const auto& rim : rims) {
        const std::size_t m = rim.size();
        if (m > LARGEST || taken == LOOPS_OF_A_CASE) continue;
        Task task;
        task.kind = kind;
        task.vertices.assign(rim.rbegin(), rim.rend());
        bool is_simple = true;
        for (std::size_t i = 0; i < m; ++i) {
            const std::uint32_t v = task.vertices[i];
            is_simple = is_simple && uses[v] == 1;
            for (std::size_t j = 0; j < m; ++j)
                if (j != (i + 1) % m && (j + 1) % m != i) is_simple = is_simple && apexes.count({v, task.vertices[j]}) == 0;
            const auto apex = apexes.find({task.vertices[(i + 1) % m], v});
            if (apex == apexes.end()) {
                is_simple = false;
                break;
            }
            task.loop.points.push_back(c.input.points[v]);
            task.loop.apexes.push_back(c.input.points[apex->second]);
        }
        if (!is_simple) continue;
        begin_as_the_library(task);
        task.mesh = c.input;
        tasks.push_back(std::move(task));
        ++taken;
    }
}

// Our triangulation, as positions of the loop.
std::vector<Triangle> search_by_us(const Task& task) {
    if (task.mesh.triangles.empty()) return search_polyline(task.loop.points);
    std::map<std::uint32_t, std::uint32_t> positions;
    for (std::uint32_t i = 0; i < task.vertices.size(); ++i) positions[task.vertices[i]] = i;
    std::vector<Triangle> triangles = search_loop(task.mesh, {task.vertices[1], task.vertices[0]});
    for (Triangle& t : triangles)
        for (std::uint32_t& v : t) v = positions.at(v);
    return triangles;
}

// The task, with small noise on every vertex of the mesh.
Task roughened(Task task, Random& random) {
    std::map<Point, Point> moved;
    double size = 0.0;
    for (const Point& p : task.loop.points) size = std::max(size, norm(p - task.loop.points.front()));
    for (Point& p : task.mesh.points) {
        Point q = p;
        for (double& x : q) x += uniform(random, -ROUGHNESS, ROUGHNESS) * size;
        moved[p] = q;
        p = q;
    }
    for (Point& p : task.loop.points) p = moved.at(p);
    for (Point& p : task.loop.apexes) p = moved.at(p);
    begin_as_the_library(task);
    return task;
}

struct Difference {
    std::optional<Weight> ours, theirs;
    // Differences of the angles over a half turn, and of the areas over the area.
    double angle = 0.0, area = 0.0;

    bool is_equal() const { return angle <= TOLERANCE && area <= TOLERANCE; }
};

Difference compare(const Task& task) {
    Difference d{weigh(task.loop, search_by_us(task)), weigh(task.loop, search_by_cgal(task.loop))};
    if (d.ours && d.theirs) {
        d.angle = std::abs(d.ours->angle - d.theirs->angle) / PI;
        d.area = std::abs(d.ours->area - d.theirs->area) / d.theirs->area;
    }
    return d;
}

// Results for the loops of a kind.
struct Tally {
    std::size_t loops = 0, equal = 0, ties = 0, different = 0, only_one = 0, neither = 0;
    double largest_angle = 0.0, largest_area = 0.0;
};

}  // namespace

bool run_weights(const Arguments& arguments) {
    std::vector<Task> tasks;
    add_made(tasks);
    for (const Case& c : generated_cases()) add_rims(tasks, c, "rims of generated meshes");
    const std::size_t made = tasks.size();
    const std::vector<std::string> names = public_case_names(arguments.cases);
    for (const std::string& name : names)
        add_rims(tasks, read_public_case(arguments.cases, name), "rims of public models");
    std::map<std::string, Tally> tallies;
    std::mutex mutex;
    in_parallel(tasks.size(), [&](std::size_t i) {
        const Task& task = tasks[i];
        Difference d = compare(task);
        // Symmetric rims have angles that are equal except for their last bits, which then choose between areas. Without
        // its symmetry, the rim must have one answer.
        const bool is_tie = !d.is_equal() && d.angle <= TIE && !task.mesh.triangles.empty();
        if (is_tie) {
            Random random(i);
            d = compare(roughened(task, random));
        }
        const std::lock_guard<std::mutex> lock(mutex);
        Tally& tally = tallies[task.kind];
        ++tally.loops;
        if (!d.ours && !d.theirs) {
            ++tally.neither;
            return;
        }
        if (!d.ours || !d.theirs) {
            ++tally.only_one;
            std::printf("OBJECTION %s, %zu edges: only %s finds a triangulation\n", task.kind.c_str(),
                        task.loop.points.size(), d.ours ? "holefill" : "CGAL");
            return;
        }
        tally.largest_angle = std::max(tally.largest_angle, d.angle);
        tally.largest_area = std::max(tally.largest_area, d.area);
        ++(!d.is_equal() ? tally.different : is_tie ? tally.ties : tally.equal);
        if (!d.is_equal())
            std::printf("OBJECTION %s, %zu edges: (%.17g, %.17g) instead of (%.17g, %.17g)\n", task.kind.c_str(),
                        task.loop.points.size(), d.ours->angle, d.ours->area, d.theirs->angle, d.theirs->area);
    });
    std::printf("%-36s %7s %7s %7s %9s %8s %8s %9s %9s\n", "loops", "number", "equal", "ties", "different", "only one",
                "neither", "angle", "area");
    bool all = true;
    std::size_t equal = 0;
    std::vector<std::vector<std::string>> rows;
    for (const auto& [kind, t] : tallies) {
        rows.push_back({kind, std::to_string(t.loops), std::to_string(t.equal), std::to_string(t.ties),
                        std::to_string(t.different), std::to_string(t.only_one + t.neither), scientific(t.largest_angle),
                        scientific(t.largest_area)});
        std::printf("%-36s %7zu %7zu %7zu %9zu %8zu %8zu %9.1e %9.1e\n", kind.c_str(), t.loops, t.equal, t.ties,
                    t.different, t.only_one, t.neither, t.largest_angle, t.largest_area);
        all = all && t.different == 0 && t.only_one == 0;
        equal += t.equal;
    }
    std::printf("%zu loops, %zu of them made, %zu of equal weight\n", tasks.size(), made, equal);
    write_table(arguments.output, "weights.md",
                {"loops", "number", "equal", "equal without ties", "different", "no triangulation", "angle", "area"}, rows);
    return all && equal >= 1000;
}

}  // namespace judge
