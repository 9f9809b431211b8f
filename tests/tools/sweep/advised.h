// What the pages advise, and the probes on which tests check it.
#pragma once

#include "input/probe/probe.h"
#include "tests/inputs/paths.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace acdf::test {

/// The cells of the first table of a page whose header begins with `first`: header, then rows.
inline std::vector<std::vector<std::string>> table_of(const std::string& page, const std::string& first) {
    std::ifstream file(std::string(ACDF_TEST_DIR) + "/../" + page);
    std::vector<std::vector<std::string>> out;
    for (std::string line; std::getline(file, line);) {
        if (out.empty() && line.rfind("| " + first, 0) != 0) continue;
        if (line.empty() || line[0] != '|') break;
        if (line.rfind("|---", 0) == 0) continue;
        std::vector<std::string> cells;
        for (std::size_t at = 1, end; (end = line.find('|', at)) != std::string::npos; at = end + 1)
            cells.push_back(line.substr(at + 1, end - at - 2));
        out.push_back(cells);
    }
    return out;
}

/// What is between the first two backticks.
inline std::string code_in(const std::string& cell) {
    const std::size_t begin = cell.find('`') + 1;
    return cell.substr(begin, cell.find('`', begin) - begin);
}

inline const std::vector<std::string> six_probes{"city.exr",      "sunset.exr",        "studio.exr",
                                                 "courtyard.exr", "noon_grass_1k.hdr", "venice_sunset_1k.hdr"};

inline std::string probe_path(const std::string& name) {
    return std::string(acdf_test::kTestData) + "/probes/" + name;
}

/// A probe averaged to `columns` x `columns` / 2 pixels.
inline input::Probe reduced_probe(const std::string& name, int columns) {
    const input::Probe whole = input::read_probe(probe_path(name), {});
    input::Probe out;
    out.width = columns;
    out.height = columns / 2;
    const int step = whole.width / columns;
    out.rgb.assign(std::size_t(3) * std::size_t(out.width * out.height), 0.0f);
    for (int y = 0; y < out.height * step; ++y)
        for (int x = 0; x < out.width * step; ++x)
            for (int k = 0; k < 3; ++k)
                out.rgb[std::size_t(3 * (y / step * out.width + x / step) + k)] +=
                    whole.rgb[std::size_t(3 * (y * whole.width + x) + k)] / static_cast<float>(step * step);
    return out;
}

inline bool probes_are_there() {
    return std::all_of(six_probes.begin(), six_probes.end(),
                       [](const std::string& name) { return std::filesystem::exists(probe_path(name)); });
}

} // namespace acdf::test
