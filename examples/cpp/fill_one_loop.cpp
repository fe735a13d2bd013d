// Fills one chosen hole of a halfedge mesh that belongs to the calling program.
//
// The library reads the vertices directly from the structs of the program. It returns the patch: new vertices, and
// triangles with the vertex numbers of the program. The program adds them like any other face.
#include <holefill.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace {

// A mesh as in a CAD program: halfedges, with the program's own data at every element.
class HalfedgeMesh {
public:
    static constexpr int NONE = -1;

    struct Vertex {
        int layer = 0;
        double point[3] = {0, 0, 0};
    };
    struct Halfedge {
        uint32_t from = 0, to = 0;
        int twin = NONE, next = NONE;
    };
    struct Face {
        int halfedge = NONE;
        int material = 0;
    };

    std::vector<Vertex> vertices;
    std::vector<Halfedge> halfedges;
    std::vector<Face> faces;

    uint32_t add_vertex(double x, double y, double z, int layer) {
        vertices.push_back({layer, {x, y, z}});
        return static_cast<uint32_t>(vertices.size() - 1);
    }
    void add_face(const std::array<uint32_t, 3>& corners, int material) {
        const int first = static_cast<int>(halfedges.size());
        for (int k = 0; k < 3; ++k) {
            Halfedge h{corners[k], corners[(k + 1) % 3], NONE, first + (k + 1) % 3};
            const auto twin = by_ends_.find({h.to, h.from});
            if (twin != by_ends_.end()) {
                h.twin = twin->second;
                halfedges[twin->second].twin = first + k;
            }
            by_ends_[{h.from, h.to}] = first + k;
            halfedges.push_back(h);
        }
        faces.push_back({first, material});
    }
    std::array<uint32_t, 3> corners(const Face& face) const {
        const Halfedge &a = halfedges[face.halfedge], &b = halfedges[a.next], &c = halfedges[b.next];
        return {a.from, b.from, c.from};
    }
    std::ptrdiff_t boundary_edges() const {
        return std::count_if(halfedges.begin(), halfedges.end(), [](const Halfedge& h) { return h.twin == NONE; });
    }

private:
    std::map<std::pair<uint32_t, uint32_t>, int> by_ends_;
};

// A pipe with two windows in its side, open at both ends.
HalfedgeMesh make_pipe() {
    constexpr int AROUND = 48, ALONG = 30;
    HalfedgeMesh mesh;
    for (int i = 0; i <= ALONG; ++i) {
        for (int j = 0; j < AROUND; ++j) {
            const double angle = 6.283185307179586 * j / AROUND;
            mesh.add_vertex(std::cos(angle), std::sin(angle), 4.0 * i / ALONG, 1);
        }
    }
    const auto is_window = [](int i, int j) {
        return (i >= 5 && i < 12 && j >= 3 && j < 14) || (i >= 18 && i < 24 && j >= 20 && j < 28);
    };
    for (int i = 0; i < ALONG; ++i) {
        for (int j = 0; j < AROUND; ++j) {
            if (!is_window(i, j)) {
                const auto at = [&](int u, int v) { return static_cast<uint32_t>(u * AROUND + v % AROUND); };
                mesh.add_face({at(i, j), at(i, j + 1), at(i + 1, j + 1)}, 7);
                mesh.add_face({at(i, j), at(i + 1, j + 1), at(i + 1, j)}, 7);
            }
        }
    }
    return mesh;
}

// Fills the hole at a boundary halfedge that a user has selected.
void fill_hole(HalfedgeMesh& mesh, int picked) {
    std::vector<std::array<uint32_t, 3>> triangles;
    for (const auto& face : mesh.faces) {
        triangles.push_back(mesh.corners(face));
    }
    // Rows of three numbers; their stride is the size of the program's struct.
    const holefill::Rows<3> points(mesh.vertices[0].point, mesh.vertices.size(), sizeof(HalfedgeMesh::Vertex));
    const holefill::Mesh input = holefill::Mesh::from_arrays(points, triangles);

    const auto& edge = mesh.halfedges[picked];
    const uint64_t loop = input.find_loops(holefill::Target::edge(edge.from, edge.to)).at(0);
    const holefill::Plan plan = input.plan(holefill::Target::loop(loop));
    const holefill::Hole hole = plan.report().hole(0);
    if (hole.status != HOLEFILL_HOLE_FILLED) {
        std::printf("the hole stays open: %s\n", hole.reason.c_str());
        return;
    }
    const holefill::Patch patch = plan.patch(loop);
    for (const auto& p : patch.positions) {
        mesh.add_vertex(p[0], p[1], p[2], 2);
    }
    for (const auto& t : patch.triangles) {
        mesh.add_face({static_cast<uint32_t>(t[0]), static_cast<uint32_t>(t[1]), static_cast<uint32_t>(t[2])}, 8);
    }
    std::printf("filled a hole of %llu edges by %s: %zu vertices, %zu triangles\n",
                static_cast<unsigned long long>(hole.edge_count), hole.method, patch.positions.size(),
                patch.triangles.size());
}

} // namespace

int main() {
    HalfedgeMesh mesh = make_pipe();
    const auto before = mesh.boundary_edges();
    // The first boundary halfedge that is not on an end of the pipe.
    const auto picked = std::find_if(mesh.halfedges.begin(), mesh.halfedges.end(), [&](const auto& h) {
        const double z = mesh.vertices[h.from].point[2];
        return h.twin == HalfedgeMesh::NONE && z > 0.1 && z < 3.9;
    });
    fill_hole(mesh, static_cast<int>(picked - mesh.halfedges.begin()));

    double farthest = 0.0;
    for (const auto& v : mesh.vertices) {
        farthest = std::max(farthest, std::abs(std::hypot(v.point[0], v.point[1]) - 1.0));
    }
    const auto closed = before - mesh.boundary_edges();
    std::printf("%td boundary edges closed; the new vertices are at most %.4f off the pipe of radius 1\n", closed,
                farthest);
    return closed == 36 ? 0 : 1;
}
