// Folders, children and mounts for the tests of what happens to outputs.
#pragma once

#include "tests/tools/run.h"

#include "tools/cli/output.h"
#include "tools/cli/temporary.h"

#include <functional>
#include <set>

#include <sys/mount.h>

namespace acdf::test {

const std::vector<std::uint8_t> old_bytes = {'o', 'l', 'd'}, new_bytes = {'n', 'e', 'w', '!'};

/// Runs `action` in a child process, which _exits with what it returns; the exit code, or 128 + signal.
inline int in_child(const std::function<int()>& action) {
    const pid_t pid = fork();
    if (pid == 0) {
        int code = 99;
        try {
            code = action();
        } catch (const std::exception& error) {
            std::fprintf(stderr, "child: %s\n", error.what());
        }
        _exit(code);
    }
    return wait_for(pid);
}

/// Names of the temporary files in a folder.
inline std::set<std::string> litter(const std::string& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (const std::string name = entry.path().filename().string(); tools::is_temporary_name(name))
            names.insert(name);
    return names;
}

/// A file system in memory at `path`, as long as it lives.
class Mount {
public:
    Mount(const std::string& path, const char* options) : path_(path) {
        std::filesystem::create_directories(path);
        mounted_ = mount("tmpfs", path.c_str(), "tmpfs", 0, options) == 0;
    }
    ~Mount() {
        if (mounted_) umount2(path_.c_str(), MNT_DETACH);
    }
    Mount(const Mount&) = delete;
    Mount& operator=(const Mount&) = delete;

    explicit operator bool() const { return mounted_; }
    bool make_read_only() const {
        return mount("tmpfs", path_.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr) == 0;
    }

private:
    std::string path_;
    bool mounted_;
};

} // namespace acdf::test
