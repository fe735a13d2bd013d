// SPDX-License-Identifier: GPL-3.0-or-later
/* What is said about holes: lines for the host's log. */
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

/* What is irregular in a mesh, and what it means for its holes; nothing for a regular one. */
std::vector<Line> describe(const HolefillDefects& defects);

/* What became of a hole, and why. */
Line describe(const holefill::Hole& hole);

/* A row of the table of holes, and its head. */
std::string table_head();
std::string table_row(const HolefillLoopInfo& loop);

#endif
