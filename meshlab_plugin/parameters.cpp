// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameters.h"

#include <common/mlexception.h>
#include <common/parameters/rich_parameter_list.h>

#if HOLEFILL_MESHLAB_YEAR >= 2023
#include <common/parameters/rich_parameters.h>
#else
#include <common/parameters/rich_parameter.h>
using RichPercentage = RichAbsPerc;
#endif

#include <cstring>

namespace {

QStringList methods() {
    QStringList names;
    for (uint64_t i = 0; i < holefill_method_count(); ++i) {
        names << holefill_method_name(i);
    }
    return names;
}

/* One line for each method. */
QString method_summaries() {
    QString text = "How holes are filled. If a patch fails a check, the next simpler method is tried.<br>";
    for (uint64_t i = 0; i < holefill_method_count(); ++i) {
        text += QString("<br><b>%1</b>: %2").arg(holefill_method_name(i), holefill_method_summary(i));
    }
    return text;
}

/* The default of a parameter of the library, as a number. */
double default_number(const char* name) {
    for (uint64_t i = 0; i < holefill_parameter_count(); ++i) {
        if (std::strcmp(holefill_parameter_name(i), name) == 0) {
            return QString(holefill_parameter_default(i)).toDouble();
        }
    }
    return 0.0;
}

uint64_t not_negative(const RichParameterList& parameters, const char* name) {
    const int value = parameters.getInt(name);
    if (value < 0) {
        throw MLException(QString("%1 must not be negative, but is %2").arg(name).arg(value));
    }
    return static_cast<uint64_t>(value);
}

/* The number of the chosen entry. A script may pass any number, so it is checked. */
int entry(const RichParameterList& parameters, const char* name, int count) {
    const int value = parameters.getEnum(name);
    if (value < 0 || value >= count) {
        throw MLException(QString("%1 has the entries 0 to %2, but not %3").arg(name).arg(count - 1).arg(value));
    }
    return value;
}

void set_named_parameters(holefill::Options& options, const QString& text) {
    for (const QString& word : text.simplified().split(' ', Qt::SkipEmptyParts)) {
        const int sign = word.indexOf('=');
        if (sign <= 0) {
            throw MLException(QString("Parameters are written as name=value, not as \"%1\"").arg(word));
        }
        options.set(word.left(sign).toUtf8().constData(), word.mid(sign + 1).toUtf8().constData());
    }
}

} // namespace

RichParameterList rule_parameters(const MeshModel& model) {
    const Scalarm diagonal = model.cm.bbox.Diag();
    RichParameterList list;
    list.addParam(RichBool("Selected", model.cm.sfn > 0, "Only holes with selected faces",
                           "Only holes with at least one selected face along their rim. If no hole has one, no hole is "
                           "chosen."));
    list.addParam(RichInt("MaxHoleSize", 0, "Max edges of a hole",
                          "Holes with more edges along their rim stay open. 0 is no limit."));
    list.addParam(RichPercentage("MaxPerimeter", 0, 0, diagonal, "Max perimeter of a hole",
                                 "Holes with a longer rim stay open. In units of the mesh, or in percent of the diagonal "
                                 "of its bounding box. 0 is no limit."));
    list.addParam(RichInt("KeepLargest", 0, "Keep the largest rims open",
                          "This number of rims, those of the largest perimeter, stay open, even if other rules choose them. "
                          "1 keeps the outer rim of most open sheets open."));
    return list;
}

RichParameterList fill_parameters(const MeshModel& model) {
    const QStringList names = methods();
    RichParameterList list;
    list.addParam(RichEnum("Method", names.indexOf("auto"), names, "Method", method_summaries()));
    list.join(rule_parameters(model));
    list.addParam(RichFloat("Density", static_cast<Scalarm>(default_number("refine.density")), "Edge length of the patch",
                            "Edge length of the new faces, in edge lengths of the rim. 2 gives about a quarter of the faces."));
    list.addParam(RichBool("RefuseSelfIntersection", false, "Refuse self-intersecting patches",
                           "If the patches of all methods intersect something, the hole stays open. Off: the patch with the "
                           "fewest intersections is used, and the log says so."));
    list.addParam(RichBool("NewFaceSelected", true, "Select the new faces and vertices",
                           "Selects the new elements, for example to smooth them. Any previous selection is lost. Off: the "
                           "selection stays as it is."));
    list.addParam(RichBool("CarryColor", true, "Continue colors",
                           "New vertices and faces get colors from the surface round the hole. Off: they are white."));
    list.addParam(RichBool("CarryQuality", true, "Continue quality and radius",
                           "New vertices and faces get values from the surface round the hole. Off: they are 0."));
    list.addParam(RichBool("CarryTexture", true, "Continue texture coordinates",
                           "New vertices and corners get coordinates from the surface round the hole. Off: they are 0."));
    list.addParam(RichBool("CarryAttributes", true, "Continue custom attributes",
                           "New vertices and faces get values of all scalar and point attributes from the surface round the "
                           "hole. Off: they are 0."));
    list.addParam(RichEnum("Mark", 0, {"nothing", "quality", "color"}, "Mark the patches",
                           "Gives all new faces and vertices the same quality or color. Existing elements without quality or "
                           "color get 0 or white."));
    list.addParam(RichFloat("MarkQuality", 1, "Quality of the mark", "Written if patches are marked by quality."));
    list.addParam(RichColor("MarkColor", QColor(255, 170, 0), "Color of the mark", "Written if patches are marked by color."));
    list.addParam(RichInt("Seed", 0, "Seed", "For methods that use random numbers. The same seed gives the same patch.", true));
    list.addParam(RichFloat("TimeBudget", 0, "Time budget",
                            "Seconds. Holes that are not finished by then stay open. 0 is no limit.", true));
    list.addParam(RichString("Parameters", "", "More parameters",
                             "Parameters of holefill as name=value, separated by spaces, for example "
                             "<i>auto.creases=false attributes.interpolator=nearest</i>.",
                             true));
    return list;
}

Rules read_rules(const RichParameterList& parameters) {
    Rules rules;
    rules.touch_selection = parameters.getBool("Selected");
    rules.max_edges = not_negative(parameters, "MaxHoleSize");
    rules.max_perimeter = static_cast<double>(parameters.getAbsPerc("MaxPerimeter"));
    rules.keep_largest = not_negative(parameters, "KeepLargest");
    return rules;
}

FillSettings read_settings(const RichParameterList& parameters) {
    FillSettings settings;
    settings.rules = read_rules(parameters);
    settings.options.method(holefill_method_name(
        static_cast<uint64_t>(entry(parameters, "Method", static_cast<int>(holefill_method_count())))));
    settings.options.density(static_cast<double>(parameters.getFloat("Density")));
    settings.options.seed(not_negative(parameters, "Seed"));
    settings.options.time_budget(static_cast<double>(parameters.getFloat("TimeBudget")));
    set_named_parameters(settings.options, parameters.getString("Parameters"));
    settings.carried.color = parameters.getBool("CarryColor");
    settings.carried.quality = parameters.getBool("CarryQuality");
    settings.carried.texture = parameters.getBool("CarryTexture");
    settings.carried.custom = parameters.getBool("CarryAttributes");
    settings.refuses_intersections = parameters.getBool("RefuseSelfIntersection");
    settings.selects_new = parameters.getBool("NewFaceSelected");
    settings.mark = static_cast<Mark>(entry(parameters, "Mark", 3));
    settings.quality = static_cast<double>(parameters.getFloat("MarkQuality"));
    settings.color = parameters.getColor4b("MarkColor");
    return settings;
}
