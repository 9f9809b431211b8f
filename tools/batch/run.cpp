#include "tools/batch/run.h"

#include "tools/cli/file_input.h"
#include "tools/cli/messages.h"
#include "tools/cli/output.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

/// Measures its own life time.
struct Stopwatch {
    double& seconds;
    Clock::time_point start = Clock::now();
    ~Stopwatch() { seconds = std::chrono::duration<double>(Clock::now() - start).count(); }
};

JobResult result_of(const PlannedJob& planned) {
    JobResult result;
    result.input = planned.job.source;
    result.output = planned.job.output;
    result.kind = planned.job.kind->name;
    if (planned.due) return result;
    result.status = JobResult::Status::up_to_date;
    result.bytes = planned.bytes;
    result.relative_variance = planned.relative_variance;
    return result;
}

void convert(const BatchJob& job, const std::string& folder, const MakeConversion& make,
             const build::Progress& progress, JobResult& result) {
    const std::shared_ptr<Conversion> conversion = make(job);
    const fs::path path = fs::path(folder) / job.output;
    make_folder(path.parent_path().string());
    const Stopwatch watch{result.seconds}; // the job's own work
    Output output(path.string(), true,
                  input_paths(*conversion)); // an existing output was found to be an older file of the same job
    const Converted made = conversion->convert(
        {progress, [&](const std::string& note) { result.notes.push_back(on_one_line(note)); }});
    output.write(made.bytes.data(), made.bytes.size());
    output.commit(check_reads_back);
    result.bytes = made.bytes.size();
    result.relative_variance = made.relative_variance;
    result.status = JobResult::Status::done;
}

void run_job(const BatchJob& job, const std::string& folder, const MakeConversion& make,
             const build::Progress& progress, JobResult& result) {
    try {
        convert(job, folder, make, progress, result);
    } catch (const std::bad_alloc&) {
        result.status = JobResult::Status::failed;
        result.error = job.source + ": out of memory; a smaller --memory or fewer --jobs would help";
    } catch (const std::exception& error) {
        result.error = on_one_line(error.what());
    }
}

/// What runs, and what is next.
class Queue {
public:
    Queue(const std::vector<PlannedJob>& plan, const BatchLimits& limits) : plan_(plan), free_(limits.memory) {
        for (std::size_t i = 0; i < plan.size(); ++i)
            if (plan[i].due && plan[i].memory <= limits.memory) waiting_.push_back(i);
        std::stable_sort(waiting_.begin(), waiting_.end(), [&](std::size_t a, std::size_t b) {
            return plan[a].memory != plan[b].memory ? plan[a].memory > plan[b].memory
                                                    : plan[a].job.seconds() > plan[b].job.seconds();
        });
    }

    /// The first job whose memory is free. What an ending job gives back is enough for the first that waits, as
    /// that is smaller: it cannot starve.
    bool take(std::size_t& job) {
        const auto next =
            std::find_if(waiting_.begin(), waiting_.end(), [&](std::size_t i) { return plan_[i].memory <= free_; });
        if (next == waiting_.end()) return false;
        job = *next;
        waiting_.erase(next);
        free_ -= plan_[job].memory;
        return true;
    }

    void give_back(std::size_t job) {
        free_ += plan_[job].memory;
        changed_.notify_all();
    }

    void wait(std::unique_lock<std::mutex>& lock) { changed_.wait(lock); }
    std::size_t size() const { return waiting_.size(); }

private:
    const std::vector<PlannedJob>& plan_;
    std::deque<std::size_t> waiting_;
    std::uint64_t free_;
    std::condition_variable changed_;
};

class Runner {
public:
    Runner(const std::vector<PlannedJob>& plan, const std::string& folder, const BatchLimits& limits,
           const MakeConversion& make, const BatchWatcher& watcher)
        : plan_(plan), folder_(folder), limits_(limits), make_(make), watcher_(watcher), queue_(plan, limits),
          shares_(plan.size()) {
        for (const PlannedJob& planned : plan) {
            results_.push_back(result_of(planned));
            if (planned.due) all_seconds_ += planned.job.seconds();
        }
    }

    std::vector<JobResult> run() {
        refuse_too_large();
        const std::size_t count = std::min(static_cast<std::size_t>(limits_.workers), queue_.size());
        std::vector<std::thread> workers = start(count);
        if (workers.empty()) work();
        for (std::thread& worker : workers) worker.join();
        return std::move(results_);
    }

private:
    /// As many workers as there is memory for, and threads that this user may have: fewer do the same jobs.
    std::vector<std::thread> start(std::size_t count) {
        std::vector<std::thread> workers;
        workers.reserve(count);
        try {
            while (workers.size() < count) workers.emplace_back([this] { work(); });
        } catch (const std::bad_alloc&) {
        } catch (const std::system_error&) {
        }
        return workers;
    }

    void refuse_too_large() {
        for (std::size_t i = 0; i < plan_.size(); ++i) {
            if (!plan_[i].due || plan_[i].memory <= limits_.memory) continue;
            results_[i].error = plan_[i].job.source + ": needs about " + to_readable_size(plan_[i].memory) +
                                " of memory, more than the " + to_readable_size(limits_.memory) +
                                " that jobs may take; raise --memory (and `ulimit -v`), or give a smaller source";
            tell_end(i);
        }
    }

    void work() {
        tbb::task_arena arena; // of all cores: set_running() says how many serve it
        std::unique_lock lock(mutex_);
        bool running = false;
        const auto set = [&](bool now) {
            if (now != running) set_running(running_ + (now ? 1 : -1));
            running = now;
        };
        while (queue_.size() > 0) {
            std::size_t job = 0;
            const bool taken = queue_.take(job);
            set(taken);
            if (!taken) {
                queue_.wait(lock);
                continue;
            }
            lock.unlock();
            run_in(arena, job);
            lock.lock();
            queue_.give_back(job);
            tell_end(job);
        }
        set(false);
    }

    /// Exceptions here were thrown while there was no memory to report them, or for a thread of the arena.
    void run_in(tbb::task_arena& arena, std::size_t job) noexcept {
        JobResult& result = results_[job]; // this job's alone
        try {
            arena.execute([&] { run_job(plan_[job].job, folder_, make_, progress_of(job), result); });
        } catch (const std::bad_alloc&) { // texts are short: a string holds them by itself
            result.status = JobResult::Status::failed;
            result.error = "out of memory";
        } catch (...) {
            result.status = JobResult::Status::failed;
            result.error = "out of threads";
        }
    }

    /// The threads that run no job are there for the loops of those that do. `mutex_` is held. Where there is no
    /// memory for another limit the one before stays: no file depends on it.
    void set_running(int running) noexcept {
        running_ = running;
        const auto helpers = static_cast<std::size_t>(std::max(0, limits_.threads - std::max(1, running)));
        if (helpers == helpers_ && limit_) return;
        try {
            // The limit counts one thread that calls.
            auto next =
                std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, helpers + 1);
            limit_ = std::move(next);
            helpers_ = helpers;
        } catch (const std::exception&) {
        }
    }

    build::Progress progress_of(std::size_t job) {
        return [this, job](double share, const char*) {
            const std::unique_lock lock(mutex_, std::try_to_lock);
            if (lock && watcher_) tell(job, share, nullptr);
        };
    }

    /// Where there is no memory to report it now, the report at the end has it.
    void tell_end(std::size_t job) noexcept {
        try {
            if (watcher_) tell(job, 1.0, &results_[job]);
        } catch (const std::exception&) {
        }
    }

    void tell(std::size_t job, double share, const JobResult* result) {
        done_seconds_ += (share - shares_[job]) * plan_[job].job.seconds();
        shares_[job] = share;
        watcher_(all_seconds_ > 0.0 ? done_seconds_ / all_seconds_ : 1.0, result);
    }

    const std::vector<PlannedJob>& plan_;
    const std::string& folder_;
    const BatchLimits limits_;
    const MakeConversion& make_;
    const BatchWatcher& watcher_;
    std::mutex mutex_; // guards all below
    Queue queue_;
    std::vector<JobResult> results_;
    std::vector<double> shares_; // of each job that is done
    double all_seconds_ = 0.0, done_seconds_ = 0.0;
    int running_ = 0;
    std::size_t helpers_ = 0;
    std::unique_ptr<tbb::global_control> limit_;
};

} // namespace

std::vector<JobResult> run_jobs(const std::vector<PlannedJob>& plan, const std::string& folder,
                                const BatchLimits& limits, const MakeConversion& make,
                                const BatchWatcher& watcher) {
    return Runner(plan, folder, limits, make, watcher).run();
}

} // namespace acdf::tools
