#include "quiet.h"

#include <cstdio>
#include <mutex>

namespace acdf::images {
#ifdef __GLIBC__
namespace {

std::mutex quiet_mutex;
int quiet_count = 0;
std::FILE* loud = nullptr;

std::FILE* nowhere() {
    static std::FILE* const file = std::fopen("/dev/null", "we");
    return file;
}

} // namespace

Quiet::Quiet() {
    const std::lock_guard lock(quiet_mutex);
    if (quiet_count++ > 0) return;
    loud = stderr;
    if (nowhere()) stderr = nowhere();
}

Quiet::~Quiet() {
    const std::lock_guard lock(quiet_mutex);
    if (--quiet_count == 0) stderr = loud;
}
#else
Quiet::Quiet() = default;
Quiet::~Quiet() = default;
#endif
} // namespace acdf::images
