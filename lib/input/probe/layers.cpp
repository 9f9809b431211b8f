#include "input/probe/layers.h"

#include "input/file_name.h"
#include "input/probe/layer_names.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace acdf::input {
namespace {

using Names = std::vector<std::string>;

std::string listed(const Names& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size() && i < 12; ++i) text += (i ? ", " : "") + names[i];
    return names.size() > 12 ? text + ", ..." : text;
}

std::optional<int> find_channel(const Names& names, const std::string& name) {
    for (std::size_t i = 0; i < names.size(); ++i)
        if (lower(names[i]) == name) return static_cast<int>(i);
    return std::nullopt;
}

/// Channels that may be the light.
struct Layer {
    const PartNames* part;
    std::string name; ///< with that of the part; empty where neither has one
    LayerKind kind;
    Channels channels;
};

/// "part.layer" without dots at its ends.
std::string full_name(const PartNames& part, std::string layer) {
    const auto is_separator = [](char c) { return c == '.' || c == ':' || c == '/' || c == '_'; };
    while (!layer.empty() && is_separator(layer.back())) layer.pop_back();
    std::replace_if(
        layer.begin(), layer.end(), [](char c) { return c == ':' || c == '/'; }, '.');
    // Blender and Nuke name a part after its layer.
    if (layer.empty() || part.name == layer) return part.name;
    return part.name.empty() ? layer : part.name + "." + layer;
}

/// What stands before the last letters of a channel's name, where they are `end` alone or behind a separator.
std::optional<std::string> stem_of(const std::string& channel, const std::string& end) {
    if (channel.size() < end.size() || channel.compare(channel.size() - end.size(), end.size(), end) != 0)
        return std::nullopt;
    const std::string stem = channel.substr(0, channel.size() - end.size());
    if (stem.empty() || std::string(".:/_").find(stem.back()) != std::string::npos) return stem;
    return std::nullopt;
}

/// The layer whose first channel this is: R, G and B, or X, Y and Z where they are colours.
std::optional<Channels> triple_at(const PartNames& part, int first, std::string& stem) {
    constexpr const char* of_rgb[][3] = {{"r", "g", "b"}, {"red", "green", "blue"}, {"x", "y", "z"}};
    const std::string name = lower(part.channels[static_cast<std::size_t>(first)]);
    for (const auto& [r, g, b] : of_rgb) {
        const auto found = *r == 'x' && !part.xyz ? std::nullopt : stem_of(name, r);
        if (!found) continue;
        const auto green = find_channel(part.channels, *found + g), blue = find_channel(part.channels, *found + b);
        if (!green || !blue) continue;
        stem = *found;
        return Channels{{first, *green, *blue}};
    }
    return std::nullopt;
}

/// The same where it is a luminance: Y, but not that of a position or a normal.
std::optional<Channels> luminance_at(const PartNames& part, int index, std::string& stem) {
    const auto found = stem_of(lower(part.channels[static_cast<std::size_t>(index)]), "y");
    if (!found || find_channel(part.channels, *found + "x") || find_channel(part.channels, *found + "r"))
        return std::nullopt;
    stem = *found;
    return Channels{{index, index, index}};
}

/// The part of a channel's name that is its layer's, as it is spelled.
std::string spelled(const PartNames& part, int channel, const std::string& stem) {
    return part.channels[static_cast<std::size_t>(channel)].substr(0, stem.size());
}

std::vector<Layer> layers_of(const std::vector<PartNames>& parts) {
    std::vector<Layer> out;
    for (const PartNames& part : parts)
        for (int i = 0; i < static_cast<int>(part.channels.size()); ++i) {
            std::string stem;
            auto channels = triple_at(part, i, stem);
            if (!channels) channels = luminance_at(part, i, stem);
            if (!channels) continue;
            const std::string name = full_name(part, spelled(part, i, stem));
            out.push_back({&part, name, kind_of_layer(name), *channels});
        }
    return out;
}

bool is_alpha(const std::string& channel) {
    const std::string name = lower(channel);
    return name == "a" || (name.size() >= 2 && name.compare(name.size() - 2, 2, ".a") == 0);
}

/// The only channel that may be a colour.
std::vector<Layer> single_channel(const std::vector<PartNames>& parts) {
    std::vector<Layer> out;
    for (const PartNames& part : parts)
        for (int i = 0; i < static_cast<int>(part.channels.size()); ++i) {
            const std::string& channel = part.channels[static_cast<std::size_t>(i)];
            const std::string name = full_name(part, channel);
            if (is_alpha(channel)) continue;
            if (const LayerKind kind = kind_of_layer(name); kind != LayerKind::no_light)
                out.push_back({&part, name, LayerKind::other, {{i, i, i}}});
        }
    return out.size() == 1 ? out : std::vector<Layer>{};
}

std::string name_of(const Layer& layer) {
    return layer.name.empty() ? "part " + std::to_string(layer.part->number) : layer.name;
}

Names names_of(const std::vector<Layer>& layers) {
    Names out;
    for (const Layer& layer : layers) out.push_back(name_of(layer));
    return out;
}

/// The command that makes an image of one layer.
std::string command_for(const Layer& layer, bool several_parts) {
    const auto name = [&](int i) {
        return layer.part->channels[static_cast<std::size_t>(layer.channels.index[i])];
    };
    const std::string quote = (name(0) + name(1) + name(2)).find(' ') == std::string::npos ? "" : "\"";
    return "oiiotool IN " +
           (several_parts ? "--subimage " + std::to_string(layer.part->number) + " " : std::string()) + "--ch " +
           quote + "R=" + name(0) + ",G=" + name(1) + ",B=" + name(2) + quote + " -o OUT.exr";
}

std::string no_layer(const std::vector<PartNames>& parts, const std::vector<Layer>& layers) {
    Names channels;
    for (const PartNames& part : parts)
        for (const std::string& channel : part.channels) channels.push_back(channel);
    std::string text = parts.size() > 1 ? "the channels of its parts are " : "its channels are ";
    text += listed(channels) + ", where R, G, B or a single one is needed";
    if (!layers.empty())
        text += " (" + listed(names_of(layers)) + (layers.size() > 1 ? " are" : " is") + " no light, by the name)";
    return text + "; rename or choose them (" +
           (layers.empty() ? "oiiotool IN --ch R=...,G=...,B=... -o OUT.exr"
                           : command_for(layers[0], parts.size() > 1)) +
           ")";
}

} // namespace

Choice choose_layer(std::vector<PartNames> parts) {
    if (parts.size() == 1) parts[0].name.clear(); // it is the picture, whatever it is called
    std::vector<Layer> layers = layers_of(parts);
    const auto better = [](const Layer& a, const Layer& b) { return a.kind < b.kind; };
    auto best = std::min_element(layers.begin(), layers.end(), better);
    Choice out;
    if (best == layers.end() || best->kind == LayerKind::no_light) {
        std::vector<Layer> single = layers.empty() ? single_channel(parts) : std::vector<Layer>{};
        if (single.empty()) {
            out.error = no_layer(parts, layers);
            return out;
        }
        layers = std::move(single);
        best = layers.begin();
    }
    std::vector<Layer> as_good;
    std::copy_if(layers.begin(), layers.end(), std::back_inserter(as_good),
                 [&](const Layer& layer) { return layer.kind == best->kind; });
    if (as_good.size() > 1) {
        out.error = "any of its layers " + listed(names_of(as_good)) + " may be the light; keep one (" +
                    command_for(as_good[0], parts.size() > 1) + ")";
        return out;
    }
    out.part = best->part->number;
    out.channels = best->channels;
    if (layers.size() > 1 && best->kind != LayerKind::unnamed)
        out.remark = "of the layers " + listed(names_of(layers)) + ", " + name_of(*best) +
                     " is read (oiiotool IN --ch R=...,G=...,B=... -o OUT.exr takes another)";
    return out;
}

} // namespace acdf::input
