// What jobs take against what `acdf batch` believes that they take, by which it starts them.
#include "tests/inputs/sanitized.h"
#include "tests/tools/batch/files.h"
#include "tests/tools/run.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sstream>

#include <sys/resource.h>

namespace acdf::test {
namespace {

using nlohmann::json;

struct Job {
    std::string kind, source, options;

    std::vector<std::string> words() const {
        std::istringstream stream(options);
        return {std::istream_iterator<std::string>(stream), {}};
    }
};

/// Peak memory of the program, in bytes.
std::uint64_t peak_of(const std::vector<std::string>& arguments, const std::string& messages) {
    const pid_t pid = start_acdf(arguments, "/dev/null", "/dev/null", messages);
    int status = 0;
    rusage used{};
    EXPECT_EQ(wait4(pid, &status, 0, &used), pid);
    EXPECT_EQ(status, 0) << read_text(messages);
    return std::uint64_t(used.ru_maxrss) << 10;
}

class BatchMemory : public testing::Test {
protected:
    Folder folder;
    const std::string noise = folder / "noise.pfm", larger = folder / "larger.pfm",
                      largest = folder / "largest.pfm", tiny = folder / "tiny.pfm", disc = folder / "disc.pfm";

    void SetUp() override {
        write_small_probe(noise, 1, 128);  // the worst there is: every texel is worth a cell of its own
        write_small_probe(larger, 1, 256); // of so many that what a tree takes counts
        write_small_probe(largest, 1, 512);
        write_small_probe(tiny, 1, 2);
        write_float_map(disc, 16, 16, std::vector<float>(3 * 16 * 16, 0.5f));
    }

    std::uint64_t peak(const Job& job) const {
        std::vector<std::string> arguments{job.kind, job.source, "-o", folder / "x.acdf", "--force", "--quiet"};
        for (const std::string& word : job.words()) arguments.push_back(word);
        return peak_of(arguments, folder / "messages");
    }

    std::vector<std::uint64_t> estimates(const std::vector<Job>& jobs) const {
        std::string lines;
        for (std::size_t i = 0; i < jobs.size(); ++i)
            lines += json{{"source", jobs[i].source},
                          {"kind", jobs[i].kind},
                          {"options", jobs[i].words()},
                          {"output", std::to_string(i) + ".acdf"}}
                         .dump() +
                     "\n";
        write_text(folder / "jobs.jsonl", lines);
        const Result planned =
            run_acdf({"batch", folder / "jobs.jsonl", "-o", folder / "out", "--dry-run", "--json"});
        EXPECT_EQ(planned.code, 0) << planned.err;
        std::vector<std::uint64_t> out(jobs.size(), 0);
        const json report = json::parse(planned.out);
        for (const json& job : report) out.at(std::stoul(job.at("output").get<std::string>())) = job.at("memory");
        return out;
    }
};

/// An estimate is exceeded by no more than this, the program's own memory not counted.
constexpr double kMostOver = 1.3;
/// Where a job takes much, no estimate is so many times more: it would be refused for nothing.
constexpr double kMostUnder = 3.0;
constexpr std::uint64_t kMuch = 64 << 20;

TEST_F(BatchMemory, JobsTakeAboutWhatIsEstimated) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
    std::vector<Job> jobs;
    for (const char* options : {"",
                                "--cells 4000",
                                "--cells 40000 --filter nearest",
                                "--budget 4KiB",
                                "--budget 128KiB",
                                "--budget 1MiB",
                                "--budget 1MiB --compress zlib",
                                "--target-variance 0.05",
                                "--target-variance 0.001 --filter nearest",
                                "--budget 32KiB --channel rgb",
                                "--budget 32KiB --channel max --filter nearest",
                                "--budget 32KiB --domain octahedral",
                                "--budget 1MiB --domain octahedral --channel rgb",
                                "--budget 64KiB --max-weight 6 --filter nearest",
                                "--target-variance 0.05 --max-weight 3 --filter nearest",
                                "--budget 64KiB --mis cosine",
                                "--budget 64KiB --mis mean --domain octahedral",
                                "--bad-pixels clamp",
                                "--fit cdf",
                                "--fit pdf --order z",
                                "--fit uniform --channel rgb"})
        jobs.push_back({"env", larger, options});
    for (const char* options : {"--budget 1MiB", "--budget 256KiB --mis cosine --filter nearest"})
        jobs.push_back({"env", largest, options});
    jobs.push_back({"env", disc, "--projection angular --cells 100"}); // cut into half a million cells
    for (const char* options : {"--budget 32KiB", "--budget 128KiB", "--budget 64KiB --domain octahedral",
                                "--budget 128KiB --compress zlib", "--budget 64KiB --mis cosine",
                                "--budget 64KiB --mis cosine --heuristic power --domain octahedral",
                                "--budget 128KiB --channel rgb", "--budget 64KiB --normals 3 --max-weight 40",
                                "--budget 96KiB --cosine-share 0.2", "--no-sharing --fit cdf --normals 2"})
        jobs.push_back({"local", noise, options});
    const std::string mesh = folder / "floor.obj";
    write_text(mesh, "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 1\nv 1 0 1\nf 1 2 3 4\nf 5 6 3\n");
    jobs.push_back({"local", noise, "--budget 128KiB --visibility --scene " + mesh});
    for (const char* options : {"--budget 12KiB --views 4", "--fit cdf --views 6", "--cells 40 --views 4",
                                "--budget 12KiB --views 4x4", "--budget 12KiB --views 4 --max-weight 10"})
        jobs.push_back({"brdf", "lambert", options});
    ASSERT_GE(jobs.size(), 40u);
    const std::vector<std::uint64_t> estimated = estimates(jobs);
    const std::uint64_t program = peak({"env", tiny, "--cells 2"}); // with the module of images
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const std::uint64_t used = peak(jobs[i]), beside = used - std::min(used, program);
        EXPECT_LE(double(beside), kMostOver * double(estimated[i])) << jobs[i].kind << " " << jobs[i].options;
        if (beside > kMuch) {
            EXPECT_LE(double(estimated[i]), kMostUnder * double(beside)) << jobs[i].kind << " " << jobs[i].options;
        }
        std::printf("%s %s: %llu of %llu MiB\n", jobs[i].kind.c_str(), jobs[i].options.c_str(),
                    static_cast<unsigned long long>(beside >> 20),
                    static_cast<unsigned long long>(estimated[i] >> 20));
    }
}

/// A table of as many numbers as the larger probe has pixels.
void write_noise_table(const std::string& path) {
    constexpr int kRows = 256, kColumns = 512;
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (256, 512), }";
    header.resize(117, ' ');
    std::string bytes = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + '\n';
    std::uint32_t state = 7;
    for (int i = 0; i < kRows * kColumns; ++i) {
        state = state * 1664525u + 1013904223u;
        const float value = static_cast<float>(state >> 8) * 0x1p-24f;
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    write_text(path, bytes);
}

TEST_F(BatchMemory, TablesTakeTheMemoryOfTheirPage) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
    const std::string table = folder / "noise.npy";
    write_noise_table(table);
    constexpr std::uint64_t kNumbers = 256 * 512, told = (16 << 20) + 900 * kNumbers; // docs/table.md
    const std::uint64_t program = peak_of({"--version"}, folder / "messages"); // without the module of images
    for (const char* options : {"--cells 200000", "--budget 16KiB", "--budget 16MiB", "--target-variance 0.0001",
                                "--budget 512KiB --max-weight 1.9", "--target-variance 0.01 --max-weight 1.5",
                                "--indexed 1 --target-variance 0.01 --max-weight 1.5"}) {
        const std::uint64_t used = peak({"table", table, options}), beside = used - std::min(used, program);
        EXPECT_LE(beside, told) << options;
        std::printf("table %s: %llu of %llu MiB\n", options, static_cast<unsigned long long>(beside >> 20),
                    static_cast<unsigned long long>(told >> 20));
    }
}

} // namespace
} // namespace acdf::test
