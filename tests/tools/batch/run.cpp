// How acdf batch runs jobs: within memory, the largest first, past failures; with conversions that only pretend.
#include "tools/batch/run.h"
#include "tests/tools/run.h"
#include "tools/commands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <random>
#include <thread>

namespace acdf::tools {
namespace {

/// What the conversions of a test see of each other.
struct Stage {
    std::mutex mutex;
    std::condition_variable changed;
    std::uint64_t in_use = 0, peak = 0;
    std::size_t running = 0, most_running = 0, meet = 0; ///< meet: each waits until so many run
    std::vector<std::string> started;
};

/// Converts "NAME" to a small file; "bad NAME" fails.
class Pretended : public Conversion {
public:
    explicit Pretended(Stage& stage) : stage_(stage) {}

    void add_options(CLI::App&) override {}
    void check() override {}
    std::string option_text() const override { return ""; }
    std::uint64_t memory() const override { return 0; }

    Converted convert(const Listener& listener) override {
        const std::uint64_t memory = std::stoull(source.substr(source.rfind(' ') + 1));
        std::unique_lock lock(stage_.mutex);
        stage_.started.push_back(source);
        stage_.peak = std::max(stage_.peak, stage_.in_use += memory);
        stage_.most_running = std::max(stage_.most_running, ++stage_.running);
        stage_.changed.notify_all();
        stage_.changed.wait_for(lock, std::chrono::seconds(20), [&] { return stage_.most_running >= stage_.meet; });
        lock.unlock();
        listener.progress(0.5, "pretending");
        listener.note("pretended");
        std::this_thread::yield();
        lock.lock();
        stage_.in_use -= memory;
        --stage_.running;
        if (source.compare(0, 3, "bad") == 0) throw Failure(source + ": is bad\nindeed");
        return {test::small_environment(), 0.125, {}, ""};
    }

private:
    Stage& stage_;
};

class BatchRun : public testing::Test {
protected:
    test::Folder folder;
    Stage stage;
    std::vector<PlannedJob> plan;

    void add(const std::string& name, std::uint64_t memory) {
        PlannedJob planned;
        planned.job.kind = find_kind("env");
        planned.job.source = name + " " + std::to_string(memory);
        planned.job.output = std::to_string(plan.size()) + ".acdf";
        planned.memory = memory;
        plan.push_back(planned);
    }

    std::vector<JobResult> run(int workers, std::uint64_t memory, const BatchWatcher& watcher = {}) {
        return run_jobs(
            plan, folder / ".", {4, workers, memory},
            [&](const BatchJob& job) {
                auto conversion = std::make_shared<Pretended>(stage);
                conversion->source = job.source;
                return conversion;
            },
            watcher);
    }
};

TEST_F(BatchRun, StaysWithinMemoryAndStartsWithTheLargest) {
    std::mt19937 random(3);
    for (int i = 0; i < 200; ++i) add("job", 1 + random() % 100);
    add("largest", 150);
    for (const JobResult& result : run(8, 160)) EXPECT_EQ(result.status, JobResult::Status::done) << result.error;
    EXPECT_EQ(stage.started.size(), plan.size());
    // Small jobs fit beside it and may report their start first.
    const auto first = stage.started.begin() + 8;
    EXPECT_NE(std::find(stage.started.begin(), first, "largest 150"), first);
    EXPECT_LE(stage.peak, 160u);
    EXPECT_EQ(folder.entries(), plan.size());
}

TEST_F(BatchRun, RunsAsManyAtOnceAsItMay) {
    for (int i = 0; i < 9; ++i) add("job", 10);
    stage.meet = 3;
    run(3, 1000);
    EXPECT_EQ(stage.most_running, 3u);
    stage.meet = stage.most_running = 0;
    run(3, 20);
    EXPECT_LE(stage.most_running, 2u) << "memory for two";
    stage.most_running = 0;
    run(1, 1000);
    EXPECT_EQ(stage.most_running, 1u);
}

TEST_F(BatchRun, ReportsEachEndOnceAndGoesOnPastFailures) {
    add("job", 1);
    add("bad job", 2);
    add("too large", 1001);
    add("job", 3);
    plan[3].due = false;
    plan[3].bytes = 77;
    std::vector<std::string> ended;
    double last = 0.0;
    const std::vector<JobResult> results = run(2, 1000, [&](double share, const JobResult* result) {
        EXPECT_GE(share, last);
        last = share;
        if (result) ended.push_back(result->output);
    });
    ASSERT_EQ(results.size(), 4u);
    EXPECT_EQ(results[0].status, JobResult::Status::done);
    EXPECT_EQ(results[0].relative_variance, 0.125);
    EXPECT_EQ(results[0].notes, std::vector<std::string>{"pretended"});
    EXPECT_EQ(results[1].error, "bad job 2: is bad indeed");
    EXPECT_NE(results[2].error.find("raise --memory"), std::string::npos) << results[2].error;
    EXPECT_EQ(results[3].status, JobResult::Status::up_to_date);
    EXPECT_EQ(results[3].bytes, 77u);
    std::sort(ended.begin(), ended.end());
    EXPECT_EQ(ended, (std::vector<std::string>{"0.acdf", "1.acdf", "2.acdf"}));
    EXPECT_NEAR(last, 1.0, 1e-12);
    EXPECT_EQ(stage.started.size(), 2u);
    EXPECT_EQ(folder.entries(), 1u) << "no litter of the job that failed";
}

} // namespace
} // namespace acdf::tools
