#include "input_file.h"

#if !defined(_WIN32)
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace acdf {

InputFile::~InputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

const char* InputFile::open(const char* path) noexcept {
    descriptor_ = ::open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); // nonblocking: a pipe is refused
    return descriptor_ < 0 ? std::strerror(errno) : nullptr;
}

const char* InputFile::measure(std::uint64_t& size) noexcept {
    struct stat info;
    if (::fstat(descriptor_, &info) != 0) return std::strerror(errno);
    if (S_ISDIR(info.st_mode)) return "it is a directory";
    if (!S_ISREG(info.st_mode)) return "it is a pipe or a device";
    size = static_cast<std::uint64_t>(info.st_size);
    return nullptr;
}

const char* InputFile::read(void* out, std::uint64_t size, std::uint64_t& done) noexcept {
    constexpr std::uint64_t step = std::uint64_t{1} << 30;
    for (done = 0; done < size;) {
        const std::uint64_t left = size - done;
        const ssize_t n = ::read(descriptor_, static_cast<char*>(out) + done, left < step ? left : step);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return std::strerror(errno);
        if (n == 0) return nullptr;
        done += static_cast<std::uint64_t>(n);
    }
    return nullptr;
}

} // namespace acdf
#endif
