// Meshes as plain arrays, and the files that the tests read and write: binary PLY and text OFF.
#ifndef HOLEFILL_JUDGE_MESH_FILE_H
#define HOLEFILL_JUDGE_MESH_FILE_H

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace judge {

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

struct Arrays {
    std::vector<Point> points;
    std::vector<Triangle> triangles;
};

// Binary little endian PLY with triangles. Throws std::runtime_error.
Arrays read_ply(const std::string& path);
void write_ply(const std::string& path, const Arrays& arrays);

// OFF with polygons, which are cut into fans. Throws std::runtime_error.
Arrays read_off(const std::string& path);

}  // namespace judge

#endif
