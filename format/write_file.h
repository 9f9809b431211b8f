// A whole file at once.
#pragma once

#include <cstddef>
#include <fstream>
#include <stdexcept>
#include <string>

/// Throws std::runtime_error where it cannot be written.
inline void write_file(const std::string& path, const void* data, std::size_t size) {
    std::ofstream out(path, std::ios::binary);
    out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    if (!out.flush()) throw std::runtime_error("cannot write " + path);
}
