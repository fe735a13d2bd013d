// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange.h"

#include "rim_edges.h"

#include <vcg/complex/algorithms/update/bounding.h>

#include <algorithm>

namespace {

Places living_elements(const CMeshO& m) {
    Places places;
    for (std::size_t i = 0; i < m.vert.size(); ++i) {
        if (!m.vert[i].IsD()) {
            places.vertices.push_back(i);
        }
    }
    for (std::size_t i = 0; i < m.face.size(); ++i) {
        if (!m.face[i].IsD()) {
            places.faces.push_back(i);
        }
    }
    return places;
}

/* Corners of faces, as positions in the list `vertices`, which ascends. */
std::vector<std::array<uint32_t, 3>> corners_of(const CMeshO& m, const std::vector<std::size_t>& faces,
                                                const std::vector<std::size_t>& vertices) {
    std::vector<uint32_t> index(m.vert.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        index[vertices[i]] = static_cast<uint32_t>(i);
    }
    std::vector<std::array<uint32_t, 3>> corners;
    corners.reserve(faces.size());
    for (const std::size_t face : faces) {
        corners.emplace_back();
        for (int k = 0; k < 3; ++k) {
            corners.back()[static_cast<std::size_t>(k)] = index[vcg::tri::Index(m, m.face[face].cV(k))];
        }
    }
    return corners;
}

holefill::Mesh copy(const CMeshO& m, const Places& places) {
    std::vector<std::array<double, 3>> positions;
    positions.reserve(places.vertices.size());
    for (const std::size_t vertex : places.vertices) {
        const Point3m& p = m.vert[vertex].cP();
        positions.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
    }
    return holefill::Mesh::from_arrays(positions, corners_of(m, places.faces, places.vertices));
}

} // namespace

Exchange::Exchange(MeshModel& model)
    : model_(model), places_(living_elements(model.cm)), mesh_(copy(model.cm, places_)) {}

std::vector<std::array<uint32_t, 3>> Exchange::selected_faces() const {
    std::vector<std::size_t> selected;
    std::copy_if(places_.faces.begin(), places_.faces.end(), std::back_inserter(selected),
                 [this](std::size_t face) { return model_.cm.face[face].IsS(); });
    return corners_of(model_.cm, selected, places_.vertices);
}

NewElements Exchange::new_elements(const std::vector<holefill::Hole>& holes) const {
    NewElements elements;
    for (const holefill::Hole& hole : holes) {
        for (uint64_t i = 0; i < hole.vertex_count; ++i) {
            elements.vertices.push_back(hole.first_vertex + i);
        }
        for (uint64_t i = 0; i < hole.triangle_count; ++i) {
            elements.faces.push_back(hole.first_triangle + i);
        }
    }
    std::sort(elements.vertices.begin(), elements.vertices.end());
    std::sort(elements.faces.begin(), elements.faces.end());
    const uint64_t first = mesh_.info().input_triangle_count;
    const std::vector<std::array<uint64_t, 3>> triangles = mesh_.triangles<uint64_t>(first);
    for (const uint64_t face : elements.faces) {
        elements.corners.push_back(triangles[static_cast<std::size_t>(face - first)]);
    }
    return elements;
}

Places Exchange::append(const std::vector<holefill::Hole>& holes) {
    using Allocator = vcg::tri::Allocator<CMeshO>;
    CMeshO& m = model_.cm;
    // Everything that can fail comes before the first change.
    const NewElements elements = new_elements(holes);
    const uint64_t first = mesh_.info().input_vertex_count;
    const std::vector<std::array<double, 3>> positions = mesh_.positions(first);
    attributes_->fetch(mesh_, elements);
    Places added;
    for (std::size_t i = 0; i < elements.vertices.size(); ++i) {
        added.vertices.push_back(m.vert.size() + i);
    }
    for (std::size_t i = 0; i < elements.faces.size(); ++i) {
        added.faces.push_back(m.face.size() + i);
    }
    if (added.faces.empty()) {
        return added;
    }

    if (!added.vertices.empty()) {
        Allocator::AddVertices(m, added.vertices.size());
    }
    Allocator::AddFaces(m, added.faces.size());
    for (std::size_t i = 0; i < added.vertices.size(); ++i) {
        const std::array<double, 3>& p = positions[static_cast<std::size_t>(elements.vertices[i] - first)];
        m.vert[added.vertices[i]].P() =
            Point3m(static_cast<Scalarm>(p[0]), static_cast<Scalarm>(p[1]), static_cast<Scalarm>(p[2]));
    }
    for (std::size_t i = 0; i < added.faces.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const uint64_t vertex = elements.corners[i][k];
            std::size_t place = 0;
            if (vertex < first) {
                place = places_.vertices[static_cast<std::size_t>(vertex)];
            } else {
                const auto found = std::lower_bound(elements.vertices.begin(), elements.vertices.end(), vertex);
                place = added.vertices[static_cast<std::size_t>(found - elements.vertices.begin())];
            }
            m.face[added.faces[i]].V(static_cast<int>(k)) = &m.vert[place];
        }
    }
    attributes_->write(elements, added);
    model_.clearDataMask(MeshModel::MM_FACEFACETOPO | MeshModel::MM_VERTFACETOPO);
    vcg::tri::UpdateBounding<CMeshO>::Box(m);
    update_flags(elements);
    update_normals(added);
    return added;
}

/* Clears the border flags along closed rims. */
void Exchange::update_flags(const NewElements& elements) {
    CMeshO& m = model_.cm;
    const RimEdges rims(mesh_);
    std::vector<bool> is_closed(static_cast<std::size_t>(mesh_.loop_count()));
    for (const std::array<uint64_t, 3>& corners : elements.corners) {
        for (std::size_t k = 0; k < 3; ++k) {
            const int64_t loop = rims.loop(corners[(k + 1) % 3], corners[k]);
            if (loop >= 0) {
                is_closed[static_cast<std::size_t>(loop)] = true;
            }
        }
    }
    const std::vector<std::array<uint32_t, 3>> corners = corners_of(m, places_.faces, places_.vertices);
    std::vector<std::size_t> closed;
    std::vector<bool> is_still_border(places_.vertices.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const uint32_t from = corners[i][static_cast<std::size_t>(k)];
            const uint32_t to = corners[i][static_cast<std::size_t>((k + 1) % 3)];
            const int64_t loop = rims.loop(from, to);
            if (loop >= 0 && is_closed[static_cast<std::size_t>(loop)]) {
                m.face[places_.faces[i]].ClearB(k);
                closed.insert(closed.end(), {from, to});
            } else if (loop >= 0) {
                is_still_border[from] = is_still_border[to] = true;
            }
        }
    }
    for (const std::size_t vertex : closed) {
        if (!is_still_border[vertex]) {
            m.vert[places_.vertices[vertex]].ClearB();
        }
    }
}

/* Sets the normals of new faces and of the vertices at closed rims. New vertices have normals from the library. */
void Exchange::update_normals(const Places& added) {
    CMeshO& m = model_.cm;
    std::vector<bool> is_at_rim(m.vert.size());
    for (const std::size_t face : added.faces) {
        m.face[face].N() = vcg::TriangleNormal(m.face[face]).Normalize();
        for (int k = 0; k < 3; ++k) {
            is_at_rim[vcg::tri::Index(m, m.face[face].V(k))] = true;
        }
    }
    for (const std::size_t vertex : added.vertices) {
        is_at_rim[vertex] = false;
    }
    // Weighted by angle, as the host does. The side stays: a mesh may have normals opposite to its orientation.
    std::vector<Point3m> sums(m.vert.size(), Point3m(0, 0, 0));
    for (const CFaceO& face : m.face) {
        if (face.IsD()) {
            continue;
        }
        const Point3m normal = vcg::TriangleNormal(face).Normalize();
        for (int k = 0; k < 3; ++k) {
            const std::size_t vertex = vcg::tri::Index(m, face.cV(k));
            if (is_at_rim[vertex]) {
                const Point3m& p = face.cP(k);
                sums[vertex] += normal * vcg::Angle(face.cP((k + 1) % 3) - p, face.cP((k + 2) % 3) - p);
            }
        }
    }
    for (std::size_t vertex = 0; vertex < m.vert.size(); ++vertex) {
        const Point3m sum = sums[vertex];
        if (is_at_rim[vertex] && sum.SquaredNorm() > 0) {
            Point3m& normal = m.vert[vertex].N();
            const bool is_turned = normal * sum < 0;
            normal = is_turned ? -sum : sum;
            normal.Normalize();
        }
    }
}
