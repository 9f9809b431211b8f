// The border of the public library: no exception crosses it, and the caller's callbacks are called one at a time.
#pragma once

#include "build/progress.h"
#include "compress/threads.h"

#include <acdf/builder.h>

#include <tbb/task_arena.h>

#include <functional>
#include <mutex>

namespace acdf::builder {

/// Reports progress to the caller. Throws build::Cancelled once it said no, and build::CallbackFailed once it
/// threw.
class Gate {
public:
    explicit Gate(const Progress& progress) : progress_(progress) {}

    void tell(double share, const char* what);
    /// For work that is the part [begin, begin + width] of the whole. Valid while this lives.
    build::Progress part(double begin, double width);

private:
    const Progress& progress_;
    std::mutex mutex_;
    double told_ = 0.0;
    bool cancelled_ = false, failed_ = false;
};

/// The exception that is being handled.
Status current_status() noexcept;

/// Throws build::OptionError unless `holds`.
void require(bool holds, const char* what);

/// Runs `work(gate)` on the threads asked for, and `clear()` where it fails.
template <class Work, class Clear>
Status guarded(const Control& control, const Work& work, const Clear& clear) noexcept {
    try {
        require(control.threads >= 0, "control.threads is negative");
        Gate gate(control.progress);
        gate.tell(0.0, "starting");
        const auto run = [&] { work(gate); };
        // Without a number it is the caller's own arena, whose limits count; isolated, so that waiting here does
        // not take up other work of the caller's.
        if (control.threads > 0) compress::with_threads(control.threads, run);
        else tbb::this_task_arena::isolate(run);
        gate.tell(1.0, "done");
        return {};
    } catch (...) {
        clear();
        return current_status();
    }
}

/// What is made goes into `result`, which is emptied first, and stays empty on failure.
template <class Result, class Make>
Status make_into(Result& result, const Control& control, const Make& make) noexcept {
    const auto clear = [&]() noexcept { result = Result{}; };
    clear();
    return guarded(
        control, [&](Gate& gate) { result = make(gate); }, clear);
}

} // namespace acdf::builder
