// SPDX-License-Identifier: GPL-3.0-or-later
/* Colors, quality, normals, texture coordinates and custom attributes on their way to the library and back. */
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

/* Which values new elements get from round their hole. Normals always. */
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

/* New vertices and triangles, as the library counts them. */
struct NewElements {
    std::vector<uint64_t> vertices;
    std::vector<uint64_t> faces;
    /* The corners of the faces. */
    std::vector<std::array<uint64_t, 3>> corners;
};

/* The values that the elements of a mesh have, each kind in a channel of its own. Numbers per vertex are interpolated
 * by the library, those per face and numbers of textures copied from the nearest element at the rim. Values that are
 * not carried become neutral ones: nothing is left as the host allocates it. */
class Attributes {
public:
    /* Hands the values of existing elements to the library. `model` must live longer. */
    Attributes(MeshModel& model, holefill::Mesh& mesh, const Places& places, const Carried& carried);

    /* Takes the values of new elements from the library. The host's mesh stays as it is. */
    void fetch(const holefill::Mesh& mesh, const NewElements& elements);

    /* Writes what was fetched to elements that the host has appended, in the same order. */
    void write(const NewElements& elements, const Places& added) const;

private:
    struct Channel {
        HolefillElement element;
        uint32_t components;
        HolefillType type;
        /* Reads and writes the numbers of the element at a place in the host's list. */
        std::function<void(std::size_t, double*)> read;
        std::function<void(std::size_t, const double*)> write;
        /* What new elements get without the library. */
        double fallback;
        /* The name that the library knows it by; empty when it is not carried. */
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
    /* Texture coordinates of the corners, by vertex: of existing ones, then of new ones. Empty without corners that
     * have any. */
    std::vector<double> wedges_;
    bool wedges_are_carried_ = false;
    /* The number of existing vertices. */
    std::size_t vertex_count_ = 0;
};

#endif
