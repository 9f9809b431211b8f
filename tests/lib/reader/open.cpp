// Files by their path.
#include "tests/lib/reader/files.h"
#include "tests/lib/reader/load.h"

#include <acdf/acdf.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#define ACDF_TEST_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ACDF_TEST_ASAN 1
#endif
#endif

using namespace acdf_test;
using acdf::File;
using acdf::Status;

namespace {

class Open : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("acdf_open_" + std::to_string(getpid()) +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string write(const std::string& name, const Bytes& bytes) const {
        std::ofstream(path(name), std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return path(name);
    }

    std::filesystem::path folder_;
};

TEST_F(Open, aFileIsReadWhole) {
    for (const Bytes& bytes : {complete_environment().encode(), compressed().encode()}) {
        File file;
        const Status status = File::open(write("a.acdf", bytes).c_str(), file, acdf::with_curves());
        ASSERT_TRUE(status.ok()) << status.message;
        EXPECT_EQ(status.rule, 0);
        EXPECT_EQ(file.size(), bytes.size());
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&file.header()) % 64, 0u);
        EXPECT_EQ(std::memcmp(&file.header(), bytes.data(), bytes.size()), 0);
        EXPECT_EQ(text(file.metadata("tool")), "test 1");
    }
}

TEST_F(Open, aBrokenFileIsNamed) {
    File file;
    const std::string name = write("broken.acdf", truncated(complete_environment().encode(), 300));
    const Status status = File::open(name.c_str(), file);
    EXPECT_EQ(status.rule, 2005);
    EXPECT_TRUE(file.empty());
    const std::string message = status.message;
    EXPECT_NE(message.find("broken.acdf: truncated: 300 bytes of"), std::string::npos) << message;
}

TEST_F(Open, messagesAreOneLineOfText) {
    File file;
    std::string name = "evil\nname\x1b[2J-";
    for (int i = 0; i < 50; ++i) name += "ä";
    const Status status = File::open(write(name, {1, 2, 3}).c_str(), file);
    EXPECT_EQ(status.rule, 2002);
    for (const char* c = status.message; *c; ++c) EXPECT_GE(static_cast<unsigned char>(*c), 0x20);
    EXPECT_NE(std::strstr(status.message, "ää: this is not"), nullptr) << status.message;
    std::string folder = "missing";
    for (int i = 0; i < 100; ++i) folder += "/ä";
    EXPECT_EQ(File::open(folder.c_str(), file).rule, 1001);
}

TEST_F(Open, rule1001) {
    File file;
    const Status status = File::open(path("missing.acdf").c_str(), file);
    EXPECT_EQ(status.code, ACDF_CANNOT_OPEN);
    EXPECT_EQ(status.rule, 1001);
    EXPECT_NE(std::strstr(status.message, "missing.acdf: No such file"), nullptr) << status.message;
    EXPECT_EQ(File::open(nullptr, file).rule, 1001);
    EXPECT_EQ(File::open("", file).rule, 1001);
}

TEST_F(Open, rule1002) {
    File file;
    Status status = File::open(folder_.c_str(), file);
    EXPECT_EQ(status.code, ACDF_CANNOT_READ);
    EXPECT_EQ(status.rule, 1002);
    EXPECT_NE(std::strstr(status.message, "directory"), nullptr) << status.message;
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    status = File::open(path("pipe").c_str(), file); // and does not wait for a writer
    EXPECT_EQ(status.rule, 1002) << status.message;
    EXPECT_EQ(File::open("/dev/zero", file).rule, 1002);
}

TEST_F(Open, rule1003) {
#ifdef ACDF_TEST_ASAN
    GTEST_SKIP() << "AddressSanitizer needs the address space that this test takes away";
#else
    const std::string big = write("big.acdf", {});
    std::filesystem::resize_file(big, std::uintmax_t{2} << 30); // sparse: it is never read
    const auto open_with_little_memory = [&] {
        const rlimit limit = {512u << 20, 512u << 20};
        if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(2);
        File file;
        const Status status = File::open(big.c_str(), file);
        _exit(status.rule == 1003 && status.code == ACDF_OUT_OF_MEMORY && file.empty() ? 0 : 1);
    };
    EXPECT_EXIT(open_with_little_memory(), testing::ExitedWithCode(0), "");
#endif
}

TEST_F(Open, rule1004) {
    File file;
    const std::string big = write("big.acdf", {});
    std::filesystem::resize_file(big, (std::uintmax_t{4} << 30) + 1); // the default limit and a byte; sparse
    const Status status = File::open(big.c_str(), file);
    EXPECT_EQ(status.code, ACDF_LIMIT_EXCEEDED);
    EXPECT_EQ(status.rule, 1004) << status.message;
}

} // namespace
