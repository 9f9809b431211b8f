// Stands in for pbrt's header: throws where pbrt ends.
#pragma once

#include <stdexcept>
#include <string>

namespace pbrt {

template <typename... Args>
[[noreturn]] void ErrorExit(const char* format, const Args&... args) {
    std::string text = format;
    ((text += " " + std::string(args)), ...);
    throw std::runtime_error(text);
}

} // namespace pbrt
