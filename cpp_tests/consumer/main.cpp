// Closes a tetrahedron without its bottom: the program of a project that has just found the library.
#include <holefill.hpp>

#include <cstdio>

int main() {
    const std::vector<std::array<float, 3>> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    holefill::Mesh mesh = holefill::Mesh::from_arrays(positions, triangles);
    const bool is_complete = mesh.fill().is_complete();
    const auto closed = mesh.triangles();
    std::printf("holefill %s: %zu triangles, was %zu\n", holefill_version(), closed.size(), triangles.size());
    const bool is_right = is_complete && closed.size() == 4 && holefill_abi_version() == HOLEFILL_ABI_VERSION;
    return is_right ? 0 : 1;
}
