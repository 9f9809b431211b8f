#include "tools/cli/temporary.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace acdf::tools {
namespace {

constexpr char prefix[] = ".acdf-";
constexpr std::size_t random_letters = 6;

/// Whether `path` still names the file that `fd` has open.
bool is_at(int fd, const std::string& path) {
    struct stat open = {}, named = {};
    return fstat(fd, &open) == 0 && lstat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
           open.st_ino == named.st_ino;
}

bool remove_if_stale(const std::string& path) {
    // For writing, as NFS asks for it to lock.
    const int fd = open(path.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return false;
    struct stat status = {};
    const bool stale = fstat(fd, &status) == 0 && S_ISREG(status.st_mode) && flock(fd, LOCK_EX | LOCK_NB) == 0 &&
                       is_at(fd, path) && unlink(path.c_str()) == 0;
    close(fd);
    return stale;
}

} // namespace

int create_temporary(const std::string& folder, const std::string& extension, std::string& path) {
    for (;;) {
        path = folder + "/" + prefix + std::string(random_letters, 'X') + extension;
        const int fd = mkostemps(path.data(), static_cast<int>(extension.size()), O_CLOEXEC);
        if (fd < 0) {
            path.clear();
            return -1;
        }
        // Until the lock is taken another program may take the file for a stale one.
        const bool locked = flock(fd, LOCK_EX | LOCK_NB) == 0;
        if (!locked && errno != EWOULDBLOCK) return fd; // no locks here: nobody removes it either
        if (locked && is_at(fd, path)) return fd;
        close(fd);
    }
}

bool is_temporary_name(const std::string& name) {
    const std::size_t begin = std::strlen(prefix), end = begin + random_letters;
    if (name.compare(0, begin, prefix) != 0 || name.size() < end) return false;
    const auto letter = [](unsigned char c) { return std::isalnum(c) != 0; };
    return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(begin),
                       name.begin() + static_cast<std::ptrdiff_t>(end), letter) &&
           (name.size() == end || name[end] == '.');
}

std::size_t remove_stale_temporaries(const std::string& folder) {
    std::size_t removed = 0;
    std::error_code error;
    for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
        if (is_temporary_name(i->path().filename().string()) && remove_if_stale(i->path().string())) ++removed;
    return removed;
}

} // namespace acdf::tools
