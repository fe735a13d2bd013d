// The other translation unit: see twice_a.cpp.
#include <holefill.hpp>

uint64_t loops_of(const holefill::Mesh& mesh);

uint64_t loops_of(const holefill::Mesh& mesh) { return mesh.loop_count(); }
