#include "input/probe/layer_names.h"

#include "input/file_name.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace acdf::input {
namespace {

using Words = std::vector<std::string>;

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }

/// The words of "MaterialID_beauty 01" in small letters: material, id, beauty.
Words words_of(const std::string& name) {
    Words out(1);
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        const bool letter = is_upper(c) || is_lower(c);
        const bool after_small = i > 0 && is_lower(name[i - 1]);
        const bool before_small = i + 1 < name.size() && i > 0 && is_upper(name[i - 1]) && is_lower(name[i + 1]);
        if ((!letter || (is_upper(c) && (after_small || before_small))) && !out.back().empty()) out.emplace_back();
        if (letter) out.back() += lower(std::string(1, c))[0];
    }
    if (out.back().empty()) out.pop_back();
    return out;
}

template <std::size_t N>
bool is_among(const std::string& word, const std::string_view (&list)[N]) {
    return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

std::string joined(const Words& words) {
    std::string out;
    for (const std::string& word : words) out += word;
    return out;
}

bool is_whole(const Words& words) {
    constexpr std::string_view names[] = {"combined", "rgba",    "rgb",        "beauty",      "color",
                                          "colour",   "main",    "image",      "final",       "finalimage",
                                          "master",   "primary", "rgbcolor",   "colorrgb",    "c",
                                          "ci",       "cia",     "finalcolor", "finalrender", "effectsresult"};
    return is_among(joined(words), names);
}

bool has_whole(const Words& words) {
    constexpr std::string_view names[] = {"combined", "rgba", "rgb", "beauty"};
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return is_among(word, names); });
}

bool holds_no_light(const Words& words) {
    constexpr std::string_view any[] = {
        "ao",        "occlusion", "depth",     "zdepth",    "zbuffer",   "zbuf",    "normal",      "normals",
        "nrm",       "norm",      "tangent",   "position",  "positions", "pos",     "pworld",      "pref",
        "uv",        "uvs",       "motion",    "velocity",  "vector",    "vectors", "mist",        "id",
        "ids",       "index",     "mask",      "masks",     "matte",     "mattes",  "multimatte",  "puzzlematte",
        "shadow",    "shadows",   "alpha",     "opacity",   "coverage",  "albedo",  "roughness",   "metallic",
        "metalness", "facing",    "wireframe", "curvature", "variance",  "mse",     "samplecount", "heatmap"};
    constexpr std::string_view all[] = {"z",
                                        "zback",
                                        "n",
                                        "ng",
                                        "ns",
                                        "nn",
                                        "p",
                                        "st",
                                        "mv",
                                        "wire",
                                        "samples",
                                        "ambocc",
                                        "ambientocclusion",
                                        "objectid",
                                        "materialid",
                                        "indexob",
                                        "indexma",
                                        "diffcol",
                                        "glosscol",
                                        "transcol",
                                        "subsurfacecol",
                                        "volumecol",
                                        "basecolor",
                                        "basecolour",
                                        "diffusecolor",
                                        "diffusecolour",
                                        "specularcolor",
                                        "diffusefilter"};
    const std::string name = joined(words);
    if (name.find("crypto") != std::string::npos || is_among(name, all)) return true;
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return is_among(word, any); });
}

std::vector<Words> components_of(const std::string& name) {
    std::vector<Words> out;
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find('.', begin), name.size());
        if (Words words = words_of(name.substr(begin, end - begin)); !words.empty())
            out.push_back(std::move(words));
        begin = end + 1;
    }
    return out;
}

} // namespace

LayerKind kind_of_layer(const std::string& name) {
    const std::vector<Words> components = components_of(name);
    if (components.empty()) return LayerKind::unnamed;
    const std::string first = joined(components.front()), last = joined(components.back());
    const bool no_light = std::any_of(components.begin(), components.end(), holds_no_light);
    // A part "AO" may have a layer "rgb"; Blender's Combined is the picture of any view layer, whatever its name.
    if (is_whole(components.back()) && (!no_light || last == "combined"))
        return first == "composite" ? LayerKind::composite : LayerKind::whole;
    if (components.size() == 1 && first == "composite") return LayerKind::composite;
    if (no_light) return LayerKind::no_light;
    return std::any_of(components.begin(), components.end(), has_whole) ? LayerKind::variant : LayerKind::other;
}

} // namespace acdf::input
