#include "tools/cli/target_memory.h"

#include "input/probe/image_header.h"

namespace acdf::tools {
namespace {

constexpr std::uint64_t kPixel = 12;               // red, green and blue
constexpr std::uint64_t kCovered = 8, kLookup = 4; // of each pixel that is resampled
constexpr std::uint64_t kTexelsOfPixel = 2;        // of the grid that a map is resampled to, at most
constexpr std::uint64_t kOverlap = 24 << 20;       // what lib/build/probe/overlap.h keeps of small maps
constexpr std::uint64_t kValue = 4;                // a float

/// As far as its header and the options show.
bool is_resampled(const input::ImageSize& size, const input::ProbeOptions& options) {
    const bool latlong = options.projection == input::Projection::automatic
                             ? !options.faces && size.width == 2 * size.height
                             : options.projection == input::Projection::latlong;
    return !latlong || options.domain == input::Domain::octahedral;
}

/// Bytes of a texel: g, its largest value, and means of channels.
std::uint64_t bytes_of_texel(const builder::TargetOptions& options, bool resampled) {
    const bool separate = options.channels.mode == ACDF_CHANNELS_SEPARATE;
    const bool between = resampled || options.filter == ACDF_FILTER_BILINEAR;
    const std::uint64_t means = separate ? 3 : between ? 1 : 0;
    return kValue * (1 + (between ? 1 : 0) + means);
}

} // namespace

TargetMemory target_memory(const std::string& source, const input::ProbeOptions& reading,
                           const builder::TargetOptions& options) {
    const input::ImageSize size = input::image_size(source);
    const std::uint64_t pixels = size.pixels();
    const bool resampled = is_resampled(size, reading), whole = reading.bad_pixels == build::BadPixels::clamp;
    const std::uint64_t planes = options.channels.mode == ACDF_CHANNELS_SEPARATE ? 3 : 1;
    TargetMemory out;
    out.texels = resampled ? kTexelsOfPixel * pixels : pixels;
    out.target = out.texels * bytes_of_texel(options, resampled);
    out.reading = out.target + pixels * kValue * planes;
    if (whole || resampled) out.reading += pixels * kPixel;
    if (resampled) out.reading += pixels * (kCovered + kLookup) + kOverlap;
    return out;
}

} // namespace acdf::tools
