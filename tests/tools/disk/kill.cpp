// Programs that are ended at random moments.
#include "tests/tools/disk/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

using namespace acdf::test;
using Clock = std::chrono::steady_clock;

namespace {

std::string npy_of(std::uint32_t seed) {
    std::string dict = "{'descr': '<f4', 'fortran_order': False, 'shape': (24, 24), }";
    while ((10 + dict.size() + 1) % 64 != 0) dict += ' ';
    dict += '\n';
    std::string file("\x93NUMPY\x01\x00", 8);
    file += static_cast<char>(dict.size());
    file += static_cast<char>(dict.size() >> 8);
    file += dict;
    std::mt19937 rng(seed);
    for (int i = 0; i < 24 * 24; ++i) {
        const auto value = static_cast<float>(rng() % 1000);
        file.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    return file;
}

constexpr int signals[] = {SIGKILL, SIGINT, SIGTERM, SIGKILL};

void sleep_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Contents that differ in every part.
std::string content(int which) {
    std::string text;
    for (int i = 0; i < 3000; ++i) text += static_cast<char>('a' + (i + which) % 26);
    return text;
}

// Replaces a file for ever, as the program writes its outputs.
int keep_replacing(const std::string& path) {
    for (int which = 0;; which = 1 - which) {
        const std::string text = content(which);
        acdf::tools::Output output(path, true);
        for (std::size_t at = 0; at < text.size(); at += 500) output.write(text.substr(at, 500));
        output.commit([](const std::uint8_t*, std::size_t) {});
    }
}

// Ended two hundred times at a random moment: each file is whole, and the next run removes what was left over.
TEST(Kill, atAnyMomentTheFileIsWhole) {
    const Folder folder;
    const std::string out = folder / "out", where = std::filesystem::path(out).parent_path().string();
    write_text(out, content(0));
    std::mt19937 rng(7);
    std::size_t most = 0, litters = 0;
    for (int n = 0; n < 200; ++n) {
        const pid_t pid = fork();
        ASSERT_GE(pid, 0);
        if (pid == 0) {
            std::signal(SIGINT, SIG_DFL); // which jobs in the background of a script ignore
            _exit(keep_replacing(out));
        }
        sleep_for(1e-5 * static_cast<double>(rng() % 1000));
        kill(pid, signals[n % 4]);
        EXPECT_EQ(wait_for(pid), 128 + signals[n % 4]);
        const std::string now = read_text(out);
        ASSERT_TRUE(now == content(0) || now == content(1)) << "round " << n << ": " << now.size() << " bytes";
        litters += !litter(where).empty();
        most = std::max(most, litter(where).size());
    }
    std::printf("left over after %zu of 200\n", litters);
    EXPECT_GT(litters, 10u) << "else no moment within a write was met";
    EXPECT_LE(most, 1u) << "they must not pile up";
    EXPECT_EQ(in_child([&] {
                  acdf::tools::Output output(out, true);
                  output.write("the end");
                  output.commit();
                  return 0;
              }),
              0);
    EXPECT_EQ(read_text(out), "the end");
    EXPECT_EQ(folder.entries(), 1u);
}

// The same of the whole program, fewer times, as it takes a while to start.
TEST(Kill, theProgramLeavesWholeFilesToo) {
    const Folder folder;
    const std::string out = folder / "out.acdf";
    const auto arguments = [&](int which) {
        return std::vector<std::string>{
            "table", folder / std::to_string(which), "-o", out, "--force", "--cells", "64", "--quiet", "--threads",
            "1"};
    };
    std::string whole[2];
    double seconds = 0.0;
    for (int which : {0, 1}) {
        write_text(folder / std::to_string(which), npy_of(static_cast<std::uint32_t>(which)));
        const auto start = Clock::now();
        const Result result = run_acdf(arguments(which));
        ASSERT_EQ(result.code, 0) << result.err;
        seconds = std::chrono::duration<double>(Clock::now() - start).count();
        whole[which] = read_text(out);
    }
    ASSERT_NE(whole[0], whole[1]);
    std::mt19937 rng(7);
    std::string before = whole[1];
    for (int n = 0; n < 12; ++n) {
        const pid_t pid = start_acdf(arguments(n % 2), "/dev/null", "/dev/null", "/dev/null");
        ASSERT_GT(pid, 0);
        sleep_for(seconds * static_cast<double>(rng() % 1200) / 1000.0);
        kill(pid, signals[n % 4]);
        const int code = wait_for(pid);
        const std::string now = read_text(out);
        ASSERT_TRUE(now == before || now == whole[n % 2]) << "round " << n << ": " << now.size() << " bytes";
        if (code == 0) {
            EXPECT_EQ(now, whole[n % 2]);
        }
        before = now;
    }
    ASSERT_EQ(run_acdf(arguments(0)).code, 0);
    EXPECT_EQ(read_text(out), whole[0]);
    EXPECT_EQ(folder.entries(), 3u);
}

} // namespace
