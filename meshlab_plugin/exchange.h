// SPDX-License-Identifier: GPL-3.0-or-later
/* A mesh of the host, and the same mesh in the library. */
#ifndef HOLEFILL_MESHLAB_EXCHANGE_H
#define HOLEFILL_MESHLAB_EXCHANGE_H

#include "attributes.h"

#include <common/ml_document/mesh_model.h>

#include <holefill.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

/* Copies a mesh into the library, and what was filled there back.
 *
 * Deleted elements, which the host leaves in its lists, do not exist for the library: its indices are those of the
 * living ones, in their order. The host's mesh changes in `append` and nowhere else. New elements come at its end;
 * existing ones keep their place and their values, but for what follows from the faces: the normals of vertices at
 * the rims, and their border flags. The host's topology is dropped. */
class Exchange {
public:
    /* Throws holefill::Exception for a mesh that the library does not take, such as one with a coordinate that is not a
     * number. `model` must live longer. */
    explicit Exchange(MeshModel& model);

    holefill::Mesh& mesh() { return mesh_; }
    const holefill::Mesh& mesh() const { return mesh_; }

    /* Has the values of existing elements continued by what is filled from now on. */
    void carry(const Carried& carried) { attributes_ = std::make_unique<Attributes>(model_, mesh_, places_, carried); }

    /* Corners of the selected faces. */
    std::vector<std::array<uint32_t, 3>> selected_faces() const;

    /* Appends the patches of `holes`, entries of a report, to the host's mesh. Returns the places of what was appended.
     * There must have been a `carry`. */
    Places append(const std::vector<holefill::Hole>& holes);

    const Places& places() const { return places_; }

private:
    NewElements new_elements(const std::vector<holefill::Hole>& holes) const;
    void update_flags(const NewElements& elements);
    void update_normals(const Places& added);

    MeshModel& model_;
    /* Of existing elements. */
    Places places_;
    holefill::Mesh mesh_;
    std::unique_ptr<Attributes> attributes_;
};

#endif
