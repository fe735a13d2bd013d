// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangle lists as CGAL's surface meshes.
#ifndef HOLEFILL_JUDGE_CGAL_MESH_H
#define HOLEFILL_JUDGE_CGAL_MESH_H

#include "model.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <vector>

namespace judge {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

inline Kernel::Point_3 to_cgal(const Point& p) { return {p[0], p[1], p[2]}; }
inline Point from_cgal(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

// The face of each triangle, if there is one.
using Faces = std::vector<CgalMesh::Face_index>;

// Adds the triangles to an empty mesh. A rejected triangle is tried again after others, so the order of the faces may
// differ from that of the triangles. Triangles that cannot be added have the null face.
inline Faces build(const Arrays& arrays, CgalMesh& mesh) {
    for (const Point& p : arrays.points) mesh.add_vertex(to_cgal(p));
    Faces faces(arrays.triangles.size(), CgalMesh::null_face());
    for (bool is_changed = true, is_complete = false; is_changed && !is_complete;) {
        is_changed = false;
        is_complete = true;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            if (faces[i] != CgalMesh::null_face()) continue;
            const Triangle& t = arrays.triangles[i];
            faces[i] = mesh.add_face(CgalMesh::Vertex_index(t[0]), CgalMesh::Vertex_index(t[1]),
                                     CgalMesh::Vertex_index(t[2]));
            if (faces[i] == CgalMesh::null_face())
                is_complete = false;
            else
                is_changed = true;
        }
    }
    return faces;
}

// The triangles without a face.
inline std::vector<std::size_t> refused(const Faces& faces) {
    std::vector<std::size_t> without;
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (faces[i] == CgalMesh::null_face()) without.push_back(i);
    return without;
}

}  // namespace judge

#endif
