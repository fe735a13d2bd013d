// SPDX-License-Identifier: GPL-3.0-or-later
/* Describes holes, in lines for the host's log. */
#ifndef HOLEFILL_MESHLAB_REPORT_H
#define HOLEFILL_MESHLAB_REPORT_H

#include <holefill.hpp>

#include <string>
#include <vector>

/* A line of the log. */
struct Line {
    bool is_warning = false;
    std::string text;
};

/* The defects of a mesh, and what they mean for its holes. Empty for a mesh without defects. */
std::vector<Line> describe(const HolefillDefects& defects);

/* The result for a hole, and its reason. */
Line describe(const holefill::Hole& hole);

/* A row of the table of holes, and its head. */
std::string table_head();
std::string table_row(const HolefillLoopInfo& loop);

#endif
