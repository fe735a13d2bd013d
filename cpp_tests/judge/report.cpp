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
         "## Least weights\n\nThe exact search of `flat` and CGAL's cubic search triangulate the same loops. The judge "
         "computes both weights again: the largest dihedral angle and the area. Angle and area: the largest differences "
         "found, over a half turn and over the area. More than 1e-9 counts as different. Ties: on symmetric rims, angles "
         "may be equal except for their last bits, and rounding then chooses among areas. These rims are compared again "
         "with noise of a millionth of their size.\n"},
        {"fairing-totals.md",
         "## Fairing\n\nBoth fair the same refined patch. To CGAL, its weights: the largest distance of a vertex from "
         "CGAL's with `fair.weights=voronoi` and `fair.passes=1`, over the diameter of the hole; at most 1e-6 is "
         "allowed. To CGAL, our weights: the same with the defaults. Energy: area, squared mean curvature, or its "
         "squared slope, of the faired surface, ours by default over CGAL's. To the truth: root mean square distance "
         "from the patch, over the diameter. Each case gives its three largest holes that have three complete rings of "
         "triangles round them and up to 1,500 new vertices. With more vertices, rounding in the equations of the sixth "
         "order is too large: with 2,002 new vertices, in `island_multi`, the two were 1.2e-6 apart. Energies and "
         "distances that differ by less than a thousandth count as the same.\n"},
        {"fairing.md", "Each hole:\n"},
        {"mutations.md", "## Corrupted results\n\nThe number of results that were corrupted, and how many each judge detected.\n"},
        {"inputs.md",
         "## Inputs of CGAL's tests\n\nThe two `made_` inputs are made in code. They are of the kinds that have no patch "
         "in CGAL's tests.\n"},
        {"cases.md",
         "## Cases\n\nWe compare `flat` with CGAL's triangulation, `fair-c2` with its fairing of the second order, and "
         "all other methods with its fairing of the first order. Rims: edges of all rims. Allowed: findings named in "
         "`cpp_tests/judge/exceptions.txt`. Intersections: pairs of triangles, one of them new. Distances: two-way, over "
         "the diameter of the largest hole. `cpp_tests/judge/distances.txt` bounds those to CGAL's patch. The table "
         "shows where CGAL does not fill every hole (pinched rims, for example). Where CGAL closes an island separately, "
         "the two surfaces are different. Times: of filling alone, both in the same run, two cases at a time, on a "
         "machine with other work. Times on an idle machine are in [cgal.md](cgal.md).\n"},
    };
    // Rows of pictures that the repository contains.
    static constexpr const char* PICTURES[] = {"armpit.auto", "bunny_large.auto", "elephant_fringe.fair-c2", "goat_horns.auto",
                                               "hemisphere_bowl.auto", "sphere_half.auto", "thin_shell.flat"};
    if (arguments.output.empty()) return true;
    std::ofstream page(arguments.output + "/cross-validation.md");
    page << "# Cross-validation with CGAL and OpenMesh\n\nMade by `ctest -L \"cgal|openmesh\"`. "
            "[cpp_tests/judge](../../cpp_tests/judge/README.md) says what is checked and how to run it. The tests write "
            "this page to `cpp_tests/judge/results/cross-validation.md` in the build folder, and a row of pictures for "
            "each case and method to `pictures/`.\n";
    for (const Part& part : PARTS) {
        std::ifstream table(arguments.output + "/" + part.file);
        if (!table) continue;
        page << "\n" << part.text << "\n" << std::string(std::istreambuf_iterator<char>(table), {});
    }
    page << "\n## Pictures\n\nThe input, ours, CGAL's, and the truth. New triangles are orange, and the inside of the "
            "surface is blue. The run makes one row for each case and method.\n";
    for (const char* name : PICTURES)
        page << "\n`" << name << "`\n\n![" << name << "](../images/cross-validation/" << name << ".png)\n";
    page.close();
    return static_cast<bool>(page);
}

}  // namespace judge
