#include "cases.h"

#include <algorithm>
#include <functional>
#include <map>
#include <random>

namespace judge {

namespace {

constexpr double PI = 3.14159265358979323846;
constexpr std::uint32_t NONE = 0xffffffff;

using Chart = std::function<Point(double u, double v)>;
using Inside = std::function<bool(double u, double v)>;

struct Wrap {
    bool u, v;
};

// A regular net of nu by nv squares over [0, 1] x [0, 1], each cut in two. The diagonals alternate, so that no direction
// is preferred. `is_hole` gets the middle of a square and decides for both halves.
Case net(const std::string& name, std::uint32_t nu, std::uint32_t nv, Wrap wrap, const Chart& chart,
         const Inside& is_hole) {
    const std::uint32_t columns = wrap.v ? nv : nv + 1, rows = wrap.u ? nu : nu + 1;
    const auto vertex = [&](std::uint32_t i, std::uint32_t j) { return (i % rows) * columns + j % columns; };
    Case c;
    c.name = name;
    for (std::uint32_t i = 0; i < rows; ++i)
        for (std::uint32_t j = 0; j < columns; ++j)
            c.input.points.push_back(chart(static_cast<double>(i) / nu, static_cast<double>(j) / nv));
    for (std::uint32_t i = 0; i < nu; ++i) {
        for (std::uint32_t j = 0; j < nv; ++j) {
            const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j), d = vertex(i, j + 1),
                                e = vertex(i + 1, j + 1);
            const bool hole = is_hole((i + 0.5) / nu, (j + 0.5) / nv);
            std::vector<Triangle>& to = hole ? c.truth.triangles : c.input.triangles;
            if ((i + j) % 2 == 0) {
                to.push_back({a, b, e});
                to.push_back({a, e, d});
            } else {
                to.push_back({a, b, d});
                to.push_back({b, e, d});
            }
        }
    }
    return c;
}

// The surface of a cube with n squares along each edge, moved by `shape`. Squares are identified by their middle on the
// cube [-1, 1]^3.
Case cube(const std::string& name, int n, const std::function<Point(const Point&)>& shape,
          const std::function<bool(const Point&)>& is_hole) {
    Case c;
    c.name = name;
    std::map<std::array<int, 3>, std::uint32_t> numbers;
    const auto vertex = [&](const std::array<int, 3>& p) {
        const auto [at, is_new] = numbers.emplace(p, static_cast<std::uint32_t>(c.input.points.size()));
        if (is_new)
            c.input.points.push_back(shape({2.0 * p[0] / n - 1.0, 2.0 * p[1] / n - 1.0, 2.0 * p[2] / n - 1.0}));
        return at->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (int side = 0; side < 2; ++side) {
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const auto lattice = [&](int di, int dj) {
                        std::array<int, 3> p{};
                        p[axis] = side * n;
                        p[(axis + 1) % 3] = i + di;
                        p[(axis + 2) % 3] = j + dj;
                        return p;
                    };
                    std::array<std::uint32_t, 4> q{vertex(lattice(0, 0)), vertex(lattice(1, 0)),
                                                   vertex(lattice(1, 1)), vertex(lattice(0, 1))};
                    Point middle{};
                    middle[axis] = 2.0 * side - 1.0;
                    middle[(axis + 1) % 3] = (2.0 * i + 1.0) / n - 1.0;
                    middle[(axis + 2) % 3] = (2.0 * j + 1.0) / n - 1.0;
                    if (side == 0) std::swap(q[1], q[3]);
                    std::vector<Triangle>& to = is_hole(middle) ? c.truth.triangles : c.input.triangles;
                    if ((i + j) % 2 == 0) {
                        to.push_back({q[0], q[1], q[2]});
                        to.push_back({q[0], q[2], q[3]});
                    } else {
                        to.push_back({q[0], q[1], q[3]});
                        to.push_back({q[1], q[2], q[3]});
                    }
                }
            }
        }
    }
    return c;
}

// Drops the vertices that no triangle uses.
Arrays compacted(const std::vector<Point>& points, std::vector<Triangle> triangles,
                 std::vector<std::uint32_t>& numbers) {
    numbers.assign(points.size(), NONE);
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t) numbers[v] = 0;
    Arrays out;
    for (std::size_t v = 0; v < points.size(); ++v) {
        if (numbers[v] == NONE) continue;
        numbers[v] = static_cast<std::uint32_t>(out.points.size());
        out.points.push_back(points[v]);
    }
    for (Triangle& t : triangles)
        for (std::uint32_t& v : t) v = numbers[v];
    out.triangles = std::move(triangles);
    return out;
}

// Moves the points by noise, and numbers the vertices of input and truth separately. Edges of `keep` have the old
// numbers.
Case finished(Case c, double noise, std::vector<Edge> keep = {}) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> shift(-noise, noise);
    if (noise > 0.0)
        for (Point& p : c.input.points)
            for (double& x : p) x += shift(random);
    const std::vector<Point> points = std::move(c.input.points);
    std::vector<std::uint32_t> numbers;
    c.truth = compacted(points, std::move(c.truth.triangles), numbers);
    c.input = compacted(points, std::move(c.input.triangles), numbers);
    for (const Edge& e : keep) c.keep.push_back({numbers[e[0]], numbers[e[1]]});
    return c;
}

Point on_sphere(const Point& p) { return (1.0 / norm(p)) * p; }

// The boundary edge at the first column of a sheet, in the direction of its triangle.
Edge sheet_rim(const Case& c) {
    const Triangle& t = c.input.triangles.front();
    return {t[0], t[1]};
}

}  // namespace

std::vector<Case> generated_cases() {
    std::vector<Case> cases;
    const auto add = [&](Case c) { cases.push_back(std::move(c)); };
    const auto disc = [](double u0, double v0, double r) {
        return [=](double u, double v) { return std::hypot(u - u0, v - v0) < r; };
    };
    const auto square = [](double h) {
        return [h](double u, double v) { return Point{u, v, h * std::sin(5.0 * u) * std::cos(4.0 * v)}; };
    };

    add(finished(cube("made_sphere_cap", 14, on_sphere, [](const Point& p) { return on_sphere(p)[2] > 0.7; }), 0.0));
    add(finished(cube("made_sphere_two_caps", 16, on_sphere,
                      [](const Point& p) { return std::abs(on_sphere(p)[0]) > 0.85; }),
                 0.0));
    add(finished(cube("made_hemisphere", 12, on_sphere, [](const Point& p) { return on_sphere(p)[1] > 0.05; }), 0.0));
    add(finished(cube("made_noisy_sphere", 16, on_sphere,
                      [](const Point& p) {
                          const Point q = on_sphere(p);
                          return q[2] > 0.55 + 0.15 * std::cos(5.0 * std::atan2(q[1], q[0]));
                      }),
                 0.004));
    add(finished(cube("made_cube_corner", 12, [](const Point& p) { return p; },
                      [](const Point& p) { return p[0] + p[1] + p[2] > 2.2; }),
                 0.0));
    add(finished(cube("made_cube_edge", 12, [](const Point& p) { return p; },
                      [](const Point& p) { return p[0] + p[1] > 1.6 && std::abs(p[2]) < 0.5; }),
                 0.0));
    {
        const Chart torus = [](double u, double v) {
            const double a = 2.0 * PI * u, b = 2.0 * PI * v, r = 1.0 + 0.35 * std::cos(b);
            return Point{r * std::cos(a), r * std::sin(a), 0.35 * std::sin(b)};
        };
        add(finished(net("made_torus", 48, 20, {true, true}, torus, disc(0.4, 0.45, 0.16)), 0.0));
        add(finished(net("made_torus_gaps", 48, 20, {true, true}, torus,
                         [](double u, double v) {
                             return std::hypot(4.0 * (u - 0.2), v - 0.5) < 0.3 ||
                                    std::hypot(4.0 * (u - 0.7), v - 0.3) < 0.25;
                         }),
                     0.0));
    }
    {
        const Chart tube = [](double u, double v) {
            const double a = 2.0 * PI * u;
            return Point{std::cos(a), std::sin(a), 4.0 * v};
        };
        Case c = net("made_tube", 32, 20, {true, false}, tube, disc(0.5, 0.5, 0.22));
        // Both ends stay open: their first edges, in the direction of their triangles.
        const Edge bottom{0, 21}, top{21 + 20, 20};
        add(finished(std::move(c), 0.0, {bottom, top}));
    }
    for (const bool noisy : {false, true}) {
        Case c = net(noisy ? "made_rough_sheet" : "made_saddle", 30, 30, {false, false},
                     [noisy](double u, double v) {
                         return Point{u, v, noisy ? 0.1 * std::sin(9.0 * u) : (u - 0.5) * (u - 0.5) - (v - 0.5) * (v - 0.5)};
                     },
                     disc(0.5, 0.5, 0.25));
        const Edge rim = sheet_rim(c);
        add(finished(std::move(c), noisy ? 0.003 : 0.0, {rim}));
    }
    {
        Case c = net("made_island", 30, 30, {false, false}, square(0.1), [](double u, double v) {
            const double r = std::hypot(u - 0.5, v - 0.5);
            return r > 0.13 && r < 0.3;
        });
        const Edge rim = sheet_rim(c);
        add(finished(std::move(c), 0.0, {rim}));
    }
    {
        // Two square holes with one common corner.
        Case c = net("made_touching", 24, 24, {false, false}, square(0.15), [](double u, double v) {
            const auto in = [](double x, double from) { return x > from && x < from + 0.25; };
            return (in(u, 0.25) && in(v, 0.25)) || (in(u, 0.5) && in(v, 0.5));
        });
        const Edge rim = sheet_rim(c);
        add(finished(std::move(c), 0.0, {rim}));
    }
    {
        Case c = net("made_crack", 40, 40, {false, false}, square(0.1),
                     [](double u, double v) { return std::abs(v - 0.5125) < 0.01 && u > 0.2 && u < 0.8; });
        const Edge rim = sheet_rim(c);
        add(finished(std::move(c), 0.0, {rim}));
    }
    {
        Case c = net("made_small_holes", 30, 30, {false, false}, square(0.2), [](double u, double v) {
            const int i = static_cast<int>(30.0 * u), j = static_cast<int>(30.0 * v);
            return i % 5 == 2 && (j % 5 == 2 || (j % 5 == 3 && i % 10 == 2));
        });
        const Edge rim = sheet_rim(c);
        add(finished(std::move(c), 0.0, {rim}));
    }
    {
        // A helicoid, so that the rim is twisted.
        Case c = net("made_helicoid", 60, 16, {false, false},
                     [](double u, double v) {
                         const double a = 1.5 * PI * u, r = 0.5 + v;
                         return Point{r * std::cos(a), r * std::sin(a), u};
                     },
                     [](double u, double v) { return std::abs(v - 0.5) < 0.25 && u > 0.2 && u < 0.8; });
        const Edge rim = sheet_rim(c);
        add(finished(std::move(c), 0.0, {rim}));
    }
    return cases;
}

}  // namespace judge
