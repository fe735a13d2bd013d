// Checks a filled mesh with OpenMesh.

#include "judges.h"
#include "topology.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>

namespace judge {

namespace {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

// With fewer edges, the triangles of an interior vertex are folded onto each other.
constexpr std::size_t LEAST_VALENCE = 3;

// Triangles that OpenMesh rejects in any order.
std::size_t build(const Arrays& arrays, Mesh& mesh) {
    for (const Point& p : arrays.points) mesh.add_vertex({p[0], p[1], p[2]});
    std::vector<Triangle> pending = arrays.triangles;
    for (std::size_t before = pending.size() + 1; !pending.empty() && pending.size() < before;) {
        before = pending.size();
        std::vector<Triangle> refused;
        for (const Triangle& t : pending) {
            const auto handle = [](std::uint32_t v) { return Mesh::VertexHandle(static_cast<int>(v)); };
            if (!mesh.add_face(handle(t[0]), handle(t[1]), handle(t[2])).is_valid()) refused.push_back(t);
        }
        pending = std::move(refused);
    }
    return pending.size();
}

std::size_t count_boundaries(const Mesh& mesh) {
    std::vector<bool> seen(mesh.n_halfedges(), false);
    std::size_t count = 0;
    for (const Mesh::HalfedgeHandle start : mesh.halfedges()) {
        const auto index = [](Mesh::HalfedgeHandle h) { return static_cast<std::size_t>(h.idx()); };
        if (!mesh.is_boundary(start) || seen[index(start)]) continue;
        ++count;
        for (Mesh::HalfedgeHandle h = start; !seen[index(h)]; h = mesh.next_halfedge_handle(h)) seen[index(h)] = true;
    }
    return count;
}

}  // namespace

Findings judge_by_openmesh(const Fill& fill, OpenMeshMeasures& measures) {
    Findings findings;
    const auto object = [&](const char* check, const std::string& text) { findings.push_back({check, text}); };
    // OpenMesh also prints to this stream what it returns.
    static const bool is_silent = (omerr().disable(), true);
    (void)is_silent;
    Mesh mesh;
    const std::size_t refused = build(fill.output, mesh);
    if (refused > 0) {
        object("openmesh-manifold", "it refuses " + std::to_string(refused) + " triangles");
        return findings;
    }
    const std::size_t old = fill.of->input.points.size();
    // All vertices of the patches, with those of the filled rims.
    std::vector<bool> is_looked_at(mesh.n_vertices(), false);
    for (std::size_t v = old; v < is_looked_at.size(); ++v) is_looked_at[v] = true;
    for (const Hole& hole : fill.holes)
        if (hole.filled)
            for (const std::uint32_t v : hole.rim) is_looked_at[v] = true;

    std::size_t isolated = 0, pinched = 0, folded = 0, counted = 0, edges = 0;
    measures.least_valence = static_cast<std::size_t>(-1);
    for (const Mesh::VertexHandle v : mesh.vertices()) {
        isolated += mesh.is_isolated(v);
        if (!is_looked_at[static_cast<std::size_t>(v.idx())]) continue;
        pinched += !mesh.is_manifold(v);
        std::size_t valence = 0;
        for (auto ring = mesh.cvv_iter(v); ring.is_valid(); ++ring) ++valence;
        folded += !mesh.is_boundary(v) && valence < LEAST_VALENCE;
        if (static_cast<std::size_t>(v.idx()) < old) continue;
        measures.least_valence = std::min(measures.least_valence, valence);
        measures.largest_valence = std::max(measures.largest_valence, valence);
        edges += valence;
        ++counted;
    }
    if (counted == 0) measures.least_valence = 0;
    measures.mean_valence = counted == 0 ? 0.0 : static_cast<double>(edges) / static_cast<double>(counted);
    if (pinched > 0) object("openmesh-manifold", std::to_string(pinched) + " vertices of patches are not manifold");
    if (folded > 0) object("openmesh-valence", std::to_string(folded) + " interior vertices have fewer than three edges");
    if (isolated != isolated_vertices(fill.of->input))
        object("openmesh-isolated", "the number of isolated vertices has changed");

    // Each patch adds two minus the number of loops that bound it.
    long change = 0;
    std::size_t open = 0;
    for (const Hole& hole : fill.holes) {
        change += (hole.triangle_count > 0 ? 2 : 0) - (hole.filled ? 1 : 0);
        open += !hole.filled;
    }
    const long euler = static_cast<long>(mesh.n_vertices() - isolated) - static_cast<long>(mesh.n_edges()) +
                       static_cast<long>(mesh.n_faces());
    const long expected = euler_characteristic(fill.of->input) + change;
    if (euler != expected)
        object("openmesh-euler", "the Euler characteristic is " + std::to_string(euler) + " instead of " +
                                     std::to_string(expected));
    const std::size_t boundaries = count_boundaries(mesh);
    if (boundaries != open)
        object("openmesh-boundaries", std::to_string(boundaries) + " boundaries instead of " + std::to_string(open));
    return findings;
}

}  // namespace judge
