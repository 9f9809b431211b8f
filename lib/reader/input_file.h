// A regular file, opened to be read: all calls to the system are here.
#pragma once

#include "sources.h"

namespace acdf {

/// Closed when it goes. Functions return null, or what went wrong, valid until the next call.
class InputFile {
public:
    InputFile() noexcept = default;
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    ~InputFile();

    /// `path` is UTF-8 on Windows, else bytes as the system takes them. Waits for no pipe.
    const char* open(const char* path) noexcept;
    /// How many bytes it has; wrong where it is a folder, a pipe or a device.
    const char* measure(u64& size) noexcept;
    /// Reads up to `size` bytes; `done`: how many there were.
    const char* read(void* out, u64 size, u64& done) noexcept;

private:
    int descriptor_ = -1;
};

} // namespace acdf
