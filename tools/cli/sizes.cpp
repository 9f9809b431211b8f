#include "tools/cli/sizes.h"

#include "input/file_name.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>

namespace acdf::tools {
namespace {

struct Unit {
    const char* name; // lower case
    double bytes;
};

constexpr Unit units[] = {{"", 1},
                          {"b", 1},
                          {"byte", 1},
                          {"bytes", 1},
                          {"k", 1e3},
                          {"kb", 1e3},
                          {"m", 1e6},
                          {"mb", 1e6},
                          {"g", 1e9},
                          {"gb", 1e9},
                          {"kib", 1024.0},
                          {"ki", 1024.0},
                          {"mib", 1048576.0},
                          {"mi", 1048576.0},
                          {"gib", 1073741824.0},
                          {"gi", 1073741824.0}};

} // namespace

std::optional<std::uint64_t> parse_size(const std::string& text) {
    double number = 0.0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
    if (error != std::errc{} || !std::isfinite(number) || std::signbit(number)) return std::nullopt;
    std::string name;
    for (const char* c = rest; c != end; ++c)
        if (!(*c == ' ' && name.empty())) name += *c;
    name = input::lower(name);
    for (const Unit& unit : units)
        if (name == unit.name) {
            const double bytes = std::floor(number * unit.bytes);
            if (bytes >= 0x1p53) return std::nullopt;
            return static_cast<std::uint64_t>(bytes);
        }
    return std::nullopt;
}

std::string to_readable_size(std::uint64_t bytes) {
    static constexpr const char* names[] = {"KiB", "MiB", "GiB", "TiB"};
    if (bytes < 1024) return std::to_string(bytes) + (bytes == 1 ? " byte" : " bytes");
    double value = static_cast<double>(bytes) / 1024.0;
    std::size_t unit = 0;
    while (value >= 999.5 && unit + 1 < std::size(names)) value /= 1024.0, ++unit;
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g %s", value, names[unit]);
    return text;
}

bool parse_pair(const std::string& text, std::uint32_t most, std::uint32_t& first, std::uint32_t& second) {
    unsigned a = 0, b = 0;
    int end = 0;
    if (std::sscanf(text.c_str(), "%7ux%7u%n", &a, &b, &end) != 2 || static_cast<std::size_t>(end) != text.size())
        return false;
    first = a;
    second = b;
    return a >= 1 && b >= 1 && a <= most && b <= most;
}

} // namespace acdf::tools
