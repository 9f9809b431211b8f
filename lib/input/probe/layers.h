// Which channels of an image file are its light, among layers and parts that hold other things.
#pragma once

#include <string>
#include <vector>

namespace acdf::input {

/// Where the channels of a texel are among those of a part.
struct Channels {
    int index[3] = {0, 0, 0}; ///< all equal: grey
    bool grey() const { return index[0] == index[1] && index[1] == index[2]; }
    bool in_order() const { return index[1] == index[0] + 1 && index[2] == index[0] + 2; }
};

/// What a part of an image file says of its channels.
struct PartNames {
    int number = 0;
    std::string name; ///< of the part; often empty
    std::vector<std::string> channels;
    bool xyz = false; ///< the primaries that it declares are those of CIE XYZ
};

struct Choice {
    int part = 0;
    Channels channels;
    std::string remark; ///< which layers there were, where more than one may be meant
    std::string error;  ///< one line, where none was chosen: what there is, and what would help
};

/// Chooses by what layers are: R, G and B without a layer, else the layer that is the whole picture by its name
/// ("Combined", "rgba", "beauty"), else the only one that may hold light. Names are looked up whatever their case,
/// of parts and layers alike. Cryptomattes, occlusion, depths, normals, positions, albedos and identifiers are
/// never chosen. Y, and a single channel that is none of these by its name, are grey. Of layers that are as good as
/// each other none is chosen.
Choice choose_layer(std::vector<PartNames> parts);

} // namespace acdf::input
