#include "tools/cli/scene_axes.h"

#include <CLI/CLI.hpp>

#include <utility>

namespace acdf::tools {

SceneAxes SceneAxes::of(const std::string& text) {
    const auto wrong = [&] {
        return CLI::ValidationError("--scene-axes",
                                    "'" + text + "' does not name x, y and z once each, as (-x,y,z) does");
    };
    std::string plain;
    for (const char c : text)
        if (c != ' ' && c != '(' && c != ')') plain += c;
    SceneAxes out;
    bool named[3] = {};
    std::size_t at = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (k > 0 && (at >= plain.size() || plain[at++] != ',')) throw wrong();
        const bool negated = at < plain.size() && plain[at] == '-';
        if (negated) ++at;
        const std::size_t axis = at < plain.size() ? std::string("xXyYzZ").find(plain[at++]) / 2 : 3;
        if (axis > 2 || named[axis]) throw wrong();
        named[axis] = true;
        out.from[k] = axis;
        out.sign[k] = negated ? -1.0f : 1.0f;
    }
    if (at != plain.size()) throw wrong();
    return out;
}

std::string SceneAxes::text() const {
    std::string out;
    for (std::size_t k = 0; k < 3; ++k)
        out += std::string(k > 0 ? "," : "(") + (sign[k] < 0.0f ? "-" : "") + "xyz"[from[k]];
    return out + ")";
}

bool SceneAxes::mirrored() const {
    const bool even = (from[0] + 1) % 3 == from[1];
    return even == (sign[0] * sign[1] * sign[2] < 0.0f);
}

void SceneAxes::turn(input::Triangles& triangles) const {
    for (input::Triangles::Corner& corner : triangles.corners) {
        corner.position = turned(corner.position.data());
        corner.normal = turned(corner.normal.data());
    }
    if (!mirrored()) return;
    for (std::size_t i = 0; i < triangles.count(); ++i)
        std::swap(triangles.corners[3 * i + 1], triangles.corners[3 * i + 2]);
}

void SceneAxes::tell(builder::Visibility& visibility) const {
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 4; ++i) visibility.transform[k][i] = i == from[k] ? sign[k] : 0.0f;
}

} // namespace acdf::tools
