// A case, a fill of it by our library, and the findings of a judge.
#ifndef HOLEFILL_JUDGE_MODEL_H
#define HOLEFILL_JUDGE_MODEL_H

#include "mesh_file.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace judge {

// A directed edge, in the direction of its triangle.
using Edge = std::array<std::uint32_t, 2>;

struct Case {
    std::string name;
    Arrays input;
    // The removed triangles, with their own vertices; empty if unknown.
    Arrays truth;
    // A boundary edge of each loop that stays open.
    std::vector<Edge> keep;
};

// The report of the library about one loop.
struct Hole {
    // The vertices of the loop, in the direction of its triangles.
    std::vector<std::uint32_t> rim;
    double diameter = 0.0;
    bool filled = false;
    bool kept = false;
    std::size_t first_vertex = 0, vertex_count = 0, first_triangle = 0, triangle_count = 0;
    std::uint64_t self_intersections = 0;
    double seconds = 0.0;
    // The method whose patch closes the loop, or the reason why it stays open.
    std::string method, reason;
};

struct Fill {
    const Case* of = nullptr;
    std::string method;
    Arrays output;
    std::vector<Hole> holes;
    double seconds = 0.0;
};

// A finding against a result: the name of the check, and what it found.
struct Finding {
    std::string check, text;
};
using Findings = std::vector<Finding>;

inline Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double norm(const Point& a) { return std::sqrt(dot(a, a)); }
inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// Twice the area, along the normal.
inline Point area_vector(const Point& a, const Point& b, const Point& c) { return cross(b - a, c - a); }

}  // namespace judge

#endif
