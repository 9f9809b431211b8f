// The parts of acdf batch: manifests, names, shards, reports.
#include "tests/inputs/sanitized.h"
#include "tests/tools/run.h"
#include "tools/batch/jobs.h"
#include "tools/batch/manifest.h"
#include "tools/batch/report.h"
#include "tools/batch/shard.h"
#include "tools/cli/temporary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>
#include <set>

namespace acdf::tools {
namespace {

using test::Folder;
using test::write_text;

std::string error_of(const std::string& line) {
    const Manifest manifest = parse_manifest("{\"source\":\"a.exr\"}\n\n" + line + "\n");
    EXPECT_EQ(manifest.jobs.size() + manifest.errors.size(), 2u) << line;
    if (manifest.errors.size() != 1) return "accepted";
    EXPECT_EQ(manifest.errors[0].line, 3u);
    return manifest.errors[0].what;
}

TEST(BatchManifest, ReadsAllMembersOfALine) {
    const Manifest manifest =
        parse_manifest("{\"source\": \"sky.exr\", \"kind\": \"local\", \"output\": \"a/b.acdf\", "
                       "\"options\": {\"budget\": \"64KiB\", \"no-sharing\": true, \"scene-rgb\": false, \"eps\": "
                       "0.001, \"cells\": 12}}\r\n"
                       "{\"source\": \"\\u00e9.exr\", \"options\": [\"--budget\", \"2MB\"]}");
    ASSERT_TRUE(manifest.errors.empty()) << manifest.errors[0].what;
    ASSERT_EQ(manifest.jobs.size(), 2u);
    const ManifestJob& first = manifest.jobs[0];
    EXPECT_EQ(first.source, "sky.exr");
    EXPECT_EQ(first.kind, find_kind("local"));
    EXPECT_EQ(first.output, "a/b.acdf");
    EXPECT_EQ(*first.options,
              (std::vector<std::string>{"--budget=64KiB", "--no-sharing", "--eps=0.001", "--cells=12"}));
    EXPECT_EQ(manifest.jobs[1].line, 2u);
    EXPECT_EQ(manifest.jobs[1].source, "\xc3\xa9.exr");
    EXPECT_EQ(manifest.jobs[1].kind, nullptr);
    EXPECT_EQ(*manifest.jobs[1].options, (std::vector<std::string>{"--budget", "2MB"}));
}

TEST(BatchManifest, ReadsSeveralMapsAndOptionsThatAreGivenSeveralTimes) {
    const Manifest manifest = parse_manifest("{\"maps\": [\"a.exr\", \"day.##.exr\"], \"output\": \"day.acdf\", "
                                             "\"options\": {\"axis\": [\"x=1,2\", \"y=3,4\"], \"sun\": []}}");
    ASSERT_TRUE(manifest.errors.empty()) << manifest.errors[0].what;
    const ManifestJob& job = manifest.jobs.at(0);
    EXPECT_EQ(job.source, "");
    EXPECT_EQ(job.maps, (std::vector<std::string>{"a.exr", "day.##.exr"}));
    EXPECT_EQ(*job.options, (std::vector<std::string>{"--axis=x=1,2", "--axis=y=3,4"}));
}

TEST(BatchManifest, ReportsWhatIsWrongWithALine) {
    const std::pair<const char*, const char*> cases[] = {
        {"{\"source\": \"a\", \"sauce\": 1}", "unknown key 'sauce'"},
        {"{\"source\": 7}", "'source' must be a string, not number"},
        {"{\"source\": \"a\", \"kind\": \"table\"}", "kind 'table'"},
        {"{\"source\": \"a\", \"kind\": null}", "'kind' must be a string, not null"},
        {"{\"source\": \"a\", \"options\": \"--fit cdf\"}", "'options' must be an object"},
        {"{\"source\": \"a\", \"options\": {\"cells\": [1]}}", "'cells' must be a string, a number or true"},
        {"{\"source\": \"a\", \"options\": {\"--cells\": 1}}", "without dashes"},
        {"{\"source\": \"a\", \"options\": [1]}", "'options' must be a string"},
        {"{\"source\": \"a\", \"options\": {\"cells\": 1e999}}", "out of range"},
        {"{\"source\": \"a\", \"source\": \"b\"}", "'source' twice"},
        {"{\"source\": \"a\", \"options\": {\"x\": 1, \"x\": 2}}", "'x' twice"},
        {"{\"kind\": \"env\"}", "no 'source'"},
        {"{\"source\": \"a\", \"maps\": [\"b\", \"c\"], \"output\": \"d.acdf\"}", "'source' and 'maps'"},
        {"{\"maps\": [\"b\", \"c\"]}", "no 'output'"},
        {"{\"maps\": []}", "'maps' must be an array"},
        {"{\"maps\": \"day.##.exr\"}", "'maps' must be an array"},
        {"{\"maps\": [1]}", "'maps' must be a string"},
        {"{\"source\": \"\"}", "'source' is empty"},
        {"{\"source\": \"a\\u0000b\"}", "control character"},
        {"[\"a\"]", "must be an object, not array"},
        {"\"a\"", "must be an object, not string"},
        {"{\"source\": \"a\"", "not JSON"},
        {"{\"source\": \"a\"} {}", "not JSON: error at column 17"},
        {"{\"source\": \"\xff\"}", "not UTF-8 at column 13"},
        {"{\"source\": \"\xc0\x80\"}", "not UTF-8"},
        {"{\"source\": \"\xed\xa0\x80\"}", "not UTF-8"},
        {"[[[[[[[[[[[[]]]]]]]]]]]]", "nested"},
    };
    for (const auto& [line, what] : cases)
        EXPECT_NE(error_of(line).find(what), std::string::npos) << error_of(line);
    EXPECT_NE(error_of("{\"source\": \"" + std::string(2 << 20, 'x') + "\"}").find("1 MiB"), std::string::npos);
    EXPECT_NE(error_of(std::string(100000, '[')).find("nested"), std::string::npos);
}

TEST(BatchManifest, SurvivesAnyBytes) {
    std::mt19937 random(7);
    const std::string seed = "{\"source\": \"sky.exr\", \"kind\": \"env\", \"options\": {\"cells\": 4}}\n";
    for (int i = 0; i < 20000; ++i) {
        std::string text = seed + seed;
        for (int change = 0; change < 4; ++change) text[random() % text.size()] = static_cast<char>(random());
        const Manifest manifest = parse_manifest(text.substr(0, random() % (text.size() + 1)));
        EXPECT_LE(manifest.jobs.size() + manifest.errors.size(), 6u);
    }
}

TEST(BatchManifest, HundredThousandLinesOfWhichOneIsWrong) {
    ACDF_NOT_SANITIZED();
    std::string text;
    for (int i = 0; i < 100000; ++i)
        text += i == 77776 ? "{\"source\": 1}\n" : "{\"source\": \"s" + std::to_string(i) + ".exr\"}\n";
    const Manifest manifest = parse_manifest(text);
    EXPECT_EQ(manifest.jobs.size(), 99999u);
    ASSERT_EQ(manifest.errors.size(), 1u);
    EXPECT_EQ(manifest.errors[0].line, 77777u);
}

TEST(BatchNames, OutputsStayBelowTheirFolder) {
    for (const char* good : {"a.acdf", "a/b.c/d e.acdf", "\xc3\xa9.acdf", "a/./b.acdf", "..a/b...acdf"})
        EXPECT_EQ(output_name_error(good), "") << good;
    for (const std::string& bad :
         {std::string(), std::string("/a.acdf"), std::string("../a.acdf"), std::string("a/../../b.acdf"),
          std::string("a"), std::string("a.exr"), std::string(".acdf"), std::string("a/.acdf"),
          std::string("a.acdf/"), std::string("a\0.acdf", 7), std::string("a\n.acdf"), std::string("\xff.acdf"),
          std::string(".acdf-123456.acdf"), std::string(300, 'x') + ".acdf"})
        EXPECT_NE(output_name_error(bad), "") << bad;
}

BatchJob job(const std::string& output, std::uint64_t bytes) {
    BatchJob job;
    job.kind = find_kind("env");
    job.source = output + ".exr";
    job.output = output;
    job.bytes = bytes;
    return job;
}

TEST(BatchShards, AreAllJobsOnceAndBalanced) {
    std::mt19937 random(5);
    std::vector<BatchJob> jobs;
    for (int i = 0; i < 150; ++i)
        jobs.push_back(job("j" + std::to_string(i), random() % 50000000 + (i == 100 ? 1000000000 : 0)));
    for (const std::uint32_t count : {1u, 2u, 7u, 200u}) {
        std::multiset<std::string> seen;
        std::vector<double> loads;
        for (std::uint32_t i = 1; i <= count; ++i) {
            loads.push_back(0.0);
            for (const BatchJob& mine : jobs_of_shard(jobs, {i, count})) {
                seen.insert(mine.output);
                loads.back() += mine.seconds();
            }
        }
        EXPECT_EQ(seen.size(), jobs.size());
        EXPECT_EQ(std::set<std::string>(seen.begin(), seen.end()).size(), jobs.size());
        const double largest = std::max_element(jobs.begin(), jobs.end(), [](const auto& a, const auto& b) {
                                   return a.seconds() < b.seconds();
                               })->seconds();
        const double mean = std::accumulate(loads.begin(), loads.end(), 0.0) / count;
        // The bound of Graham (1969) on scheduling the longest first.
        EXPECT_LE(*std::max_element(loads.begin(), loads.end()), std::max(largest, mean) * 4.0 / 3.0);
    }
}

TEST(BatchShards, DoNotDependOnTheOrderOfJobs) {
    std::vector<BatchJob> jobs;
    for (std::uint64_t i = 0; i < 60; ++i) jobs.push_back(job("j" + std::to_string(i), 1000 * (i / 7)));
    std::vector<BatchJob> other(jobs.rbegin(), jobs.rend());
    std::set<std::string> a, b;
    for (const BatchJob& mine : jobs_of_shard(jobs, {2, 5})) a.insert(mine.output);
    for (const BatchJob& mine : jobs_of_shard(other, {2, 5})) b.insert(mine.output);
    EXPECT_EQ(a, b);
    EXPECT_EQ(batch_id(jobs), batch_id(other));
    other[3].options.push_back("--cells=7");
    EXPECT_NE(batch_id(jobs), batch_id(other));
}

void set_slurm(const char* id, const char* first, const char* last, const char* count, const char* step) {
    const std::pair<const char*, const char*> values[] = {{"SLURM_ARRAY_TASK_ID", id},
                                                          {"SLURM_ARRAY_TASK_MIN", first},
                                                          {"SLURM_ARRAY_TASK_MAX", last},
                                                          {"SLURM_ARRAY_TASK_COUNT", count},
                                                          {"SLURM_ARRAY_TASK_STEP", step}};
    for (const auto& [name, value] : values) value ? setenv(name, value, 1) : unsetenv(name);
}

TEST(BatchShards, AreReadFromTextAndFromSlurm) {
    const Shard third = parse_shard("3/8");
    EXPECT_EQ(third.index, 3u);
    EXPECT_EQ(third.count, 8u);
    for (const char* bad : {"", "3", "0/8", "9/8", "3/", "/8", "-1/8", "3/8/9", "3 /8", "a/b", "1/99999999999"})
        EXPECT_THROW(parse_shard(bad), std::invalid_argument) << bad;
    set_slurm("9", "5", "11", "4", "2");
    EXPECT_EQ(parse_shard("slurm").index, 3u);
    EXPECT_EQ(parse_shard("slurm").count, 4u);
    set_slurm("7", "1", "7", "3", "1"); // --array=1,3,7
    EXPECT_THROW(parse_shard("slurm"), std::invalid_argument);
    set_slurm(nullptr, nullptr, nullptr, nullptr, nullptr);
    EXPECT_THROW(parse_shard("slurm"), std::invalid_argument);
}

BatchReport report(std::uint32_t index, JobResult::Status status) {
    BatchReport out;
    out.batch = "b";
    out.shard = {index, 3};
    JobResult result;
    result.output = "j" + std::to_string(9 - index);
    result.kind = "env";
    result.status = status;
    result.relative_variance = 0.25;
    result.bytes = 100;
    if (status == JobResult::Status::failed) result.error = "x.exr: is missing";
    out.jobs.push_back(result);
    return out;
}

TEST(BatchReports, ReadBackAndMerge) {
    using Status = JobResult::Status;
    const auto again = [](const BatchReport& r) { return parse_report(to_json(r)); };
    MergedReport merged = merge_reports({again(report(2, Status::failed)), again(report(1, Status::up_to_date))});
    EXPECT_EQ(merged.problems, (std::vector<std::string>{"shard 3/3 has no report"}));
    ASSERT_EQ(merged.report.jobs.size(), 2u);
    EXPECT_EQ(merged.report.jobs[0].output, "j7");
    EXPECT_EQ(merged.report.jobs[0].error, "x.exr: is missing");
    EXPECT_EQ(merged.report.jobs[1].bytes, 100u);
    merged = merge_reports(
        {report(1, Status::failed), report(2, Status::done), report(3, Status::done), report(1, Status::done)});
    EXPECT_TRUE(merged.problems.empty());
    EXPECT_EQ(merged.report.count(Status::done), 3u) << "the later report on a shard counts";

    BatchReport other = report(2, Status::done);
    other.batch = "c";
    EXPECT_THROW(merge_reports({report(1, Status::done), other}), std::invalid_argument);
    EXPECT_THROW(merge_reports({}), std::invalid_argument);
    for (const char* bad : {"", "{}", "[]", "{\"batch\": 1}"})
        EXPECT_THROW(parse_report(bad), std::invalid_argument);
}

TEST(Temporaries, OnlyStaleOnesAreRemoved) {
    const Folder folder;
    std::string live, dead;
    const int held = create_temporary(folder / ".", ".acdf", live);
    const int left = create_temporary(folder / ".", ".acdf", dead);
    ASSERT_GE(held, 0);
    ASSERT_GE(left, 0);
    close(left); // as the end of a program does
    write_text(folder / ".acdf-notes.txt", "mine");
    write_text(folder / "sky.acdf", "mine");
    EXPECT_EQ(remove_stale_temporaries(folder / "."), 1u);
    EXPECT_TRUE(std::filesystem::exists(live));
    EXPECT_FALSE(std::filesystem::exists(dead));
    EXPECT_EQ(folder.entries(), 3u);
    close(held);
    EXPECT_EQ(remove_stale_temporaries(folder / "."), 1u);
    EXPECT_EQ(remove_stale_temporaries(folder / "missing"), 0u);
}

} // namespace
} // namespace acdf::tools
