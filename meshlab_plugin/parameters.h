// SPDX-License-Identifier: GPL-3.0-or-later
/* The parameters of the filters: as the host shows them, and as plain values. */
#ifndef HOLEFILL_MESHLAB_PARAMETERS_H
#define HOLEFILL_MESHLAB_PARAMETERS_H

#include "exchange.h"
#include "rules.h"

#include <common/parameters/rich_parameter_list.h>

#include <holefill.hpp>

/* The value that marks new elements. */
enum class Mark { Nothing, Quality, Color };

struct FillSettings {
    Rules rules;
    holefill::Options options;
    Carried carried;
    bool refuses_intersections = false;
    bool selects_new = true;
    Mark mark = Mark::Nothing;
    double quality = 0.0;
    vcg::Color4b color;
};

/* The parameters that the host shows for a mesh. */
RichParameterList rule_parameters(const MeshModel& model);
RichParameterList fill_parameters(const MeshModel& model);

/* The values that the user chose. Throw MLException for values that are not allowed. */
Rules read_rules(const RichParameterList& parameters);
FillSettings read_settings(const RichParameterList& parameters);

#endif
