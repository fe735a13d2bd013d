// SPDX-License-Identifier: GPL-3.0-or-later
/* Copies meshes between the host and the library. */
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

/* Copies a mesh to the library, and copies the patches back.
 *
 * The host leaves deleted elements in its lists. The library gets only the other elements, in their order, so its
 * indices differ from those of the host. Only `append` changes the host's mesh. It appends new elements at the end.
 * Existing elements keep their place and their values, except the normals and border flags at closed rims. `append`
 * drops the host's topology. */
class Exchange {
public:
    /* Throws holefill::Exception for a mesh that the library rejects, for example because a coordinate is not finite.
     * `model` must live longer. */
    explicit Exchange(MeshModel& model);

    holefill::Mesh& mesh() { return mesh_; }
    const holefill::Mesh& mesh() const { return mesh_; }

    /* Makes the patches that are filled from now on continue these values of existing elements. */
    void carry(const Carried& carried) { attributes_ = std::make_unique<Attributes>(model_, mesh_, places_, carried); }

    /* Corners of the selected faces. */
    std::vector<std::array<uint32_t, 3>> selected_faces() const;

    /* Appends the patches of `holes`, entries of a report, to the host's mesh. Returns the places of the new elements.
     * `carry` must have been called before. */
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
