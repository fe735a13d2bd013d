// SPDX-License-Identifier: GPL-3.0-or-later
/* Copies colors, quality, normals, texture coordinates and custom attributes to the library and back. */
#ifndef HOLEFILL_MESHLAB_ATTRIBUTES_H
#define HOLEFILL_MESHLAB_ATTRIBUTES_H

#include <common/ml_document/mesh_model.h>

#include <holefill.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/* Which values new elements get from the surface round their hole. They always get normals. */
struct Carried {
    bool color = true;
    bool quality = true;
    bool texture = true;
    bool custom = true;
};

/* Places of the library's vertices and triangles in the host's lists. */
struct Places {
    std::vector<std::size_t> vertices;
    std::vector<std::size_t> faces;
};

/* New vertices and triangles, by their indices in the library. */
struct NewElements {
    std::vector<uint64_t> vertices;
    std::vector<uint64_t> faces;
    /* The corners of the faces. */
    std::vector<std::array<uint64_t, 3>> corners;
};

/* The values of the elements of a mesh, each kind in its own channel. The library interpolates numbers of vertices. It
 * copies numbers of faces and texture indices from the nearest element at the rim. Values that are not carried get
 * neutral values, so no new element keeps the memory contents that the host allocated. */
class Attributes {
public:
    /* Passes the values of existing elements to the library. `model` must live longer. */
    Attributes(MeshModel& model, holefill::Mesh& mesh, const Places& places, const Carried& carried);

    /* Reads the values of new elements from the library. Does not change the host's mesh. */
    void fetch(const holefill::Mesh& mesh, const NewElements& elements);

    /* Writes the fetched values to elements that the host has appended, in the same order. */
    void write(const NewElements& elements, const Places& added) const;

private:
    struct Channel {
        HolefillElement element;
        uint32_t components;
        HolefillType type;
        /* Reads and writes the numbers of the element at a place in the host's list. */
        std::function<void(std::size_t, double*)> read;
        std::function<void(std::size_t, const double*)> write;
        /* The value of new elements if the library gives none. */
        double fallback;
        /* The name in the library; empty if the channel is not carried. */
        std::string name;
        /* The values of new elements, one row after the other. */
        std::vector<double> added = {};
    };

    void collect_vertex_values(const Carried& carried);
    void collect_face_values(const Carried& carried);
    void collect_custom_values(bool is_carried);
    void collect_wedges(holefill::Mesh& mesh, const Places& places, bool is_carried);
    static void hand_over(holefill::Mesh& mesh, const Channel& channel, const std::vector<std::size_t>& places);

    MeshModel& model_;
    std::vector<Channel> channels_;
    /* Texture coordinates of corners, one pair a vertex: existing vertices, then new ones. Empty if corners have no
     * texture coordinates. */
    std::vector<double> wedges_;
    bool wedges_are_carried_ = false;
    /* The number of existing vertices. */
    std::size_t vertex_count_ = 0;
};

#endif
