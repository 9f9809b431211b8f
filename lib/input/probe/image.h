// The pixels of an image file, before anything is known of its projection.
#pragma once

#include <acdf/builder.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace acdf::input {

/// What the file says it is: OpenEXR's envmap attribute, or the texture format of maketx.
enum class EnvironmentTag { none, latlong, cube };

/// RGB of the display window, row-major from the top left, turned upright. Linear, as stored otherwise: no
/// exposure, no change of primaries, bad texels included.
struct Image {
    int width = 0, height = 0;
    std::vector<float> rgb; ///< height x width x 3
    bool half = false;      ///< stored as half floats, which end at 65504
    /// What luminance is by the primaries of the file; none where they are as good as those of Rec. 709.
    std::optional<builder::ChannelWeights> luminance;
    EnvironmentTag tag = EnvironmentTag::none;
    std::vector<std::string> warnings;
};

std::string shape(const Image& image); ///< "1024x512"

/// Takes `count` rows of RGB texels, of which `first` is the number of the first, from the top to the bottom.
using TakeRows = std::function<void(int first, int count, float* rgb)>;

/// Reads the part that is the light (layers.h), at full resolution. `threads` as in ProbeOptions. Throws Error.
///
/// `stream` is asked first, with an image that has no pixels yet: what it returns, if anything, takes the rows in
/// bands, and the image stays without them. Memory is then that of a band.
Image read_image(const std::string& path, int threads,
                 const std::function<TakeRows(const Image& image)>& stream = {});

} // namespace acdf::input
