// Many threads on shared and own meshes: what they get is what one thread gets, bit for bit.
#include "check.h"
#include "sheet.h"

#include <holefill.hpp>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>

namespace {

using Points = std::vector<std::array<double, 3>>;

struct Reference {
    Sheet sheet = sheet_new();
    Points filled;
    std::vector<Points> patches;

    holefill::Mesh mesh() const {
        return holefill::Mesh::from_arrays({sheet.positions, sheet.vertex_count},
                                           {sheet.triangles, sheet.triangle_count});
    }
    Reference() {
        holefill::Mesh m = mesh();
        const auto loops = m.loop_count();
        for (uint64_t id = 0; id < loops; ++id) {
            patches.push_back(m.plan(holefill::Target::loop(id), holefill::Options().threads(1)).patch(id).positions);
        }
        CHECK(m.fill(holefill::Options().threads(1)).is_complete());
        filled = m.positions();
    }
    ~Reference() { sheet_free(&sheet); }
};

// A call that is refused because another thread is on the mesh; any other failure ends the test.
template <class Function>
bool is_done(Function function) {
    try {
        function();
        return true;
    } catch (const holefill::Exception& e) {
        CHECK(e.status() == HOLEFILL_STATUS_BUSY || e.status() == HOLEFILL_STATUS_NOTHING_TO_UNDO ||
              e.status() == HOLEFILL_STATUS_STALE_PLAN || e.status() == HOLEFILL_STATUS_INVALID_ARGUMENT);
        return false;
    }
}

// Everybody reads and plans on a mesh that nobody changes.
void read(const Reference& reference, const holefill::Mesh& shared, std::mt19937& random) {
    const uint64_t id = random() % reference.patches.size();
    switch (random() % 4) {
    case 0:
        CHECK(shared.loop(id).loop_id == id);
        break;
    case 1:
        CHECK(shared.loop_vertices(id).size() == shared.loop(id).vertex_count);
        break;
    case 2:
        CHECK(shared.info().vertex_count == reference.sheet.vertex_count);
        break;
    default:
        // The outer rim is a large hole: one call in a few dozen is enough.
        if (reference.patches[id].size() < 100) {
            const auto target = holefill::Target::loop(id);
            CHECK(shared.plan(target, holefill::Options().threads(1)).patch(id).positions == reference.patches[id]);
        }
    }
}

// Everybody fills and undoes on one mesh: calls are refused or whole.
void contend(const Reference& reference, holefill::Mesh& contended, std::mt19937& random) {
    switch (random() % 4) {
    case 0:
        is_done([&] {
            const auto target = holefill::Target::loop(random() % reference.patches.size());
            (void)contended.fill(target, holefill::Options().threads(1));
        });
        break;
    case 1:
        is_done([&] { contended.undo(); });
        break;
    case 2:
        is_done([&] { contended.loops(); });
        break;
    default:
        is_done([&] { CHECK(contended.info().vertex_count >= reference.sheet.vertex_count); });
    }
}

void own(const Reference& reference) {
    holefill::Mesh mesh = reference.mesh();
    CHECK(mesh.fill(holefill::Options().threads(1)).is_complete());
    CHECK(mesh.positions() == reference.filled);
}

} // namespace

int main(int argc, char** argv) {
    const int calls = argc > 1 ? std::atoi(argv[1]) : 10000;
    {
        const Reference reference;
        const holefill::Mesh shared = reference.mesh();
        holefill::Mesh contended = reference.mesh();
        std::vector<std::thread> threads;
        for (unsigned seed = 0; seed < 8; ++seed) {
            threads.emplace_back([&, seed] {
                std::mt19937 random(seed);
                for (int i = 0; i < calls; ++i) {
                    const unsigned choice = random() % 1000;
                    if (choice == 0) {
                        own(reference);
                    } else if (choice < 100) {
                        contend(reference, contended, random);
                    } else {
                        read(reference, shared, random);
                    }
                }
            });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        while (is_done([&] { contended.undo(); })) {
        }
        CHECK(contended.fill(holefill::Options().threads(2)).is_complete());
        CHECK(contended.positions() == reference.filled);
    }
    CHECK(holefill_handle_count() == 0);
    std::printf("threads: ok, 8 x %d calls\n", calls);
    return 0;
}
