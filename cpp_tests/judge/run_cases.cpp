// Fills every case by every method, lets all judges check the results, and compares them with CGAL's filling.

#include "cases.h"
#include "commands.h"
#include "exceptions.h"
#include "fill.h"
#include "judged.h"
#include "report.h"
#ifdef JUDGE_CGAL
#include "bounds.h"
#include "peers.h"
#include "picture.h"
#endif

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>

namespace judge {

namespace {

using Row = std::vector<std::string>;

const Row HEAD{"case", "method", "rims", "filled", "allowed", "intersections", "CGAL's", "to CGAL, largest",
               "to CGAL, rms", "ours to the truth", "CGAL's to the truth", "ours, ms", "CGAL's, ms"};

// The edges of the rims, and the number of filled holes.
Row first_cells(const Fill& filled, const std::vector<std::string>& allowed) {
    std::size_t edges = 0, holes = 0, closed = 0;
    for (const Hole& hole : filled.holes) {
        if (hole.kept) continue;
        edges += hole.rim.size();
        ++holes;
        closed += hole.filled;
    }
    std::string names;
    for (const std::string& name : allowed) names += (names.empty() ? "" : ", ") + name;
    return {filled.of->name, filled.method, std::to_string(edges),
            std::to_string(closed) + " of " + std::to_string(holes), names.empty() ? "–" : names};
}

#ifdef JUDGE_CGAL

// The filling of CGAL with which a method is compared: only the triangulation, or the fairing of the same order. For
// methods without a counterpart in CGAL, its default.
int continuity_for(const std::string& method) { return method == "flat" ? -1 : method == "fair-c2" ? 2 : 1; }

Arrays patch_of(const Arrays& mesh, const Case& c) {
    const auto old = static_cast<std::ptrdiff_t>(c.input.triangles.size());
    return {mesh.points, {mesh.triangles.begin() + std::min<std::ptrdiff_t>(old, mesh.triangles.end() - mesh.triangles.begin()),
                          mesh.triangles.end()}};
}

// Whether an island was joined to the patch round it. CGAL closes island and hole separately, which is another surface.
bool has_islands(const Fill& filled) {
    return std::any_of(filled.holes.begin(), filled.holes.end(),
                       [](const Hole& h) { return h.filled && h.triangle_count == 0; });
}

// CGAL's fillings of a case, each computed once, with the distances of their patches to the truth.
class Peers {
public:
    explicit Peers(const Case& c) : case_(c) {}

    struct Entry {
        PeerFill fill;
        Arrays patch;
        std::size_t intersections = 0;
        Distance to_truth;
    };
    const Entry& operator[](int continuity) {
        const auto [at, is_new] = entries_.try_emplace(continuity);
        Entry& e = at->second;
        if (is_new) {
            e.fill = fill_by_cgal(case_, continuity);
            e.patch = patch_of(e.fill.output, case_);
            e.intersections = count_intersections_by_cgal(case_, e.fill.output);
            if (!case_.truth.triangles.empty() && !e.patch.triangles.empty()) e.to_truth = distance(e.patch, case_.truth);
        }
        return e;
    }

private:
    const Case& case_;
    std::map<int, Entry> entries_;
};

// The table cells of CGAL's filling, and the distance between both over the diameter of the largest hole. There is no
// distance where CGAL does not fill every hole, or fills islands separately.
Row peer_cells(const Fill& filled, const Verdict& verdict, Peers& peers, double& apart) {
    const Case& c = *filled.of;
    const Peers::Entry& peer = peers[continuity_for(filled.method)];
    double diameter = 0.0;
    for (const Hole& hole : filled.holes)
        if (hole.filled) diameter = std::max(diameter, hole.diameter);
    const Arrays ours = patch_of(filled.output, c);
    const bool is_whole = peer.fill.failure.empty() && peer.fill.filled == peer.fill.holes;
    Row row{std::to_string(verdict.cgal.intersections)};
    if (!peer.fill.failure.empty())
        row.push_back("no result");
    else if (!is_whole)
        row.push_back("fills " + std::to_string(peer.fill.filled) + " of " + std::to_string(peer.fill.holes));
    else
        row.push_back(std::to_string(peer.intersections));
    apart = -1.0;
    if (is_whole && !ours.triangles.empty()) {
        const Distance d = distance(ours, peer.patch);
        if (has_islands(filled)) {
            row.insert(row.end(), 2, "closes the island");
        } else {
            apart = d.largest / diameter;
            row.push_back(scientific(apart));
            row.push_back(scientific(d.rms / diameter));
        }
    } else {
        row.insert(row.end(), 2, "–");
    }
    const bool has_truth = !c.truth.triangles.empty();
    row.push_back(has_truth ? scientific(distance(ours, c.truth).rms / diameter) : "–");
    row.push_back(has_truth && is_whole ? scientific(peer.to_truth.rms / diameter) : "–");
    row.push_back(scientific(1e3 * filled.seconds));
    row.push_back(scientific(1e3 * peer.fill.seconds));
    return row;
}

void draw(const Fill& filled, Peers& peers, const std::string& folder) {
    const Case& c = *filled.of;
    Arrays whole = c.input;
    const auto shift = static_cast<std::uint32_t>(whole.points.size());
    whole.points.insert(whole.points.end(), c.truth.points.begin(), c.truth.points.end());
    for (const Triangle& t : c.truth.triangles) whole.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    const Arrays& peer = peers[continuity_for(filled.method)].fill.output;
    const std::size_t old = c.input.triangles.size();
    write_row(folder + "/" + c.name + "." + filled.method + ".png", view_of(filled),
              {{&c.input, old}, {&filled.output, old}, {peer.triangles.empty() ? nullptr : &peer, old},
               {c.truth.triangles.empty() ? nullptr : &whole, old}});
}

#endif

}  // namespace

void in_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr thrown;
    std::mutex mutex;
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                const std::lock_guard<std::mutex> lock(mutex);
                if (!thrown) thrown = std::current_exception();
                next = count;
            }
        }
    };
    std::vector<std::thread> threads;
    for (unsigned k = 1; k < std::max(1u, std::thread::hardware_concurrency()); ++k) threads.emplace_back(run);
    run();
    for (std::thread& thread : threads) thread.join();
    if (thrown) std::rethrow_exception(thrown);
}

bool run_cases(const Arguments& arguments) {
    Exceptions exceptions(arguments.exceptions);
    const std::vector<Case> generated = generated_cases();
    const std::vector<std::string> names = public_case_names(arguments.cases);
    std::mutex mutex;
    std::size_t fills = 0, allowed = 0, objections = 0, cases = 0;
    std::vector<Row> rows;
#ifdef JUDGE_CGAL
    Bounds bounds(arguments.bounds);
    const std::string pictures = arguments.output.empty() ? "" : arguments.output + "/pictures";
    if (!pictures.empty()) std::filesystem::create_directories(pictures);
#endif
    in_parallel(generated.size() + names.size(), [&](std::size_t i) {
        const bool is_public = i < names.size();
        const std::string& name = is_public ? names[i] : generated[i - names.size()].name;
        if (name.find(arguments.only) == std::string::npos) return;
        const Case c = is_public ? read_public_case(arguments.cases, name) : generated[i - names.size()];
#ifdef JUDGE_CGAL
        Peers peers(c);
#endif
        for (const std::string& method : methods()) {
            const Fill filled = fill(c, method);
            Verdict verdict = judge_all(filled);
#ifdef JUDGE_CGAL
            double apart = 0.0;
            const Row cells = peer_cells(filled, verdict, peers, apart);
            if (!pictures.empty()) draw(filled, peers, pictures);
#endif
            const std::lock_guard<std::mutex> lock(mutex);
            ++fills;
#ifdef JUDGE_CGAL
            if (const std::string text = bounds.check(name, method, apart); !text.empty())
                verdict.findings.push_back({"cgal-distance", text});
#endif
            std::vector<std::string> names_of_allowed;
            for (const Finding& finding : verdict.findings) {
                const bool is_allowed = exceptions.allow(name, method, finding.check);
                ++(is_allowed ? allowed : objections);
                if (is_allowed) names_of_allowed.push_back(finding.check);
                std::printf("%s %s %s %s: %s\n", is_allowed ? "allowed  " : "OBJECTION", name.c_str(), method.c_str(),
                            finding.check.c_str(), finding.text.c_str());
            }
            for (const std::string& check : exceptions.unseen(name, method)) {
                ++objections;
                std::printf("OBJECTION %s %s %s: is listed as an exception, but does not happen\n", name.c_str(),
                            method.c_str(), check.c_str());
            }
            std::fflush(stdout);
            Row row = first_cells(filled, names_of_allowed);
#ifdef JUDGE_CGAL
            row.insert(row.end(), cells.begin(), cells.end());
#else
            row.resize(HEAD.size(), "–");
#endif
            rows.push_back(std::move(row));
        }
        const std::lock_guard<std::mutex> lock(mutex);
        ++cases;
    });
    std::sort(rows.begin(), rows.end());
    write_table(arguments.output, "cases.md", HEAD, rows);
#ifdef JUDGE_CGAL
    bounds.write(arguments.output);
#endif
    std::printf("%zu cases (%zu public), %zu fills: %zu objections, %zu allowed by name\n", cases, names.size(), fills,
                objections, allowed);
    return objections == 0;
}

}  // namespace judge
