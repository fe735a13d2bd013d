#include "report.h"

#include "commands.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace judge {

std::string scientific(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

void write_table(const std::string& folder, const std::string& file, const std::vector<std::string>& head,
                 const std::vector<std::vector<std::string>>& rows) {
    if (folder.empty()) return;
    std::filesystem::create_directories(folder);
    const std::string path = folder + "/" + file;
    std::ofstream out(path);
    const auto line = [&](const std::vector<std::string>& cells) {
        out << "|";
        for (const std::string& cell : cells) out << " " << cell << " |";
        out << "\n";
    };
    line(head);
    line(std::vector<std::string>(head.size(), "---"));
    for (const auto& row : rows) line(row);
    out.close();
    if (!out) throw std::runtime_error("cannot write " + path);
}

bool run_report(const Arguments& arguments) {
    struct Part {
        const char *file, *text;
    };
    static constexpr Part PARTS[] = {
        {"weights.md",
         "## Least weights\n\nThe exact search of `flat` and CGAL's cubic search find triangulations of loops; both are weighed "
         "anew, by the largest dihedral angle and the area. Angle and area: the largest differences found, over a half turn "
         "and over the area; more than 1e-9 counts as different. Ties: angles that are equal but for their last bits, on "
         "symmetrical rims, for which rounding chooses among areas; these rims are compared again with noise of a millionth "
         "of their size.\n"},
        {"fairing-totals.md",
         "## Fairing\n\nThe same refined patch faired by both. To CGAL, its weights: the largest distance of a vertex from "
         "CGAL's with `fair.weights=voronoi` and `fair.passes=1`, over the diameter of the hole; at most 1e-6 is allowed. To "
         "CGAL, our weights: the same with the defaults. Energy: area, squared mean curvature, or squared slope of it, of "
         "the faired surface as it is, ours by default over CGAL's. To the truth: root mean square from the patch, over the "
         "diameter. The three largest holes of each case with three complete rings of triangles round them, of up to 1,500 "
         "new vertices: beyond, the equations of the sixth order lose more digits to rounding (with 2,002 new vertices, in "
         "`island_multi`, the two were 1.2e-6 apart). Energies and distances that differ by less than a thousandth count as the same.\n"},
        {"fairing.md", "The single holes:\n"},
        {"mutations.md", "## Corrupted results\n\nHow many were caught, and by which judge.\n"},
        {"inputs.md",
         "## Inputs of CGAL's tests\n\nTwo are made in code after the kinds of input that have no patch there.\n"},
        {"cases.md",
         "## Cases\n\nOurs beside CGAL's: `flat` beside its triangulation, `fair-c2` beside its fairing of the second order, "
         "all others beside its fairing of the first. Rims: edges of all rims. Allowed: findings named in "
         "`cpp_tests/judge/exceptions.txt`. Intersections: pairs of triangles, one of them new. Distances: two-way, over the "
         "diameter of the largest hole; to CGAL's patch they are bounded by `cpp_tests/judge/distances.txt`. Where CGAL does "
         "not fill every hole (pinched rims, for example) the table says so, and where it closes an island by itself the two "
         "are different surfaces. Times: of filling alone, both in the same run, two cases at a time: what else the "
         "machine does is in them. Times on an idle machine are in [cgal.md](cgal.md).\n"},
    };
    // Rows that are part of the repository.
    static constexpr const char* PICTURES[] = {"armpit.auto", "bunny_large.auto", "elephant_fringe.fair-c2", "goat_horns.auto",
                                               "hemisphere_bowl.auto", "sphere_half.auto", "thin_shell.flat"};
    if (arguments.output.empty()) return true;
    std::ofstream page(arguments.output + "/cross-validation.md");
    page << "# Cross-validation with CGAL and OpenMesh\n\nMade by `ctest -L \"cgal|openmesh\"`; see "
            "[cpp_tests/judge](../../cpp_tests/judge/README.md) for what is checked and how to run it. The page is "
            "`cpp_tests/judge/results/cross-validation.md` in the build folder, with a row of pictures for each case and method "
            "in `pictures/`.\n";
    for (const Part& part : PARTS) {
        std::ifstream table(arguments.output + "/" + part.file);
        if (!table) continue;
        page << "\n" << part.text << "\n" << std::string(std::istreambuf_iterator<char>(table), {});
    }
    page << "\n## Pictures\n\nThe input, ours, CGAL's, and the truth; what is new is orange, and the inside of the surface is "
            "blue. The run makes one row for each case and method.\n";
    for (const char* name : PICTURES)
        page << "\n`" << name << "`\n\n![" << name << "](../images/cross-validation/" << name << ".png)\n";
    page.close();
    return static_cast<bool>(page);
}

}  // namespace judge
