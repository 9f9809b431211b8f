#include "tools/cli/coordinates.h"

#include "tools/commands.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace acdf::tools {
namespace {

std::string wanted(const std::vector<std::string>& axes) {
    std::string text;
    for (const std::string& axis : axes) text += (text.empty() ? "--at " : ",") + axis + "=VALUE";
    return text;
}

} // namespace

std::vector<std::string> indexed_axes(const File& file) {
    std::vector<std::string> out;
    for (std::uint32_t i = 2; i < file.description().axis_count; ++i) {
        const char* name = reinterpret_cast<const char*>(file.axis(i).name);
        out.emplace_back(name, strnlen(name, sizeof file.axis(i).name));
    }
    return out;
}

MixedEnvironment chosen_environment(const std::string& path, const LoadedFile& loaded,
                                    const std::vector<std::string>& at) {
    const std::vector<std::string> axes = indexed_axes(loaded.file);
    std::vector<double> coordinates(axes.size(), NAN);
    for (std::size_t i = 0; i < at.size(); ++i) {
        const std::size_t equals = at[i].find('=');
        std::size_t axis = i;
        if (equals != std::string::npos)
            axis = std::size_t(std::find(axes.begin(), axes.end(), at[i].substr(0, equals)) - axes.begin());
        const std::string value = equals == std::string::npos ? at[i] : at[i].substr(equals + 1);
        char* end = nullptr;
        const double number = std::strtod(value.c_str(), &end);
        if (axis >= axes.size() || value.empty() || *end != 0 || !std::isfinite(number))
            throw Failure(path + ": '" + at[i] + "' is not a position on its axes; give " + wanted(axes));
        coordinates[axis] = number;
    }
    for (const double coordinate : coordinates)
        if (std::isnan(coordinate)) throw Failure(path + ": holds several maps; choose with " + wanted(axes));
    return loaded.maps.at(coordinates.data());
}

MixedEnvironment first_environment(const IndexedEnvironment& maps) {
    double coordinates[ACDF_MOST_INDEXED_AXES] = {};
    const double* of_axis = maps.data().coordinates;
    for (std::uint32_t i = 0; i < maps.axes(); of_axis += maps.data().counts[i++]) coordinates[i] = *of_axis;
    return maps.at(coordinates);
}

} // namespace acdf::tools
