// SPDX-License-Identifier: GPL-3.0-or-later
#include "background.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

namespace {

/* Time between two calls of the host's function. It draws a bar, so 20 calls a second are enough. */
constexpr std::chrono::milliseconds PERIOD(50);

/* What the two threads share. */
struct State {
    std::mutex mutex;
    std::condition_variable changed;
    bool is_done = false;
    bool is_stopped = false;
    HolefillProgress progress{};
    std::exception_ptr thrown;
};

/* False if the host cancels the work. */
bool tell(vcg::CallBackPos* callback, const HolefillProgress& progress) {
    if (callback == nullptr) {
        return true;
    }
    if (progress.holes_total == 0) {
        return callback(0, "Finding holes");
    }
    const std::string text =
        "Filled " + std::to_string(progress.holes_done) + " of " + std::to_string(progress.holes_total) + " holes";
    return callback(static_cast<int>(100 * progress.holes_done / progress.holes_total), text.c_str());
}

} // namespace

void run_in_background(vcg::CallBackPos* callback,
                       const std::function<void(const holefill::Options::Progress&)>& work) {
    State state;
    const auto progress = [&state](const HolefillProgress& progress) {
        const std::lock_guard<std::mutex> lock(state.mutex);
        state.progress = progress;
        return !state.is_stopped;
    };
    std::thread worker([&] {
        std::exception_ptr thrown;
        try {
            work(progress);
        } catch (...) {
            thrown = std::current_exception();
        }
        const std::lock_guard<std::mutex> lock(state.mutex);
        state.thrown = thrown;
        state.is_done = true;
        state.changed.notify_one();
    });

    std::exception_ptr thrown_by_host;
    std::unique_lock<std::mutex> lock(state.mutex);
    while (!state.changed.wait_for(lock, PERIOD, [&state] { return state.is_done; })) {
        if (state.is_stopped) {
            continue;
        }
        const HolefillProgress reached = state.progress;
        lock.unlock();
        bool goes_on = false;
        try {
            goes_on = tell(callback, reached);
        } catch (...) {
            thrown_by_host = std::current_exception();
        }
        lock.lock();
        state.is_stopped = !goes_on;
    }
    lock.unlock();
    worker.join();
    if (thrown_by_host || state.thrown) {
        std::rethrow_exception(thrown_by_host ? thrown_by_host : state.thrown);
    }
    if (callback != nullptr) {
        callback(100, "Done");
    }
}
