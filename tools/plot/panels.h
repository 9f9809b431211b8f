// Several pictures as one: small multiples.
#pragma once

#include "images/picture.h"
#include "tools/plot/local.h"

#include <string>
#include <vector>

namespace acdf::tools {

/// Normals that show a local environment from all sides, and what they are called.
struct NamedNormal {
    const char* name;
    Normal normal;
};
constexpr NamedNormal panel_normals[] = {
    {"normal +z (up)", {0.0f, 0.0f, 1.0f}}, {"normal +x", {1.0f, 0.0f, 0.0f}},
    {"normal +y", {0.0f, 1.0f, 0.0f}},      {"normal -z (down)", {0.0f, 0.0f, -1.0f}},
    {"normal -x", {-1.0f, 0.0f, 0.0f}},     {"normal -y", {0.0f, -1.0f, 0.0f}}};

struct Panel {
    std::string label; ///< ASCII, above the picture
    images::Picture picture;
};

/// Panels of one size side by side, `columns` in a row, each with its label above it. `font` as find_font gives it;
/// without one there is no text.
images::Picture arranged(const std::vector<Panel>& panels, int columns, const std::string& font);

} // namespace acdf::tools
