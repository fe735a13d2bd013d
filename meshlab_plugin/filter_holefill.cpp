// SPDX-License-Identifier: GPL-3.0-or-later
#include "filter_holefill.h"

#include "background.h"
#include "exchange.h"
#include "parameters.h"
#include "report.h"
#include "rim_edges.h"
#include "rules.h"

#include <common/mlexception.h>

#include <vcg/complex/algorithms/update/selection.h>

#include <algorithm>
#include <new>

namespace {

/* Turns all exceptions into the host's own: it catches no others. */
template <class Function>
auto with_host_errors(Function function) {
    try {
        return function();
    } catch (const MLException&) {
        throw;
    } catch (const holefill::Exception& error) {
        if (error.status() == HOLEFILL_STATUS_CANCELLED) {
            throw MLException("Cancelled: the mesh was not changed");
        }
        QString text = QString::fromStdString(error.what());
        if (error.status() == HOLEFILL_STATUS_NOT_FINITE) {
            text += ". Coordinates must be finite: remove such vertices first";
        }
        throw MLException(text);
    } catch (const std::bad_alloc&) {
        throw MLException("There is not enough memory");
    } catch (const std::exception& error) {
        throw MLException(QString::fromLocal8Bit(error.what()));
    } catch (...) {
        throw MLException("holefill: unexpected error");
    }
}

/* The loops that a patch closes: its own, and those of islands in it. */
std::vector<uint64_t> loops_closed_by(const holefill::Hole& hole, const RimEdges& rims, const holefill::Mesh& mesh) {
    std::vector<uint64_t> loops;
    std::vector<std::array<uint64_t, 3>> triangles = mesh.triangles<uint64_t>(hole.first_triangle);
    triangles.resize(static_cast<std::size_t>(hole.triangle_count));
    for (const std::array<uint64_t, 3>& corners : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const int64_t loop = rims.loop(corners[(k + 1) % 3], corners[k]);
            if (loop >= 0) {
                loops.push_back(static_cast<uint64_t>(loop));
            }
        }
    }
    return loops;
}

/* Marks the holes whose patch intersects something as holes that stay open. */
void refuse_intersections(std::vector<holefill::Hole>& holes, const holefill::Mesh& mesh) {
    const RimEdges rims(mesh);
    std::vector<uint64_t> refused;
    for (const holefill::Hole& hole : holes) {
        if (hole.self_intersections > 0) {
            const std::vector<uint64_t> loops = loops_closed_by(hole, rims, mesh);
            refused.insert(refused.end(), loops.begin(), loops.end());
        }
    }
    std::sort(refused.begin(), refused.end());
    for (holefill::Hole& hole : holes) {
        if (std::binary_search(refused.begin(), refused.end(), hole.loop_id)) {
            hole.status = HOLEFILL_HOLE_FAILED;
            hole.cause = HOLEFILL_CAUSE_GEOMETRY;
            hole.reason = hole.self_intersections > 0 ? "the patch with the fewest intersections has " +
                                                            std::to_string(hole.self_intersections)
                                                      : "the patch of the hole round it has intersections";
            hole.vertex_count = hole.triangle_count = hole.self_intersections = 0;
        }
    }
}

/* Writes the mark. Elements that had no such values get neutral ones. */
void write_mark(MeshModel& model, const Places& added, const FillSettings& settings) {
    CMeshO& m = model.cm;
    if (settings.mark == Mark::Quality) {
        if (!model.hasPerVertexQuality()) {
            for (CVertexO& vertex : m.vert) {
                vertex.Q() = 0;
            }
        }
        const bool is_new = !model.hasPerFaceQuality();
        model.updateDataMask(MeshModel::MM_VERTQUALITY | MeshModel::MM_FACEQUALITY);
        for (std::size_t i = 0; is_new && i < m.face.size(); ++i) {
            m.face[i].Q() = 0;
        }
        for (const std::size_t vertex : added.vertices) {
            m.vert[vertex].Q() = static_cast<Scalarm>(settings.quality);
        }
        for (const std::size_t face : added.faces) {
            m.face[face].Q() = static_cast<Scalarm>(settings.quality);
        }
    } else if (settings.mark == Mark::Color) {
        if (!model.hasPerVertexColor()) {
            for (CVertexO& vertex : m.vert) {
                vertex.C() = vcg::Color4b(vcg::Color4b::White);
            }
        }
        const bool is_new = !model.hasPerFaceColor();
        model.updateDataMask(MeshModel::MM_VERTCOLOR | MeshModel::MM_FACECOLOR);
        for (std::size_t i = 0; is_new && i < m.face.size(); ++i) {
            m.face[i].C() = vcg::Color4b(vcg::Color4b::White);
        }
        for (const std::size_t vertex : added.vertices) {
            m.vert[vertex].C() = settings.color;
        }
        for (const std::size_t face : added.faces) {
            m.face[face].C() = settings.color;
        }
    }
}

/* Selects these elements and no others. */
void select(CMeshO& m, const Places& places) {
    vcg::tri::UpdateSelection<CMeshO>::VertexClear(m);
    vcg::tri::UpdateSelection<CMeshO>::FaceClear(m);
    for (const std::size_t vertex : places.vertices) {
        m.vert[vertex].SetS();
    }
    for (const std::size_t face : places.faces) {
        m.face[face].SetS();
    }
}

/* The mask of the data that a fill changes in this mesh. */
unsigned int written_data(const MeshModel& model) {
    const int data = MeshModel::MM_VERTCOLOR | MeshModel::MM_FACECOLOR | MeshModel::MM_VERTQUALITY |
                     MeshModel::MM_FACEQUALITY | MeshModel::MM_VERTTEXCOORD | MeshModel::MM_WEDGTEXCOORD;
    return static_cast<unsigned int>(MeshModel::MM_GEOMETRY_AND_TOPOLOGY_CHANGE | (data & model.dataMask()));
}

QVariant integer(uint64_t value) { return QVariant(static_cast<int>(value)); }

} // namespace

FilterHolefill::FilterHolefill() {
    typeList = {FILL_HOLES, SELECT_RIMS, REPORT_HOLES};
    for (const ActionIDType type : types()) {
        actionList.push_back(new QAction(filterName(type), this));
    }
}

QString FilterHolefill::pluginName() const { return "FilterHolefill"; }

QString FilterHolefill::vendor() const { return "holefill"; }

QString FilterHolefill::filterName(ActionIDType filter) const {
    switch (filter) {
    case FILL_HOLES:
        return "Fill Holes (holefill)";
    case SELECT_RIMS:
        return "Select Hole Rims";
    case REPORT_HOLES:
        return "Holes Report";
    default:
        return QString();
    }
}

QString FilterHolefill::pythonFilterName(ActionIDType filter) const {
    switch (filter) {
    case FILL_HOLES:
        return "meshing_fill_holes_holefill";
    case SELECT_RIMS:
        return "compute_selection_from_hole_rims";
    case REPORT_HOLES:
        return "get_holes_report";
    default:
        return QString();
    }
}

QString FilterHolefill::filterInfo(ActionIDType filter) const {
    switch (filter) {
    case FILL_HOLES:
        return "Closes holes by patches with the density and the curvature of the surface round them. Every patch is "
               "checked: it is manifold, oriented like the mesh, and tested for intersections with the mesh, with "
               "itself and with other patches. Existing vertices and faces stay as they are. The patches continue "
               "colors, quality, texture coordinates and custom attributes. A hole that cannot be filled stays open, "
               "and the log says why. Meshes with edges of more than two faces are allowed.<br>See:<br>"
               "<i>Peter Liepa</i><br><b>\"Filling holes in meshes\"</b><br>Symposium on Geometry Processing, 2003.<br>"
               "<i>Mario Botsch, Leif Kobbelt</i><br><b>\"An intuitive framework for real-time freeform modeling\"</b><br>"
               "SIGGRAPH, 2004.";
    case SELECT_RIMS:
        return "Selects the vertices and faces along the rims of holes. The rules are those of the filter Fill Holes "
               "(holefill), so this shows which holes it would fill. Any previous selection is lost.";
    case REPORT_HOLES:
        return "Lists the boundary loops of the mesh in the log: edges, perimeter, diameter of the bounding box, planarity "
               "(0 is planar), kind of rim, and the two vertices of one edge. The mesh stays as it is.";
    default:
        return QString();
    }
}

FilterPlugin::FilterClass FilterHolefill::getClass(const QAction* action) const {
    switch (ID(action)) {
    case FILL_HOLES:
        return Remeshing;
    case SELECT_RIMS:
        return Selection;
    case REPORT_HOLES:
        return Measure;
    default:
        return Generic;
    }
}

FilterPlugin::FilterArity FilterHolefill::filterArity(const QAction*) const { return SINGLE_MESH; }

int FilterHolefill::getPreConditions(const QAction*) const { return MeshModel::MM_FACENUMBER; }

int FilterHolefill::postCondition(const QAction* action) const {
    switch (ID(action)) {
    case FILL_HOLES:
        return MeshModel::MM_GEOMETRY_AND_TOPOLOGY_CHANGE;
    case SELECT_RIMS:
        return MeshModel::MM_VERTFLAGSELECT | MeshModel::MM_FACEFLAGSELECT;
    default:
        return MeshModel::MM_NONE;
    }
}

RichParameterList FilterHolefill::initParameterList(const QAction* action, const MeshModel& model) {
    switch (ID(action)) {
    case FILL_HOLES:
        return fill_parameters(model);
    case SELECT_RIMS:
        return rule_parameters(model);
    default:
        return RichParameterList();
    }
}

std::map<std::string, QVariant> FilterHolefill::applyFilter(const QAction* action, const RichParameterList& parameters,
                                                            MeshDocument& document, unsigned int& postConditionMask,
                                                            vcg::CallBackPos* callback) {
    MeshModel* const model = document.mm();
    if (model == nullptr) {
        throw MLException("There is no mesh");
    }
    return with_host_errors([&]() -> Values {
        switch (ID(action)) {
        case FILL_HOLES:
            return fillHoles(parameters, *model, postConditionMask, callback);
        case SELECT_RIMS:
            return selectRims(parameters, *model);
        case REPORT_HOLES:
            return reportHoles(*model);
        default:
            wrongActionCalled(action);
            return {};
        }
    });
}

FilterHolefill::Values FilterHolefill::fillHoles(const RichParameterList& parameters, MeshModel& model,
                                                 unsigned int& mask, vcg::CallBackPos* callback) const {
    FillSettings settings = read_settings(parameters);
    Exchange exchange(model);
    exchange.carry(settings.carried);
    const holefill::Selection selection = to_selection(exchange, settings.rules);
    std::vector<holefill::Hole> holes;
    run_in_background(callback, [&](const holefill::Options::Progress& progress) {
        settings.options.on_progress(progress);
        holes = exchange.mesh().fill(selection, settings.options).holes();
    });
    if (settings.refuses_intersections) {
        refuse_intersections(holes, exchange.mesh());
    }

    const Places added = exchange.append(holes);
    write_mark(model, added, settings);
    if (settings.selects_new) {
        select(model.cm, added);
    }
    mask = written_data(model);

    for (const Line& line : describe(exchange.mesh().defects())) {
        log(line.is_warning ? GLLogStream::WARNING : GLLogStream::FILTER, line.text);
    }
    uint64_t filled = 0, kept = 0, intersections = 0;
    for (const holefill::Hole& hole : holes) {
        const Line line = describe(hole);
        log(line.is_warning ? GLLogStream::WARNING : GLLogStream::FILTER, line.text);
        filled += hole.status == HOLEFILL_HOLE_FILLED ? 1 : 0;
        kept += hole.status == HOLEFILL_HOLE_KEPT ? 1 : 0;
        intersections += hole.self_intersections;
    }
    const uint64_t failed = holes.size() - filled - kept;
    log(failed > 0 ? GLLogStream::WARNING : GLLogStream::FILTER,
        "Closed " + std::to_string(filled) + " of " + std::to_string(holes.size()) + " holes with " +
            std::to_string(added.faces.size()) + " faces and " + std::to_string(added.vertices.size()) + " vertices; " +
            std::to_string(failed) + " could not be closed, " + std::to_string(kept) + " were not chosen");
    return {{"closed_holes", integer(filled)},
            {"failed_holes", integer(failed)},
            {"kept_holes", integer(kept)},
            {"new_faces", integer(added.faces.size())},
            {"new_vertices", integer(added.vertices.size())},
            {"self_intersections", integer(intersections)}};
}

FilterHolefill::Values FilterHolefill::selectRims(const RichParameterList& parameters, MeshModel& model) const {
    const Exchange exchange(model);
    const std::vector<uint64_t> chosen = exchange.mesh().find_loops(to_selection(exchange, read_rules(parameters)));
    const RimEdges rims(exchange.mesh());
    const std::vector<std::array<uint32_t, 3>> triangles = exchange.mesh().triangles();
    Places rim;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        bool is_at_rim = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const uint32_t from = triangles[i][k], to = triangles[i][(k + 1) % 3];
            const int64_t loop = rims.loop(from, to);
            if (loop >= 0 && std::binary_search(chosen.begin(), chosen.end(), static_cast<uint64_t>(loop))) {
                is_at_rim = true;
                rim.vertices.push_back(exchange.places().vertices[from]);
                rim.vertices.push_back(exchange.places().vertices[to]);
            }
        }
        if (is_at_rim) {
            rim.faces.push_back(exchange.places().faces[i]);
        }
    }
    std::sort(rim.vertices.begin(), rim.vertices.end());
    rim.vertices.erase(std::unique(rim.vertices.begin(), rim.vertices.end()), rim.vertices.end());
    select(model.cm, rim);
    log("Selected the rims of " + std::to_string(chosen.size()) + " of " +
        std::to_string(exchange.mesh().loop_count()) + " holes: " +
        std::to_string(rim.vertices.size()) + " vertices, " + std::to_string(rim.faces.size()) + " faces");
    return {{"selected_holes", integer(chosen.size())},
            {"selected_vertices", integer(rim.vertices.size())},
            {"selected_faces", integer(rim.faces.size())}};
}

FilterHolefill::Values FilterHolefill::reportHoles(MeshModel& model) const {
    const Exchange exchange(model);
    for (const Line& line : describe(exchange.mesh().defects())) {
        log(line.is_warning ? GLLogStream::WARNING : GLLogStream::FILTER, line.text);
    }
    const std::vector<HolefillLoopInfo> loops = exchange.mesh().loops();
    uint64_t edges = 0;
    double longest = 0.0, total = 0.0;
    if (!loops.empty()) {
        log(table_head());
    }
    for (const HolefillLoopInfo& loop : loops) {
        log(table_row(loop));
        edges += loop.edge_count;
        total += loop.perimeter;
        longest = std::max(longest, loop.perimeter);
    }
    log(std::to_string(loops.size()) + " holes");
    return {{"holes", integer(loops.size())},
            {"rim_edges", integer(edges)},
            {"total_perimeter", QVariant(total)},
            {"longest_perimeter", QVariant(longest)}};
}
