#include "input/image.h"
#include "input/scene_sources.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

namespace acdf::input {
namespace {

constexpr std::size_t kLongestLine = 1024;
constexpr double kLeastWeight = 1e-30, kGreatestWeight = 1e30;

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == '\r'; }

/// Numbers of a line up to a comment; -1 where something else is there, or more than `most`.
int parse_numbers(const char* at, const char* end, double* numbers, int most) {
    if (const void* comment = std::memchr(at, '#', static_cast<std::size_t>(end - at)))
        end = static_cast<const char*>(comment);
    for (int count = 0;; ++count) {
        while (at != end && is_separator(*at)) ++at;
        if (at == end) return count;
        if (count == most) return -1;
        if (*at == '+' && at + 1 != end && at[1] != '-') ++at;
        const auto [after, error] = std::from_chars(at, end, numbers[count]);
        if (error != std::errc() || (after != end && !is_separator(*after))) return -1;
        at = after;
    }
}

} // namespace

void add_listed_normals(const std::string& path, NormalHistogram& histogram) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw input_error(path, "it cannot be opened; check its permissions");
    char line[kLongestLine];
    for (std::uint64_t number = 1;; ++number) {
        file.getline(line, sizeof line);
        const auto read =
            static_cast<std::size_t>(file.gcount()); // with the newline, but not at the end of the file
        if (read == 0) break;
        const auto fail = [&](const std::string& what) {
            return input_error(path, "line " + std::to_string(number) + " " + what);
        };
        if (file.fail()) throw fail("is longer than any normal; a list has lines \"x y z [weight]\"");
        const char *begin = line, *end = line + read - (file.eof() ? 0 : 1);
        if (number == 1 && read >= 3 && std::memcmp(line, "\xEF\xBB\xBF", 3) == 0) begin += 3; // byte order mark
        double values[4] = {0.0, 0.0, 0.0, 1.0};
        const int count = parse_numbers(begin, end, values, 4);
        if (count == 0) continue;
        if (count != 3 && count != 4) throw fail("is no normal \"x y z [weight]\"");
        if (values[3] == 0.0) {
            histogram.skip();
            continue;
        }
        if (!(values[3] >= kLeastWeight && values[3] <= kGreatestWeight))
            throw fail("has a weight that is negative or out of range; give one from 1e-30 to 1e30");
        histogram.add(values[0], values[1], values[2], values[3]);
    }
    if (file.bad()) throw input_error(path, "it cannot be read");
}

} // namespace acdf::input
