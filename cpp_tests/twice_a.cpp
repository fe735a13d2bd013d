// holefill.hpp in two translation units of one program, twice in this one.
#include <holefill.hpp>
#include <holefill.hpp>

uint64_t loops_of(const holefill::Mesh& mesh);

int main() {
    const std::vector<std::array<double, 3>> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    holefill::Mesh mesh = holefill::Mesh::from_arrays(positions, triangles);
    const bool is_right = loops_of(mesh) == 1 && mesh.fill().summary().new_triangles == 1;
    return is_right ? 0 : 1;
}
