// Processor time of a thread.
#pragma once

#include <ctime>

namespace acdf::measure {

/// Processor time of this thread: what else runs on the machine does not count, but for the caches it takes.
class Stopwatch {
public:
    double nanoseconds() const { return now() - begin_; }

private:
    static double now() {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
    }
    double begin_ = now();
};

} // namespace acdf::measure
