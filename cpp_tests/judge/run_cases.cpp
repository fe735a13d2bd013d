#include "cases.h"
#include "commands.h"
#include "exceptions.h"
#include "fill.h"
#include "judged.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>

namespace judge {

void in_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr thrown;
    std::mutex mutex;
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                const std::lock_guard<std::mutex> lock(mutex);
                if (!thrown) thrown = std::current_exception();
                next = count;
            }
        }
    };
    std::vector<std::thread> threads;
    for (unsigned k = 1; k < std::max(1u, std::thread::hardware_concurrency()); ++k) threads.emplace_back(run);
    run();
    for (std::thread& thread : threads) thread.join();
    if (thrown) std::rethrow_exception(thrown);
}

bool run_cases(const Arguments& arguments) {
    Exceptions exceptions(arguments.exceptions);
    const std::vector<Case> generated = generated_cases();
    const std::vector<std::string> names = public_case_names(arguments.cases);
    std::mutex mutex;
    std::size_t fills = 0, allowed = 0, objections = 0, cases = 0;
    in_parallel(generated.size() + names.size(), [&](std::size_t i) {
        const bool is_public = i < names.size();
        const std::string& name = is_public ? names[i] : generated[i - names.size()].name;
        if (name.find(arguments.only) == std::string::npos) return;
        const Case c = is_public ? read_public_case(arguments.cases, name) : generated[i - names.size()];
        for (const std::string& method : methods()) {
            const Fill filled = fill(c, method);
            const Verdict verdict = judge_all(filled);
            const std::lock_guard<std::mutex> lock(mutex);
            ++fills;
            for (const Finding& finding : verdict.findings) {
                const bool is_allowed = exceptions.allow(name, method, finding.check);
                ++(is_allowed ? allowed : objections);
                std::printf("%s %s %s %s: %s\n", is_allowed ? "allowed  " : "OBJECTION", name.c_str(), method.c_str(),
                            finding.check.c_str(), finding.text.c_str());
            }
            for (const std::string& check : exceptions.unseen(name, method)) {
                ++objections;
                std::printf("OBJECTION %s %s %s: is listed as an exception, but does not happen\n", name.c_str(),
                            method.c_str(), check.c_str());
            }
            std::fflush(stdout);
        }
        const std::lock_guard<std::mutex> lock(mutex);
        ++cases;
    });
    std::printf("%zu cases (%zu public), %zu fills: %zu objections, %zu allowed by name\n", cases, names.size(), fills,
                objections, allowed);
    return objections == 0;
}

}  // namespace judge
