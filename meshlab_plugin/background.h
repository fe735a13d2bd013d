// SPDX-License-Identifier: GPL-3.0-or-later
/* Runs work on its own thread and reports progress to the host. */
#ifndef HOLEFILL_MESHLAB_BACKGROUND_H
#define HOLEFILL_MESHLAB_BACKGROUND_H

#include <wrap/callback.h>

#include <holefill.hpp>

#include <functional>

/* Runs `work` on another thread and waits for it. The host's function may be null. It is called about 20 times a
 * second, and only on the calling thread, because it uses the host's windows. If it returns false, the work is
 * canceled. An exception of the work or of the host's function is thrown again after the work has ended.
 *
 * `work` must pass the function that it gets to the library, as its progress function. */
void run_in_background(vcg::CallBackPos* callback,
                       const std::function<void(const holefill::Options::Progress&)>& work);

#endif
