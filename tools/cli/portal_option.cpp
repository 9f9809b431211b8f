#include "tools/cli/portal_option.h"

#include "input/error.h"
#include "input/sha256.h"
#include "input/text_lines.h"
#include "tools/cli/file_input.h"
#include "tools/render/portals.h"
#include "tools/render/scene_file.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace acdf::tools {
namespace {

/// Nine numbers with blanks or commas between; false where the text is anything else.
bool read_corners(const std::string& text, float (&corner)[3][3]) {
    constexpr int count = 9;
    double numbers[count + 1]; // one more than there may be
    const char *at = text.data(), *const end = at + text.size();
    if (input::read_numbers(at, end, numbers, count + 1) != count || at != end) return false;
    for (int i = 0; i < count; ++i) {
        if (!(std::abs(numbers[i]) <= double{std::numeric_limits<float>::max()})) return false;
        corner[i / 3][i % 3] = static_cast<float>(numbers[i]);
    }
    return true;
}

/// In the fewest digits that are that number.
std::string spelled(float x) {
    char text[40];
    for (int digits = 6; digits <= 9; ++digits) {
        std::snprintf(text, sizeof text, "%.*g", digits, double{x});
        if (std::strtof(text, nullptr) == x) break;
    }
    return text;
}

std::string spelled(const float (&corner)[3][3]) {
    std::string out;
    for (const auto& c : corner)
        out += (out.empty() ? "" : " ") + spelled(c[0]) + "," + spelled(c[1]) + "," + spelled(c[2]);
    return out;
}

} // namespace

void PortalOption::add(CLI::App& command, const char* group) {
    command
        .add_option_function<std::vector<std::string>>(
            "--portal",
            [this](const std::vector<std::string>& all) {
                corners_.clear();
                spelled_.clear();
                for (const std::string& text : all) {
                    float c[3][3];
                    if (!read_corners(text, c))
                        throw CLI::ValidationError("--portal",
                                                   "needs three corners, such as \"0,0,1 2,0,1 2,0,2\"");
                    builder::Portal portal;
                    for (std::size_t k = 0; k < 3; ++k) {
                        portal.corner[k] = c[0][k];
                        portal.across[k] = c[1][k] - c[0][k];
                        portal.up[k] = c[2][k] - c[1][k];
                    }
                    corners_.push_back(portal);
                    spelled_.push_back(spelled(c));
                }
            },
            "With --visibility: a window or door that light comes through, three corners of it in the mesh's own "
            "coordinates, one after the other, either way round. Samples are taken through it. May be given up to "
            "8 "
            "times")
        ->type_name("\"X,Y,Z X,Y,Z X,Y,Z\"")
        ->allow_extra_args(false)
        ->group(group);
    command.add_option("--portals", path, "With --visibility: the portals of a scene of acdf render (.json)")
        ->type_name("FILE")
        ->group(group);
}

std::string PortalOption::text() const {
    std::string out;
    for (const std::string& one : spelled_) out += " --portal \"" + one + "\"";
    return path.empty() ? out : out + " --portals " + input::file_sha256(path);
}

void PortalOption::tell(builder::Visibility& visibility) const {
    visibility.portals = corners_;
    if (path.empty()) return;
    const std::vector<std::uint8_t> bytes = read_bytes(path, kMostSceneBytes);
    try {
        const std::vector<measure::Portal> portals = parse_scene({bytes.begin(), bytes.end()}).geometry.portals;
        if (portals.empty()) throw SceneError("the scene has no portals");
        for (const measure::Portal& portal : portals) visibility.portals.push_back(portal_of(visibility, portal));
    } catch (const SceneError& error) {
        throw input::Error(path + ": " + error.what());
    }
}

} // namespace acdf::tools
