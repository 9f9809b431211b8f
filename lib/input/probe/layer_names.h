// What the name of a layer says of what it holds.
#pragma once

#include <string>

namespace acdf::input {

/// From the best to the worst, where light is looked for.
enum class LayerKind {
    unnamed,   ///< the picture itself
    composite, ///< the picture that Blender's compositor made of the others
    whole,     ///< "Combined", "rgba", "beauty", ...
    variant,   ///< such a word among others: "beauty_denoised", "rgba.left"
    other,     ///< maybe a part of the light: "diffuse", "sky"
    no_light   ///< cryptomattes, occlusion, depths, normals, positions, albedos, identifiers, ...
};

/// `name`: that of a part, of layers within it and of their layers, with dots between; any of them may be missing.
/// What the last one is counts most.
LayerKind kind_of_layer(const std::string& name);

} // namespace acdf::input
