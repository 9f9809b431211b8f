#include "input_file.h"

#if defined(_WIN32)
#ifndef WIN32_LEAN_AND_MEAN
#define WIN32_LEAN_AND_MEAN
#endif
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

#include <cstdlib>

namespace acdf {
namespace {

// What the system says of its last error, on one line.
const char* last_error(char (&text)[160]) noexcept {
    const DWORD length = FormatMessageA(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS, nullptr,
                                        GetLastError(), 0, text, sizeof text, nullptr);
    DWORD end = length;
    while (end > 0 && (text[end - 1] == '\r' || text[end - 1] == '\n' || text[end - 1] == '.')) --end;
    text[end] = 0;
    return end > 0 ? text : "an error without a name";
}

} // namespace

InputFile::~InputFile() {
    if (handle_) CloseHandle(handle_);
}

const char* InputFile::open(const char* path) noexcept {
    const int length = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, nullptr, 0);
    if (length == 0) return "the path is not UTF-8";
    auto* const wide = static_cast<wchar_t*>(std::malloc(static_cast<std::size_t>(length) * sizeof(wchar_t)));
    if (!wide) return "no memory for the path";
    MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, length);
    HANDLE handle = CreateFileW(wide, GENERIC_READ, FILE_SHARE_READ, nullptr, OPEN_EXISTING,
                                FILE_FLAG_SEQUENTIAL_SCAN | FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    const char* const wrong = handle == INVALID_HANDLE_VALUE ? last_error(error_) : nullptr;
    if (!wrong) handle_ = handle;
    std::free(wide);
    return wrong;
}

const char* InputFile::measure(std::uint64_t& size) noexcept {
    BY_HANDLE_FILE_INFORMATION info;
    LARGE_INTEGER length;
    if (GetFileType(handle_) != FILE_TYPE_DISK) return "it is a pipe or a device";
    if (!GetFileInformationByHandle(handle_, &info)) return last_error(error_);
    if (info.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) return "it is a directory";
    if (!GetFileSizeEx(handle_, &length)) return last_error(error_);
    size = static_cast<std::uint64_t>(length.QuadPart);
    return nullptr;
}

const char* InputFile::read(void* out, std::uint64_t size, std::uint64_t& done) noexcept {
    constexpr std::uint64_t step = std::uint64_t{1} << 30;
    for (done = 0; done < size;) {
        const std::uint64_t left = size - done;
        DWORD n = 0;
        if (!ReadFile(handle_, static_cast<char*>(out) + done, static_cast<DWORD>(left < step ? left : step), &n,
                      nullptr))
            return last_error(error_);
        if (n == 0) return nullptr;
        done += n;
    }
    return nullptr;
}

} // namespace acdf
#endif
