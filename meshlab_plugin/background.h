// SPDX-License-Identifier: GPL-3.0-or-later
/* Work on a thread of its own, while the host is told how far it is. */
#ifndef HOLEFILL_MESHLAB_BACKGROUND_H
#define HOLEFILL_MESHLAB_BACKGROUND_H

#include <wrap/callback.h>

#include <holefill.hpp>

#include <functional>

/* Does `work` on another thread and waits for it. The host's function, which may be null, is called about 20 times a
 * second, on the calling thread only, since it touches the host's windows. When it answers false, the work is
 * stopped. Whatever the work or the host's function throws is thrown again when the work has ended.
 *
 * `work` gets the function that it must hand to the library as its progress. */
void run_in_background(vcg::CallBackPos* callback,
                       const std::function<void(const holefill::Options::Progress&)>& work);

#endif
