// Rows of pictures of a hole: the input, and what closes it.
#ifndef HOLEFILL_JUDGE_PICTURE_H
#define HOLEFILL_JUDGE_PICTURE_H

#include "model.h"

#include <string>

namespace judge {

// A mesh whose triangles from `first_new` on are drawn in another color.
struct Scene {
    const Arrays* mesh = nullptr;
    std::size_t first_new = 0;
};

// The view: a circle of `radius` round `center`, seen from the side of `normal`.
struct View {
    Point center{}, normal{};
    double radius = 1.0;
};

// A view of the hole of largest diameter, from outside.
View view_of(const Fill& fill);

// Writes the scenes side by side as PNG. A scene without a mesh stays empty. Throws std::runtime_error.
void write_row(const std::string& path, const View& view, const std::vector<Scene>& scenes);

}  // namespace judge

#endif
