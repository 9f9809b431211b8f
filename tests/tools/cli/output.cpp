// Outputs are whole or not there, and never replace anything unasked.
#include "tests/inputs/float_map.h"
#include "tests/tools/disk/files.h"

#include "tools/cli/output.h"
#include "tools/commands.h"

#include <csignal>
#include <thread>

#include <sys/stat.h>

using namespace acdf::test;
using acdf::tools::Failure;
using acdf::tools::Output;
using acdf::tools::write_output;

namespace {

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Failure& failure) {
        return failure.what();
    }
    return "";
}

class Outputs : public testing::Test {
protected:
    Folder folder;
    std::string target = folder / "result.bin";
};

TEST_F(Outputs, WritesAllBytesAndLeavesNothingElse) {
    write_output(target, new_bytes, false);
    EXPECT_EQ(read_text(target), "new!");
    EXPECT_EQ(folder.entries(), 1u);
    struct stat status = {};
    ASSERT_EQ(stat(target.c_str(), &status), 0);
    const mode_t mask = umask(0);
    umask(mask);
    EXPECT_EQ(status.st_mode & 0777u, 0666u & ~mask) << "not the private mode of a temporary file";
}

TEST_F(Outputs, KeepsAnExistingFileUnlessForced) {
    write_bytes(target, old_bytes);
    EXPECT_NE(message_of([&] { write_output(target, new_bytes, false); }).find("--force"), std::string::npos);
    EXPECT_EQ(read_text(target), "old");
    ASSERT_EQ(chmod(target.c_str(), 0640), 0);
    write_output(target, new_bytes, true);
    EXPECT_EQ(read_text(target), "new!");
    struct stat status = {};
    ASSERT_EQ(stat(target.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0640u);
    if (geteuid() == 0) { // who may give files away does not take them, either
        ASSERT_EQ(chown(target.c_str(), 12345, 12346), 0);
        write_output(target, new_bytes, true);
        ASSERT_EQ(stat(target.c_str(), &status), 0);
        EXPECT_EQ(status.st_uid, 12345u);
        EXPECT_EQ(status.st_gid, 12346u);
        EXPECT_EQ(status.st_mode & 0777u, 0640u);
    }
    EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(Outputs, KeepsAFileThatAppearsMeanwhile) {
    Output output(target, false);
    output.write("new");
    write_bytes(target, old_bytes);
    EXPECT_NE(message_of([&] { output.commit(); }).find("appeared"), std::string::npos);
    EXPECT_EQ(read_text(target), "old");
}

TEST_F(Outputs, VerifySeesTheBytesAndCanRefuseThem) {
    write_bytes(target, old_bytes);
    std::vector<std::uint8_t> seen;
    const auto refuse = [&](const std::uint8_t* data, std::size_t size) {
        seen.assign(data, data + size);
        throw Failure("refused");
    };
    EXPECT_EQ(message_of([&] { write_output(target, new_bytes, true, {}, refuse); }), "refused");
    EXPECT_EQ(seen, new_bytes);
    EXPECT_EQ(read_text(target), "old");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(Outputs, GivesALibraryAPathWithTheExtension) {
    Output output(folder / "picture.png", false);
    const std::string temporary = output.temporary();
    EXPECT_EQ(std::filesystem::path(temporary).extension(), ".png");
    EXPECT_EQ(std::filesystem::path(temporary).parent_path(), std::filesystem::path(folder / "x").parent_path());
    write_text(temporary, "written by name");
    output.commit();
    EXPECT_EQ(read_text(folder / "picture.png"), "written by name");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(Outputs, FollowsASymbolicLink) {
    write_bytes(target, old_bytes);
    std::filesystem::create_symlink(target, folder / "link");
    write_output(folder / "link", new_bytes, true);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(read_text(target), "new!");
}

TEST_F(Outputs, FollowsLinksToWhatDoesNotExistYet) {
    std::filesystem::create_directory(folder / "far");
    std::filesystem::create_symlink("far/made", folder / "link"); // from where the link lies
    std::filesystem::create_symlink("link", folder / "twice");
    write_output(folder / "twice", new_bytes, false);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "twice"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(read_text(folder / "far/made"), "new!");
    std::filesystem::create_symlink("circle", folder / "circle");
    EXPECT_NE(message_of([&] { write_output(folder / "circle", new_bytes, true); }).find("circle"),
              std::string::npos);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "circle"));
}

TEST_F(Outputs, WritesToDevicesAndLeavesThem) {
    write_output("/dev/null", new_bytes, false);
    EXPECT_NE(message_of([&] { write_output("/dev/full", new_bytes, true); }).find("No space left"),
              std::string::npos);
    struct stat status = {};
    for (const char* device : {"/dev/null", "/dev/full"})
        EXPECT_TRUE(stat(device, &status) == 0 && S_ISCHR(status.st_mode)) << device;
}

TEST_F(Outputs, RefusesFoldersAndInputs) {
    write_bytes(target, old_bytes);
    EXPECT_NE(message_of([&] { Output(folder / ".", true); }).find("is a folder"), std::string::npos);
    EXPECT_NE(message_of([&] { Output(folder / "no/such/file", true); }).find("does not exist"), std::string::npos);
    EXPECT_NE(message_of([&] { Output("", true); }), "");
    std::filesystem::create_hard_link(target, folder / "same");
    EXPECT_NE(message_of([&] { Output(target, true, {folder / "same"}); }).find("same file"), std::string::npos);
    EXPECT_EQ(folder.entries(), 2u);
}

TEST_F(Outputs, RefusesAFolderThatCannotBeWritten) {
    const std::string sealed = folder / "sealed";
    std::filesystem::create_directory(sealed);
    ASSERT_EQ(chmod(sealed.c_str(), 0500), 0);
    if (access("/proc/version", R_OK) == 0) { // where even root cannot create files
        const std::string message = message_of([&] { Output("/proc/acdf", false); });
        EXPECT_NE(message.find("cannot create a file in /proc"), std::string::npos) << message;
    }
    if (access(sealed.c_str(), W_OK) == 0) return; // root may write anywhere else
    EXPECT_NE(message_of([&] { Output(sealed + "/file", false); }).find("Permission denied"), std::string::npos);
    EXPECT_EQ(chmod(sealed.c_str(), 0700), 0);
}

TEST_F(Outputs, ThroughTheProgram) {
    const std::string sky = folder / "sky.acdf", csv = folder / "out.csv";
    write_bytes(sky, small_environment());
    const std::vector<std::string> sample = {"sample", sky, "-n", "10", "-o"};
    const auto to = [&](const std::string& path, bool force) {
        std::vector<std::string> arguments = sample;
        arguments.push_back(path);
        if (force) arguments.push_back("--force");
        return run_acdf(arguments);
    };
    EXPECT_EQ(to(csv, false).code, 0);
    const std::string first = read_text(csv);
    EXPECT_EQ(lines_in(first), 11u);
    EXPECT_EQ(to("-", false).out, first);
    write_text(csv, "mine");
    EXPECT_EQ(to(csv, false).code, 1);
    EXPECT_EQ(read_text(csv), "mine");
    EXPECT_EQ(to(csv, true).code, 0);
    EXPECT_EQ(read_text(csv), first);
    EXPECT_EQ(to(sky, true).code, 1);
    EXPECT_EQ(read_text(sky).size(), small_environment().size());
    EXPECT_EQ(to(folder / ".", true).code, 1);
    EXPECT_EQ(folder.entries(), 2u);
}

// Long enough to be interrupted; the signal comes once the temporary file is there.
TEST_F(Outputs, InterruptLeavesNothingBehind) {
    const std::string sky = folder / "sky.acdf";
    write_bytes(sky, small_environment());
    for (const int signal : {SIGINT, SIGTERM}) {
        const pid_t pid = start_acdf({"sample", sky, "-n", "4000000000", "-o", folder / "out.csv"}, "/dev/null",
                                     "/dev/null", "/dev/null");
        ASSERT_GT(pid, 0);
        while (folder.entries() < 2 && waitpid(pid, nullptr, WNOHANG) == 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        ASSERT_EQ(kill(pid, signal), 0);
        EXPECT_EQ(wait_for(pid), 128 + signal);
        EXPECT_EQ(folder.entries(), 1u);
    }
}

/// Folders that commands make for what they write are gone with it, as are those above that were missing.
TEST_F(Outputs, InterruptLeavesNoFolder) {
    const std::string sky = folder / "sky.pfm";
    std::vector<float> rgb;
    for (int i = 0; i < 512 * 256 * 3; ++i) rgb.push_back(1.0f + static_cast<float>(i % 1009));
    write_float_map(sky, 512, 256, rgb);
    for (const int signal : {SIGINT, SIGTERM}) {
        const pid_t pid = start_acdf({"sweep", sky, "-o", folder / "new/out", "--quiet", "--projection", "latlong"},
                                     "/dev/null", "/dev/null", "/dev/null");
        ASSERT_GT(pid, 0);
        while (!std::filesystem::exists(folder / "new/out") && waitpid(pid, nullptr, WNOHANG) == 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        ASSERT_EQ(kill(pid, signal), 0);
        EXPECT_EQ(wait_for(pid), 128 + signal);
        EXPECT_EQ(folder.entries(), 1u);
    }
}

} // namespace
