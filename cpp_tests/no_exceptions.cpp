// holefill.hpp compiled without exceptions: failures are values.
#define HOLEFILL_NO_EXCEPTIONS
#include <holefill.hpp>

#include "check.h"
#include "sheet.h"

int main() {
    Sheet sheet = sheet_new();
    const holefill::Rows<3> positions(sheet.positions, sheet.vertex_count);
    const holefill::Rows<3> triangles(sheet.triangles, sheet.triangle_count);
    holefill::Expected<holefill::Mesh> mesh = holefill::Mesh::from_arrays(positions, triangles);
    CHECK(mesh && mesh.failure().status == HOLEFILL_STATUS_OK);
    const auto missing = mesh->fill(holefill::Target::loop(1000));
    CHECK(!missing && missing.failure().status == HOLEFILL_STATUS_NOT_FOUND);
    CHECK(!missing.failure().message.empty());
    const auto report = mesh->fill();
    CHECK(report && report->is_complete() && report->summary().value().filled == sheet.hole_count + 1);
    CHECK(mesh->undo().has_value() && !mesh->undo().has_value());
    holefill::Options options;
    CHECK(!options.set("nonsense", "1") && options.set("refine.density", "2"));
    const std::array<double, 3> bad[] = {{0, 0, 0}};
    CHECK(holefill::Mesh::from_arrays({bad[0].data(), 1}, triangles).failure().status ==
          HOLEFILL_STATUS_INDEX_OUT_OF_RANGE);
    sheet_free(&sheet);
    std::puts("no exceptions: ok");
    return 0;
}
