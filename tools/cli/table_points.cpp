#include "tools/cli/table_points.h"

#include "tools/commands.h"

#include <charconv>
#include <cstdio>
#include <system_error>

namespace acdf::tools {

std::vector<std::uint32_t> chosen_bin(const std::string& path, const TableView& view,
                                      const std::vector<std::string>& words) {
    std::vector<std::uint32_t> at;
    for (const std::string& word : words) {
        std::uint32_t index = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (error != std::errc() || end != word.data() + word.size())
            throw CLI::ValidationError("--at", "'" + word + "' is no index of a table's axis");
        at.push_back(index);
    }
    const std::uint32_t n = view.indexed_count();
    if (at.size() != n)
        throw Failure(
            path + ": has " + std::to_string(n) + (n == 1 ? " indexed axis" : " indexed axes") + ", " +
            (n == 0 ? "leave out --at" : "choose a bin with " + std::to_string(n) + " indices: --at I,J,..."));
    for (std::uint32_t axis = 0; axis < n; ++axis)
        if (const std::uint32_t size = view.data().axes[axis].resolution; at[axis] >= size)
            throw Failure(path + ": index " + std::to_string(at[axis]) + " of --at is beyond its axis, which has " +
                          std::to_string(size) + (size == 1 ? " step" : " steps"));
    return at;
}

std::vector<std::string> point_names(std::uint32_t n) {
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i < n; ++i) names.push_back("x" + std::to_string(i));
    return names;
}

std::string point_columns(const std::string& letter, std::uint32_t n) {
    std::string text;
    for (std::uint32_t i = 0; i < n; ++i) text += letter + std::to_string(i) + ",";
    return text;
}

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

std::string point_text(const double* x, std::size_t n) {
    std::string text;
    for (std::size_t i = 0; i < n; ++i) text += number_text(x[i]) + ",";
    return text;
}

} // namespace acdf::tools
