// SPDX-License-Identifier: GPL-3.0-or-later
/* A host without windows. It loads the plugin as MeshLab does, and tests what scripts cannot test: progress,
 * cancellation, deleted elements, flags, and optional data.
 *
 *     host PLUGIN
 */
#include <common/globals.h>
#include <common/ml_document/mesh_document.h>
#include <common/mlexception.h>
#include <common/plugins/interfaces/filter_plugin.h>
#include <common/plugins/plugin_manager.h>

#include <QCoreApplication>

#include <chrono>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

int failures = 0;

void check(bool holds, const std::string& what) {
    std::cout << (holds ? "ok      " : "FAILED  ") << what << std::endl;
    failures += holds ? 0 : 1;
}

/* Calls of the callback, and its answer. */
struct Seen {
    std::vector<int> positions;
    bool is_other_thread = false;
    std::thread::id thread;
    /* It answers false at this call; 0: never. */
    std::size_t stop_at = 0;
    bool throws = false;
} seen;

bool callback(const int position, const char* text) {
    seen.positions.push_back(position);
    seen.is_other_thread = seen.is_other_thread || std::this_thread::get_id() != seen.thread;
    if (text == nullptr) {
        throw std::runtime_error("no text");
    }
    if (seen.throws) {
        throw MLException("thrown by the host");
    }
    return seen.stop_at == 0 || seen.positions.size() < seen.stop_at;
}

void start_to_look(std::size_t stop_at = 0, bool throws = false) {
    seen = Seen();
    seen.thread = std::this_thread::get_id();
    seen.stop_at = stop_at;
    seen.throws = throws;
}

/* A wavy sheet of squares. Every eighth block of 4 by 4 squares in both directions is a hole, but the border is not. */
MeshModel& sheet(MeshDocument& document, int side) {
    MeshModel& model = *document.addNewMesh("", "sheet");
    CMeshO& m = model.cm;
    using Allocator = vcg::tri::Allocator<CMeshO>;
    Allocator::AddVertices(m, static_cast<std::size_t>((side + 1) * (side + 1)));
    for (int i = 0; i <= side; ++i) {
        for (int j = 0; j <= side; ++j) {
            m.vert[static_cast<std::size_t>(i * (side + 1) + j)].P() =
                Point3m(i, j, 2 * std::sin(0.3 * i) * std::cos(0.2 * j));
        }
    }
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            if (i % 8 >= 2 && i % 8 < 6 && j % 8 >= 2 && j % 8 < 6) {
                continue;
            }
            const auto at = [&](int u, int v) { return static_cast<std::size_t>(u * (side + 1) + v); };
            Allocator::AddFace(m, at(i, j), at(i + 1, j), at(i + 1, j + 1));
            Allocator::AddFace(m, at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    model.updateBoxAndNormals();
    return model;
}

/* All data that a filter could change. */
std::vector<double> contents(const CMeshO& m, std::size_t vertices, std::size_t faces) {
    std::vector<double> all;
    for (std::size_t i = 0; i < vertices; ++i) {
        const CVertexO& v = m.vert[i];
        for (int k = 0; k < 3; ++k) {
            all.push_back(static_cast<double>(v.cP()[k]));
        }
        all.push_back(static_cast<double>(v.cQ()));
        all.push_back(static_cast<double>(v.cC()[0]));
        all.push_back(static_cast<double>(v.Flags() & ~CVertexO::BORDER));
    }
    for (std::size_t i = 0; i < faces; ++i) {
        const CFaceO& f = m.face[i];
        for (int k = 0; k < 3; ++k) {
            all.push_back(f.IsD() ? 0.0 : static_cast<double>(vcg::tri::Index(m, f.cV(k))));
        }
        all.push_back(static_cast<double>(f.Flags() & ~CFaceO::BORDER012));
    }
    return all;
}

struct Host {
    FilterPlugin* plugin = nullptr;

    const QAction* action(const char* name) const {
        for (const QAction* action : plugin->actions()) {
            if (plugin->pythonFilterName(action) == name) {
                return action;
            }
        }
        throw std::runtime_error(name);
    }
    std::map<std::string, QVariant> fill(MeshDocument& document, vcg::CallBackPos* callback,
                                         const char* method = "auto", bool selects = false) const {
        const QAction* fill = action("meshing_fill_holes_holefill");
        RichParameterList parameters = plugin->initParameterList(fill, document);
        parameters.setValue("Method", IntValue(method_number(method)));
        parameters.setValue("KeepLargest", IntValue(1));
        parameters.setValue("NewFaceSelected", BoolValue(selects));
        unsigned int mask = 0;
        return plugin->applyFilter(fill, parameters, document, mask, callback);
    }
    static int method_number(const std::string& name) { return name == "flat" ? number_of_flat : number_of_auto; }
    static int number_of_auto, number_of_flat;
};
int Host::number_of_auto = 0;
int Host::number_of_flat = 0;

void test_progress(const Host& host) {
    MeshDocument document;
    MeshModel& model = sheet(document, 96);
    start_to_look();
    const auto result = host.fill(document, callback);
    check(result.at("closed_holes").toInt() == 144, "144 holes are filled");
    check(!seen.positions.empty() && !seen.is_other_thread, "progress is told, on the host's thread");
    bool ascends = true;
    for (std::size_t i = 0; i < seen.positions.size(); ++i) {
        ascends = ascends && seen.positions[i] >= (i == 0 ? 0 : seen.positions[i - 1]) && seen.positions[i] <= 100;
    }
    check(ascends && seen.positions.back() == 100, "it ascends from 0 to 100");
    check(seen.positions.size() > 2, "it is told more than twice: " + std::to_string(seen.positions.size()));
    check(model.cm.fn == static_cast<int>(model.cm.face.size()), "the host's count of faces is right");
}

void test_cancellation(const Host& host) {
    for (const std::size_t at : {std::size_t(1), std::size_t(3)}) {
        MeshDocument document;
        MeshModel& model = sheet(document, 160);
        const std::vector<double> before = contents(model.cm, model.cm.vert.size(), model.cm.face.size());
        start_to_look(at);
        QString message;
        const auto start = std::chrono::steady_clock::now();
        try {
            host.fill(document, callback);
        } catch (const MLException& error) {
            message = error.what();
        }
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        check(message.contains("Cancelled"), "stopped at call " + std::to_string(at) + ": " + message.toStdString() +
                                                 ", after " + std::to_string(seconds) + " s");
        check(seen.positions.size() == at, "the host is not asked again");
        check(contents(model.cm, model.cm.vert.size(), model.cm.face.size()) == before, "the mesh is as it was");
        // The plugin still works.
        start_to_look();
        check(host.fill(document, nullptr, "flat").at("closed_holes").toInt() == 400, "the next call fills 400 holes");
    }
}

void test_exceptions(const Host& host) {
    MeshDocument document;
    MeshModel& model = sheet(document, 160);
    const std::vector<double> before = contents(model.cm, model.cm.vert.size(), model.cm.face.size());
    start_to_look(0, true);
    QString message;
    try {
        host.fill(document, callback);
    } catch (const MLException& error) {
        message = error.what();
    }
    check(message == "thrown by the host", "what the host's function throws arrives");
    check(contents(model.cm, model.cm.vert.size(), model.cm.face.size()) == before, "the mesh is as it was");
    message.clear();
    MeshDocument empty;
    unsigned int mask = 0;
    try {
        host.plugin->applyFilter(host.action("get_holes_report"), RichParameterList(), empty, mask, nullptr);
    } catch (const MLException& error) {
        message = error.what();
    }
    check(!message.isEmpty(), "a document without a mesh is refused: " + message.toStdString());
}

void test_deleted_elements(const Host& host) {
    using Allocator = vcg::tri::Allocator<CMeshO>;
    const auto make = [](MeshDocument& document) -> MeshModel& {
        MeshModel& model = sheet(document, 24);
        // The corner of the sheet, and an edge face: vertex 0 has no face left.
        for (const std::size_t face : {std::size_t(0), std::size_t(1), std::size_t(300)}) {
            Allocator::DeleteFace(model.cm, model.cm.face[face]);
        }
        Allocator::DeleteVertex(model.cm, model.cm.vert[0]);
        return model;
    };
    MeshDocument sparse, compact;
    CMeshO& a = make(sparse).cm;
    CMeshO& b = make(compact).cm;
    Allocator::CompactEveryVector(b);
    const std::size_t vertices = a.vert.size(), faces = a.face.size();
    const std::vector<double> before = contents(a, vertices, faces);
    host.fill(sparse, nullptr);
    host.fill(compact, nullptr);
    check(contents(a, vertices, faces) == before, "with deleted elements the others stay in their places");
    check(a.vert.size() > vertices && a.face.size() > faces, "something is appended");
    Allocator::CompactEveryVector(a);
    check(contents(a, a.vert.size(), a.face.size()) == contents(b, b.vert.size(), b.face.size()),
          "the result is that of the compact mesh");
}

void test_flags_and_enabled_data(const Host& host) {
    MeshDocument document;
    MeshModel& model = sheet(document, 24);
    CMeshO& m = model.cm;
    const int user_vertex = CVertexO::NewBitFlag(), user_face = CFaceO::NewBitFlag();
    model.updateDataMask(MeshModel::MM_FACEFACETOPO | MeshModel::MM_VERTFACETOPO | MeshModel::MM_VERTRADIUS |
                         MeshModel::MM_VERTCURVDIR | MeshModel::MM_FACECURVDIR | MeshModel::MM_FACECOLOR |
                         MeshModel::MM_FACEQUALITY | MeshModel::MM_VERTMARK | MeshModel::MM_FACEMARK |
                         MeshModel::MM_VERTTEXCOORD | MeshModel::MM_WEDGTEXCOORD);
    vcg::tri::UpdateFlags<CMeshO>::FaceBorderFromNone(m);
    vcg::tri::UpdateFlags<CMeshO>::VertexBorderFromFaceBorder(m);
    for (std::size_t i = 0; i < m.vert.size(); ++i) {
        CVertexO& v = m.vert[i];
        v.R() = 3;
        v.PD1() = v.PD2() = Point3m(1, 0, 0);
        v.K1() = v.K2() = 1;
        v.T().U() = 0.25F;
        v.T().V() = 0.75F;
        v.T().N() = 2;
        if (i % 3 == 0) {
            v.SetUserBit(user_vertex);
            v.SetS();
        }
    }
    for (std::size_t i = 0; i < m.face.size(); ++i) {
        CFaceO& f = m.face[i];
        f.C() = vcg::Color4b(10, 200, 30, 255);
        f.Q() = 5;
        for (int k = 0; k < 3; ++k) {
            f.WT(k).U() = 0.5F;
            f.WT(k).V() = 0.125F;
            f.WT(k).N() = 1;
        }
        if (i % 2 == 0) {
            f.SetUserBit(user_face);
            f.SetF(1);
            f.SetS();
        }
    }
    const std::size_t vertices = m.vert.size(), faces = m.face.size();
    const std::vector<double> before = contents(m, vertices, faces);
    check(host.fill(document, nullptr).at("closed_holes").toInt() == 9, "9 holes are filled");
    check(contents(m, vertices, faces) == before, "flags of existing elements stay, selection and user bits too");
    bool is_set = true, is_drawn = true;
    for (std::size_t i = vertices; i < m.vert.size(); ++i) {
        const CVertexO& v = m.vert[i];
        is_set = is_set && std::abs(v.cR() - 3) < 1e-6 && v.cPD1() == Point3m(0, 0, 0) && v.cK1() == 0 &&
                 std::abs(v.cT().U() - 0.25) < 1e-6 && std::abs(v.cT().V() - 0.75) < 1e-6 && v.cT().N() == 2;
        is_drawn = is_drawn && std::abs(v.cN().Norm() - 1) < 1e-6 && v.cC() == vcg::Color4b(255, 255, 255, 255);
    }
    for (std::size_t i = faces; i < m.face.size(); ++i) {
        const CFaceO& f = m.face[i];
        is_set = is_set && f.cC() == vcg::Color4b(10, 200, 30, 255) && f.cQ() == 5 && f.cPD1() == Point3m(0, 0, 0);
        for (int k = 0; k < 3; ++k) {
            is_set = is_set && std::abs(f.cWT(k).U() - 0.5) < 1e-6 && std::abs(f.cWT(k).V() - 0.125) < 1e-6 &&
                     f.cWT(k).N() == 1;
            is_drawn = is_drawn && !f.IsF(k);
        }
        is_drawn = is_drawn && std::abs(f.cN().Norm() - 1) < 1e-6 && !f.IsS();
    }
    check(is_set, "new elements have values of all kinds that are enabled");
    check(is_drawn, "and normals, colors and no hidden edges");
    // The host's own search for borders agrees with the flags that are left.
    std::vector<bool> border;
    const auto collect = [&] {
        std::vector<bool> flags;
        for (const CFaceO& f : m.face) {
            flags.insert(flags.end(), {f.IsB(0), f.IsB(1), f.IsB(2)});
        }
        for (const CVertexO& v : m.vert) {
            flags.push_back(v.IsB());
        }
        return flags;
    };
    border = collect();
    vcg::tri::UpdateFlags<CMeshO>::FaceBorderFromNone(m);
    vcg::tri::UpdateFlags<CMeshO>::VertexBorderFromFaceBorder(m);
    check(border == collect(), "border flags are right");
    check(!model.hasDataMask(MeshModel::MM_FACEFACETOPO), "old topology is dropped");
}

} // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::cerr << "one argument: the plugin" << std::endl;
        return 2;
    }
    QCoreApplication application(count, arguments);
    PluginManager manager;
    Host host;
    try {
        host.plugin = dynamic_cast<FilterPlugin*>(manager.loadPlugin(QString::fromLocal8Bit(arguments[1])));
        check(host.plugin != nullptr, "the plugin is loaded");
        MeshDocument document;
        sheet(document, 8);
        const QAction* fill = host.action("meshing_fill_holes_holefill");
        const RichParameterList parameters = host.plugin->initParameterList(fill, document);
        const auto& method = dynamic_cast<const RichEnum&>(parameters.getParameterByName("Method"));
        Host::number_of_auto = method.enumvalues.indexOf("auto");
        Host::number_of_flat = method.enumvalues.indexOf("flat");
        check(parameters.getEnum("Method") == Host::number_of_auto, "auto is the default");
        test_progress(host);
        test_cancellation(host);
        test_exceptions(host);
        test_deleted_elements(host);
        test_flags_and_enabled_data(host);
    } catch (const std::exception& error) {
        check(false, error.what());
    }
    std::cout << (failures == 0 ? "all is well" : std::to_string(failures) + " failed") << std::endl;
    return failures == 0 ? 0 : 1;
}
