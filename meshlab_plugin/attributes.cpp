// SPDX-License-Identifier: GPL-3.0-or-later
#include "attributes.h"

#include "rim_edges.h"

#include <algorithm>
#include <cmath>
#include <typeindex>
#include <typeinfo>

namespace {

/* The word `index` in this name makes the library copy the value from the nearest element. */
const char* const TEXTURE_INDEX = "texture index";
/* Texture coordinates of corners, as an attribute of vertices. */
const char* const CORNER_COORDINATES = "corner coordinates";

double clamp_to_byte(double value) { return std::min(std::max(std::round(value), 0.0), 255.0); }

void read_color(const vcg::Color4b& color, double* row) {
    for (int k = 0; k < 4; ++k) {
        row[k] = color[k];
    }
}

void write_color(vcg::Color4b& color, const double* row) {
    for (int k = 0; k < 4; ++k) {
        color[k] = static_cast<unsigned char>(clamp_to_byte(row[k]));
    }
}

template <class Point>
void read_point(const Point& point, double* row) {
    for (int k = 0; k < 3; ++k) {
        row[k] = static_cast<double>(point[k]);
    }
}

template <class Point>
void write_point(Point& point, const double* row) {
    for (int k = 0; k < 3; ++k) {
        point[k] = static_cast<typename Point::ScalarType>(row[k]);
    }
}

/* The names of the attributes of type T in a set of the host. */
template <class T, class Set>
std::vector<std::string> names_of(const Set& attributes) {
    std::vector<std::string> names;
    for (const auto& attribute : attributes) {
        if (!attribute._name.empty() && attribute._type == std::type_index(typeid(T))) {
            names.push_back(attribute._name);
        }
    }
    return names;
}

} // namespace

Attributes::Attributes(MeshModel& model, holefill::Mesh& mesh, const Places& places, const Carried& carried)
    : model_(model), vertex_count_(places.vertices.size()) {
    collect_vertex_values(carried);
    collect_face_values(carried);
    collect_custom_values(carried.custom);
    for (const Channel& channel : channels_) {
        hand_over(mesh, channel, channel.element == HOLEFILL_ELEMENT_VERTEX ? places.vertices : places.faces);
    }
    collect_wedges(mesh, places, carried.texture);
}

void Attributes::collect_vertex_values(const Carried& carried) {
    CMeshO& m = model_.cm;
    const HolefillElement vertex = HOLEFILL_ELEMENT_VERTEX;
    channels_.push_back({vertex, 3, HOLEFILL_TYPE_F64, [&m](std::size_t i, double* row) { read_point(m.vert[i].N(), row); },
                         [&m](std::size_t i, const double* row) { write_point(m.vert[i].N(), row); }, 0.0, "normal"});
    if (model_.hasPerVertexColor()) {
        channels_.push_back({vertex, 4, HOLEFILL_TYPE_U8, [&m](std::size_t i, double* row) { read_color(m.vert[i].C(), row); },
                             [&m](std::size_t i, const double* row) { write_color(m.vert[i].C(), row); }, 255.0,
                             carried.color ? "color" : ""});
    }
    if (model_.hasPerVertexQuality()) {
        channels_.push_back({vertex, 1, HOLEFILL_TYPE_F64,
                             [&m](std::size_t i, double* row) { *row = static_cast<double>(m.vert[i].Q()); },
                             [&m](std::size_t i, const double* row) { m.vert[i].Q() = static_cast<Scalarm>(*row); }, 0.0,
                             carried.quality ? "quality" : ""});
    }
    if (m.vert.IsRadiusEnabled()) {
        channels_.push_back({vertex, 1, HOLEFILL_TYPE_F64,
                             [&m](std::size_t i, double* row) { *row = static_cast<double>(m.vert[i].R()); },
                             [&m](std::size_t i, const double* row) { m.vert[i].R() = static_cast<Scalarm>(*row); }, 0.0,
                             carried.quality ? "radius" : ""});
    }
    if (m.vert.IsTexCoordEnabled()) {
        channels_.push_back({vertex, 2, HOLEFILL_TYPE_F64,
                             [&m](std::size_t i, double* row) {
                                 row[0] = static_cast<double>(m.vert[i].T().U());
                                 row[1] = static_cast<double>(m.vert[i].T().V());
                             },
                             [&m](std::size_t i, const double* row) {
                                 m.vert[i].T().U() = static_cast<float>(row[0]);
                                 m.vert[i].T().V() = static_cast<float>(row[1]);
                             },
                             0.0, carried.texture ? "coordinates" : ""});
        channels_.push_back({vertex, 1, HOLEFILL_TYPE_I32, [&m](std::size_t i, double* row) { *row = m.vert[i].T().N(); },
                             [&m](std::size_t i, const double* row) { m.vert[i].T().N() = static_cast<short>(*row); }, 0.0,
                             carried.texture ? TEXTURE_INDEX : ""});
    }
    if (m.vert.IsCurvatureDirEnabled()) {
        // New vertices have no curvature until the user computes it again.
        channels_.push_back({vertex, 1, HOLEFILL_TYPE_F64, nullptr,
                             [&m](std::size_t i, const double*) {
                                 m.vert[i].PD1().SetZero();
                                 m.vert[i].PD2().SetZero();
                                 m.vert[i].K1() = m.vert[i].K2() = 0;
                             },
                             0.0, ""});
    }
}

void Attributes::collect_face_values(const Carried& carried) {
    CMeshO& m = model_.cm;
    const HolefillElement face = HOLEFILL_ELEMENT_TRIANGLE;
    if (m.face.IsColorEnabled()) {
        channels_.push_back({face, 4, HOLEFILL_TYPE_U8, [&m](std::size_t i, double* row) { read_color(m.face[i].C(), row); },
                             [&m](std::size_t i, const double* row) { write_color(m.face[i].C(), row); }, 255.0,
                             carried.color ? "color" : ""});
    }
    if (m.face.IsQualityEnabled()) {
        channels_.push_back({face, 1, HOLEFILL_TYPE_F64,
                             [&m](std::size_t i, double* row) { *row = static_cast<double>(m.face[i].Q()); },
                             [&m](std::size_t i, const double* row) { m.face[i].Q() = static_cast<Scalarm>(*row); }, 0.0,
                             carried.quality ? "quality" : ""});
    }
    if (m.face.IsWedgeTexCoordEnabled()) {
        // The coordinates themselves are a vertex attribute, see collect_wedges.
        channels_.push_back({face, 1, HOLEFILL_TYPE_I32, [&m](std::size_t i, double* row) { *row = m.face[i].WT(0).N(); },
                             [&m](std::size_t i, const double* row) {
                                 for (int k = 0; k < 3; ++k) {
                                     m.face[i].WT(k).N() = static_cast<short>(*row);
                                 }
                             },
                             0.0, carried.texture ? TEXTURE_INDEX : ""});
    }
    if (m.face.IsCurvatureDirEnabled()) {
        channels_.push_back({face, 1, HOLEFILL_TYPE_F64, nullptr,
                             [&m](std::size_t i, const double*) {
                                 m.face[i].PD1().SetZero();
                                 m.face[i].PD2().SetZero();
                                 m.face[i].K1() = m.face[i].K2() = 0;
                             },
                             0.0, ""});
    }
}

/* Scalars and points: scripts can make only these. */
void Attributes::collect_custom_values(bool is_carried) {
    using Allocator = vcg::tri::Allocator<CMeshO>;
    CMeshO& m = model_.cm;
    // The host's names need not be UTF-8, and could be equal to names that the library interprets.
    const auto name = [&] { return is_carried ? "custom " + std::to_string(channels_.size()) : std::string(); };
    const auto scalars = [&](HolefillElement element, auto handle) {
        channels_.push_back({element, 1, HOLEFILL_TYPE_F64,
                             [handle](std::size_t i, double* row) mutable { *row = static_cast<double>(handle[i]); },
                             [handle](std::size_t i, const double* row) mutable { handle[i] = static_cast<Scalarm>(*row); },
                             0.0, name()});
    };
    const auto points = [&](HolefillElement element, auto handle) {
        channels_.push_back({element, 3, HOLEFILL_TYPE_F64,
                             [handle](std::size_t i, double* row) mutable { read_point(handle[i], row); },
                             [handle](std::size_t i, const double* row) mutable { write_point(handle[i], row); }, 0.0,
                             name()});
    };
    for (const std::string& attribute : names_of<Scalarm>(m.vert_attr)) {
        scalars(HOLEFILL_ELEMENT_VERTEX, Allocator::FindPerVertexAttribute<Scalarm>(m, attribute));
    }
    for (const std::string& attribute : names_of<Point3m>(m.vert_attr)) {
        points(HOLEFILL_ELEMENT_VERTEX, Allocator::FindPerVertexAttribute<Point3m>(m, attribute));
    }
    for (const std::string& attribute : names_of<Scalarm>(m.face_attr)) {
        scalars(HOLEFILL_ELEMENT_TRIANGLE, Allocator::FindPerFaceAttribute<Scalarm>(m, attribute));
    }
    for (const std::string& attribute : names_of<Point3m>(m.face_attr)) {
        points(HOLEFILL_ELEMENT_TRIANGLE, Allocator::FindPerFaceAttribute<Point3m>(m, attribute));
    }
}

/* Each corner has its own coordinates, so a vertex at a seam has several. The patch continues those of the corners at
 * the rim. */
void Attributes::collect_wedges(holefill::Mesh& mesh, const Places& places, bool is_carried) {
    CMeshO& m = model_.cm;
    if (!m.face.IsWedgeTexCoordEnabled()) {
        return;
    }
    wedges_.assign(2 * vertex_count_, 0.0);
    if (!is_carried) {
        return;
    }
    const RimEdges rims(mesh);
    const std::vector<std::array<uint32_t, 3>> triangles = mesh.triangles();
    std::vector<bool> is_of_rim(vertex_count_);
    for (std::size_t i = 0; i < places.faces.size(); ++i) {
        const std::array<uint32_t, 3>& corners = triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t before = corners[(k + 2) % 3], vertex = corners[k], after = corners[(k + 1) % 3];
            const bool is_at_rim = rims.loop(vertex, after) >= 0 || rims.loop(before, vertex) >= 0;
            if (is_at_rim || !is_of_rim[vertex]) {
                is_of_rim[vertex] = is_of_rim[vertex] || is_at_rim;
                const auto& corner = m.face[places.faces[i]].WT(static_cast<int>(k));
                wedges_[2 * vertex] = static_cast<double>(corner.U());
                wedges_[2 * vertex + 1] = static_cast<double>(corner.V());
            }
        }
    }
    mesh.add_attribute(HOLEFILL_ELEMENT_VERTEX, CORNER_COORDINATES, 2, wedges_);
    wedges_are_carried_ = true;
}

void Attributes::hand_over(holefill::Mesh& mesh, const Channel& channel, const std::vector<std::size_t>& places) {
    if (channel.name.empty()) {
        return;
    }
    std::vector<double> values(places.size() * channel.components);
    for (std::size_t i = 0; i < places.size(); ++i) {
        channel.read(places[i], &values[i * channel.components]);
    }
    if (channel.type == HOLEFILL_TYPE_F64) {
        mesh.add_attribute(channel.element, channel.name.c_str(), channel.components, values);
    } else if (channel.type == HOLEFILL_TYPE_U8) {
        const std::vector<uint8_t> bytes(values.begin(), values.end());
        mesh.add_attribute(channel.element, channel.name.c_str(), channel.components, bytes);
    } else {
        const std::vector<int32_t> integers(values.begin(), values.end());
        mesh.add_attribute(channel.element, channel.name.c_str(), channel.components, integers);
    }
}

namespace {

/* The values of an attribute in these rows, which must ascend. */
std::vector<double> read_rows(const holefill::Mesh& mesh, HolefillElement element, const std::string& name,
                              uint32_t components, const std::vector<uint64_t>& rows) {
    std::vector<double> chosen;
    chosen.reserve(rows.size() * components);
    const std::vector<holefill::Attribute> attributes = mesh.attributes(element);
    const auto place = std::find_if(attributes.begin(), attributes.end(),
                                    [&](const holefill::Attribute& attribute) { return attribute.name == name; });
    if (rows.empty() || place == attributes.end()) {
        return chosen;
    }
    const uint64_t first = rows.front();
    const std::vector<double> all = mesh.attribute(element, static_cast<uint64_t>(place - attributes.begin()), first);
    for (const uint64_t row : rows) {
        const auto from = all.begin() + static_cast<std::ptrdiff_t>((row - first) * components);
        chosen.insert(chosen.end(), from, from + components);
    }
    return chosen;
}

} // namespace

void Attributes::fetch(const holefill::Mesh& mesh, const NewElements& elements) {
    for (Channel& channel : channels_) {
        const auto& rows = channel.element == HOLEFILL_ELEMENT_VERTEX ? elements.vertices : elements.faces;
        if (channel.name.empty()) {
            channel.added.assign(rows.size() * channel.components, channel.fallback);
        } else {
            channel.added = read_rows(mesh, channel.element, channel.name, channel.components, rows);
        }
    }
    if (!wedges_.empty()) {
        std::vector<double> added(2 * elements.vertices.size(), 0.0);
        if (wedges_are_carried_) {
            added = read_rows(mesh, HOLEFILL_ELEMENT_VERTEX, CORNER_COORDINATES, 2, elements.vertices);
        }
        wedges_.resize(2 * vertex_count_);
        wedges_.insert(wedges_.end(), added.begin(), added.end());
    }
}

void Attributes::write(const NewElements& elements, const Places& added) const {
    for (const Channel& channel : channels_) {
        const auto& places = channel.element == HOLEFILL_ELEMENT_VERTEX ? added.vertices : added.faces;
        for (std::size_t i = 0; i < places.size(); ++i) {
            channel.write(places[i], &channel.added[i * channel.components]);
        }
    }
    if (wedges_.empty()) {
        return;
    }
    for (std::size_t i = 0; i < added.faces.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const uint64_t vertex = elements.corners[i][k];
            std::size_t row = static_cast<std::size_t>(vertex);
            if (row >= vertex_count_) {
                const auto place = std::lower_bound(elements.vertices.begin(), elements.vertices.end(), vertex);
                row = vertex_count_ + static_cast<std::size_t>(place - elements.vertices.begin());
            }
            auto& corner = model_.cm.face[added.faces[i]].WT(static_cast<int>(k));
            corner.U() = static_cast<float>(wedges_[2 * row]);
            corner.V() = static_cast<float>(wedges_[2 * row + 1]);
        }
    }
}
