// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangle lists as CGAL's surface meshes.
#ifndef HOLEFILL_JUDGE_CGAL_MESH_H
#define HOLEFILL_JUDGE_CGAL_MESH_H

#include "model.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

namespace judge {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

inline Kernel::Point_3 to_cgal(const Point& p) { return {p[0], p[1], p[2]}; }
inline Point from_cgal(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

// Adds the triangles to an empty mesh; faces have the numbers of the triangles when all are taken. A triangle that is
// refused is tried again when others are in. Returns those that are refused for good.
inline std::vector<std::size_t> build(const Arrays& arrays, CgalMesh& mesh) {
    for (const Point& p : arrays.points) mesh.add_vertex(to_cgal(p));
    std::vector<std::size_t> pending(arrays.triangles.size());
    for (std::size_t i = 0; i < pending.size(); ++i) pending[i] = i;
    // The first pass keeps the numbers; later ones are only for meshes that need another order.
    for (std::size_t before = pending.size() + 1; !pending.empty() && pending.size() < before;) {
        before = pending.size();
        std::vector<std::size_t> refused;
        for (const std::size_t i : pending) {
            const Triangle& t = arrays.triangles[i];
            const auto face = mesh.add_face(CgalMesh::Vertex_index(t[0]), CgalMesh::Vertex_index(t[1]),
                                            CgalMesh::Vertex_index(t[2]));
            if (face == CgalMesh::null_face()) refused.push_back(i);
        }
        pending = std::move(refused);
    }
    return pending;
}

}  // namespace judge

#endif
