#include "input/error.h"
#include "input/normals/sources.h"
#include "input/text_lines.h"

namespace acdf::input {
namespace {

constexpr double kLeastWeight = 1e-30, kGreatestWeight = 1e30;

} // namespace

void add_listed_normals(const std::string& path, NormalHistogram& histogram) {
    for_each_line(path, "normal; a list has lines \"x y z [weight]\"", [&](const TextLine& line) {
        const auto fail = [&](const std::string& what) {
            return input_error(path, "line " + std::to_string(line.number) + " " + what);
        };
        double values[4] = {0.0, 0.0, 0.0, 1.0};
        const char* at = line.begin;
        const int count = read_numbers(at, line.end, values, 4);
        const bool all = is_blank(at, line.end);
        if (count == 0 && all) return;
        if (!all || (count != 3 && count != 4)) throw fail("is not a normal \"x y z [weight]\"");
        if (values[3] == 0.0) return histogram.skip();
        if (!(values[3] >= kLeastWeight && values[3] <= kGreatestWeight))
            throw fail("has a weight that is negative or out of range; give one from 1e-30 to 1e30");
        histogram.add(values[0], values[1], values[2], values[3]);
    });
}

} // namespace acdf::input
