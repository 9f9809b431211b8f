// Disks that are full, folders that refuse, links, other devices, several writers: the old file stays or the new
// one is there, whole, and nothing else.
#include "tests/tools/disk/files.h"
#include "tests/inputs/paths.h"

#include "tests/inputs/float_map.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <exception>

using namespace acdf::test;
using acdf::tools::Output;
using acdf::tools::write_output;

namespace {

class Disk : public testing::Test {
protected:
    void SetUp() override { write_bytes(sky, small_environment()); }

    std::vector<std::string> sample(const std::string& output, int n, int seed) const {
        return {"sample", sky, "-n", std::to_string(n), "--seed", std::to_string(seed), "-o", output};
    }
    std::vector<std::string> forced(std::vector<std::string> arguments) const {
        arguments.push_back("--force");
        return arguments;
    }
    // An old target in `where` survives `acdf sample`, which fails with one line that has `word`; no litter.
    void expect_refused(const std::string& where, const char* word, const std::string& before = "") {
        const std::string target = where + "/out.csv";
        std::string command = before;
        for (const std::string& argument : forced(sample(target, 20000, 1))) command += " '" + argument + "'";
        const Result result = run_shell(command);
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_EQ(read_text(target), "old");
        EXPECT_TRUE(litter(where).empty());
    }
    Result run_shell(const std::string& command) const {
        Result result;
        const std::string err = folder / "shell.err";
        const std::string line = "exec 2>'" + err + "'; " + command;
        result.code = WEXITSTATUS(std::system(line.c_str()));
        result.err = read_text(err);
        return result;
    }
    const std::string program = std::string("'") + acdf_test::kProgram + "'";

    Folder folder;
    std::string sky = folder / "sky.acdf", out = folder / "out.csv";
};

TEST_F(Disk, limitOfFileSizesIsAnError) {
    write_bytes(out, old_bytes);
    expect_refused(std::filesystem::path(out).parent_path().string(), "File too large",
                   "ulimit -f 16; exec " + program);
}

TEST_F(Disk, fullDiskIsAnError) {
    const Mount disk(folder / "disk", "size=64k");
    if (!disk) GTEST_SKIP() << "a small file system cannot be mounted here: needs to be root, outside a container";
    write_bytes(folder / "disk/out.csv", old_bytes);
    expect_refused(folder / "disk", "No space left on device; free some space", "exec " + program);
}

TEST_F(Disk, fullDeviceIsAnError) {
    if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "there is no /dev/full";
    for (const char* where : {"-o /dev/full", "> /dev/full"}) {
        const Result result = run_shell("exec " + program + " sample '" + sky + "' -n 20000 " + where);
        EXPECT_EQ(result.code, 1) << where;
        EXPECT_NE(result.err.find("No space left on device"), std::string::npos) << result.err;
    }
}

// The next file must not get their descriptors: messages would go into it.
TEST_F(Disk, closedStreamsGetNoOutput) {
    const std::string map = folder / "sky.pfm", whole = folder / "whole.acdf", made = folder / "made.acdf";
    write_float_map(map, 4, 2, std::vector<float>(24, 1.0f));
    ASSERT_EQ(run_acdf({"env", map, "-o", whole}).code, 0);
    const std::pair<const char*, int> cases[] = {
        {"2>&-", 0}, {"<&- 2>&-", 0}, {">&-", 1}, {">&- 2>&-", 1}, {"<&- >&- 2>&-", 1}};
    for (const auto& [closed, code] : cases) {
        const Result result =
            run_shell("exec " + program + " env '" + map + "' -f -o '" + made + "' >/dev/null " + closed);
        EXPECT_EQ(result.code, code) << closed
                                     << ": results that cannot be printed are an error, messages are none";
        EXPECT_EQ(read_text(made), read_text(whole)) << closed;
        std::filesystem::remove(made);
    }
}

TEST_F(Disk, readOnlyFileSystemIsAnError) {
    const Mount disk(folder / "disk", "size=64k");
    if (!disk) GTEST_SKIP() << "a file system cannot be mounted here: needs to be root, outside a container";
    write_bytes(folder / "disk/out.csv", old_bytes);
    ASSERT_TRUE(disk.make_read_only());
    expect_refused(folder / "disk", "Read-only file system; choose a folder that you may write to",
                   "exec " + program);
}

// Root may write anywhere, so the child becomes nobody.
TEST_F(Disk, folderWithoutPermissionIsAnError) {
    const std::string sealed = folder / "sealed", target = sealed + "/out.csv";
    std::filesystem::create_directory(sealed);
    write_bytes(target, old_bytes);
    const std::string above = std::filesystem::path(sealed).parent_path().string();
    ASSERT_EQ(chmod(above.c_str(), 0755), 0);
    ASSERT_EQ(chmod(sealed.c_str(), 0555), 0);
    const int code = in_child([&]() -> int {
        if (getuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) return 2;
        try {
            write_output(target, new_bytes, true);
        } catch (const std::exception& error) {
            return std::string(error.what()).find("Permission denied; choose a folder") == std::string::npos;
        }
        return 1;
    });
    EXPECT_EQ(chmod(sealed.c_str(), 0755), 0);
    if (code == 2) GTEST_SKIP() << "root cannot become another user here";
    EXPECT_EQ(code, 0);
    EXPECT_EQ(read_text(target), "old");
    EXPECT_TRUE(litter(sealed).empty());
}

TEST_F(Disk, danglingLinkMakesItsTarget) {
    std::filesystem::create_directory(folder / "elsewhere");
    std::filesystem::create_symlink("elsewhere/later.bin", folder / "link");
    std::filesystem::create_symlink("link", folder / "link of a link");
    write_output(folder / "link of a link", new_bytes, false);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(read_text(folder / "elsewhere/later.bin"), "new!");
    EXPECT_THROW(write_output(folder / "link", old_bytes, false), std::exception);
    EXPECT_EQ(read_text(folder / "elsewhere/later.bin"), "new!");
    std::filesystem::create_symlink("circle", folder / "circle");
    EXPECT_THROW(write_output(folder / "circle", old_bytes, true), std::exception);
    std::filesystem::create_symlink("no/such/folder/file", folder / "lost");
    EXPECT_THROW(write_output(folder / "lost", old_bytes, true), std::exception);
}

// The temporary file is beside the target, so that a rename suffices, also where a link leads to another device.
TEST_F(Disk, linkToAnotherDevice) {
    std::string shared = "/dev/shm/acdf-test-XXXXXX";
    struct stat here = {}, there = {};
    if (!mkdtemp(shared.data())) GTEST_SKIP() << "there is no /dev/shm";
    stat(shared.c_str(), &there);
    stat(sky.c_str(), &here);
    write_bytes(shared + "/target", old_bytes);
    std::filesystem::create_symlink(shared + "/target", folder / "link");
    write_output(folder / "link", new_bytes, true);
    EXPECT_EQ(read_text(shared + "/target"), "new!");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_TRUE(litter(shared).empty());
    std::filesystem::remove_all(shared);
    if (here.st_dev == there.st_dev) GTEST_SKIP() << "/dev/shm is the same device";
}

TEST_F(Disk, oneOfTwoWritersWinsWhole) {
    const std::vector<std::string> a = sample(out, 3000, 1), b = sample(out, 3000, 2);
    std::set<std::string> whole;
    for (const auto& arguments : {a, b}) {
        ASSERT_EQ(run_acdf(forced(arguments)).code, 0);
        whole.insert(read_text(out));
    }
    ASSERT_EQ(whole.size(), 2u);
    for (int round = 0; round < 4; ++round) {
        const bool force = round % 2 == 0;
        if (!force) std::filesystem::remove(out);
        const auto start = [&](const std::vector<std::string>& arguments) {
            return start_acdf(force ? forced(arguments) : arguments, "/dev/null", "/dev/null", "/dev/null");
        };
        const pid_t first = start(a), second = start(b);
        const int codes = wait_for(first) + wait_for(second);
        EXPECT_EQ(codes, force ? 0 : 1); // without --force the later one refuses
        EXPECT_TRUE(whole.count(read_text(out)));
        EXPECT_EQ(folder.entries(), 2u);
    }
}

// ---- what killed programs leave -------------------------------------------------------------------------

int write_and_die_at(const std::string& target, int step) {
    const auto die_at = [step](int here) {
        if (here == step) raise(SIGKILL);
    };
    Output output(target, true);
    die_at(0);
    output.write("ne");
    die_at(1);
    output.write("w!");
    output.commit([&](const std::uint8_t*, std::size_t) { die_at(2); });
    return 0;
}

TEST_F(Disk, whatAKilledProgramLeftIsRemovedByTheNext) {
    const std::string target = folder / "result.bin", where = std::filesystem::path(target).parent_path().string();
    write_bytes(target, old_bytes);
    for (int step = 0; step < 3; ++step) {
        EXPECT_EQ(in_child([&] { return write_and_die_at(target, step); }), 128 + SIGKILL);
        EXPECT_EQ(read_text(target), "old");
    }
    EXPECT_EQ(litter(where).size(), 1u) << "each removes what the one before left";
    EXPECT_EQ(in_child([&] { return write_and_die_at(target, 3); }), 0);
    EXPECT_EQ(read_text(target), "new!");
    EXPECT_TRUE(litter(where).empty());
}

TEST_F(Disk, whatOthersAreWritingIsNotRemoved) {
    const std::string where = std::filesystem::path(out).parent_path().string();
    Output mine(out, false);
    mine.write("mine");
    const std::vector<std::string> foreign = {".acdf-abc", ".acdf-abcdefg", "acdf-abcdef", ".acdf-abcde/",
                                              ".acdf-ab.def"};
    for (const std::string& name : foreign) write_text(folder / name, "not ours");
    std::filesystem::create_directory(folder / ".acdf-folder");
    std::filesystem::create_symlink(sky, folder / ".acdf-linked.csv");
    write_text(folder / ".acdf-dead00.acdf", "ours, of a program that is gone");
    const std::size_t before = folder.entries();
    EXPECT_EQ(in_child([&] { return acdf::tools::remove_stale_temporaries(where) == 1 ? 0 : 1; }), 0);
    EXPECT_EQ(folder.entries(), before - 1);
    mine.commit();
    EXPECT_EQ(read_text(out), "mine");
    EXPECT_FALSE(std::filesystem::exists(folder / ".acdf-dead00.acdf"));
    EXPECT_TRUE(std::filesystem::exists(sky));
}

} // namespace
