#include "tools/batch/memory.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace acdf::tools {
namespace {

constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

std::uint64_t read_number(const std::string& path) {
    std::ifstream file(path);
    std::uint64_t value = 0;
    return file >> value ? value : unknown; // "max" is no number
}

std::uint64_t machine_memory() {
    std::ifstream file("/proc/meminfo");
    std::string name, unit;
    for (std::uint64_t kib = 0; file >> name >> kib; std::getline(file, unit))
        if (name == "MemAvailable:") return kib * 1024;
    return unknown;
}

/// What a group and all above it leave.
std::uint64_t group_memory(const std::string& root, std::string group, const char* limit_file,
                           const char* used_file) {
    std::uint64_t least = unknown;
    for (;;) {
        const std::string folder = root + group + "/";
        const std::uint64_t limit = read_number(folder + limit_file), used = read_number(folder + used_file);
        if (limit != unknown && used != unknown) least = std::min(least, limit > used ? limit - used : 0);
        if (group.empty() || group == "/") return least;
        group.erase(group.rfind('/'));
    }
}

/// Lines of /proc/self/cgroup: "ID:CONTROLLERS:GROUP", CONTROLLERS empty for version 2.
std::uint64_t control_group_memory() {
    std::ifstream file("/proc/self/cgroup");
    std::uint64_t least = unknown;
    for (std::string line; std::getline(file, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        const std::string group = line.substr(second + 1);
        if (controllers == ",,")
            least = std::min(least, group_memory("/sys/fs/cgroup", group, "memory.max", "memory.current"));
        else if (controllers.find(",memory,") != std::string::npos)
            least = std::min(least, group_memory("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes",
                                                 "memory.usage_in_bytes"));
    }
    return least;
}

/// Address space that `ulimit -v` leaves this process.
std::uint64_t address_space() {
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unknown;
    const std::uint64_t pages = read_number("/proc/self/statm"); // of address space in use: the first number
    const std::uint64_t used = pages == unknown ? 0 : pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

constexpr std::uint64_t mib = std::uint64_t{1} << 20;
constexpr std::uint64_t of_a_thread = 72 * mib;    // its stack, and the heap that glibc reserves for it
constexpr std::uint64_t of_the_program = 48 * mib; // modules that read images, and what is not estimated

} // namespace

std::uint64_t available_memory() {
    const std::uint64_t least = std::min(machine_memory(), control_group_memory());
    return least == unknown ? 0 : least;
}

void keep_within_address_space(BatchLimits& limits) {
    const std::uint64_t space = address_space();
    if (space == unknown) return;
    const auto threads = static_cast<int>(std::clamp<std::uint64_t>(space / 4 / of_a_thread, 1, 4096));
    limits.threads = std::min(limits.threads, threads);
    limits.workers = std::min(limits.workers, threads);
    const std::uint64_t used = static_cast<std::uint64_t>(limits.threads) * of_a_thread + of_the_program;
    limits.memory = std::min(limits.memory, space > used ? space - used : 0);
}

} // namespace acdf::tools
