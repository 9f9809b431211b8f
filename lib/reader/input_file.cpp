#include "input_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>

#if defined(_WIN32)
#ifndef WIN32_LEAN_AND_MEAN
#define WIN32_LEAN_AND_MEAN
#endif
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <io.h>
#include <windows.h>

#include <sys/stat.h>
#else
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace acdf {
namespace {

// The few calls that systems name differently. POSIX's returns of failure and `errno` are those of all.
#if defined(_WIN32)
using FileInfo = struct _stat64;
bool is_folder(const FileInfo& info) { return (info.st_mode & _S_IFMT) == _S_IFDIR; }
bool is_regular(const FileInfo& info) { return (info.st_mode & _S_IFMT) == _S_IFREG; }
int get_info(int file, FileInfo& info) { return ::_fstat64(file, &info); }
int close_file(int file) { return ::_close(file); }
long long read_some(int file, void* out, u32 size) { return ::_read(file, out, size); }

int open_file(const char* path) {
    const int length = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, nullptr, 0);
    auto* const wide = static_cast<wchar_t*>(std::malloc(static_cast<std::size_t>(length) * sizeof(wchar_t)));
    errno = wide ? EILSEQ : ENOMEM; // of a path that is not UTF-8
    const bool converted = wide && MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, length) > 0;
    FileInfo info;
    const bool folder = converted && ::_wstat64(wide, &info) == 0 && is_folder(info); // which cannot be opened
    const int file = converted && !folder ? ::_wopen(wide, _O_RDONLY | _O_BINARY | _O_NOINHERIT) : -1;
    if (folder) errno = EISDIR;
    std::free(wide);
    return file;
}
#else
using FileInfo = struct stat;
bool is_folder(const FileInfo& info) { return S_ISDIR(info.st_mode); }
bool is_regular(const FileInfo& info) { return S_ISREG(info.st_mode); }
int get_info(int file, FileInfo& info) { return ::fstat(file, &info); }
int close_file(int file) { return ::close(file); }
long long read_some(int file, void* out, u32 size) { return ::read(file, out, size); }
int open_file(const char* path) { return ::open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); } // waits for no pipe
#endif

} // namespace

InputFile::~InputFile() {
    if (descriptor_ >= 0) close_file(descriptor_);
}

const char* InputFile::open(const char* path) noexcept {
    descriptor_ = open_file(path);
    return descriptor_ < 0 ? std::strerror(errno) : nullptr;
}

const char* InputFile::measure(u64& size) noexcept {
    FileInfo info;
    if (get_info(descriptor_, info) != 0) return std::strerror(errno);
    if (is_folder(info)) return "it is a directory";
    if (!is_regular(info)) return "it is a pipe or a device";
    size = static_cast<u64>(info.st_size);
    return nullptr;
}

const char* InputFile::read(void* out, u64 size, u64& done) noexcept {
    constexpr u64 step = u64{1} << 30;
    for (done = 0; done < size;) {
        const u64 left = size - done;
        const long long n =
            read_some(descriptor_, static_cast<char*>(out) + done, static_cast<u32>(left < step ? left : step));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return std::strerror(errno);
        if (n == 0) return nullptr;
        done += static_cast<u64>(n);
    }
    return nullptr;
}

} // namespace acdf
