// SPDX-License-Identifier: GPL-3.0-or-later
/* Rules that choose holes. */
#ifndef HOLEFILL_MESHLAB_RULES_H
#define HOLEFILL_MESHLAB_RULES_H

#include "exchange.h"

#include <holefill.hpp>

#include <cstdint>

struct Rules {
    /* Only loops with a selected face along them. */
    bool touch_selection = false;
    /* 0: no limit. */
    uint64_t max_edges = 0;
    double max_perimeter = 0.0;
    uint64_t keep_largest = 0;
};

/* The rules as a selection of the library. */
holefill::Selection to_selection(const Exchange& exchange, const Rules& rules);

#endif
