#include "parts.h"

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>

namespace acdf::images {
namespace {

namespace algo = OIIO::ImageBufAlgo;

// Both draw on the pixels where they are.
OIIO::ImageBuf buffer_of(const Picture& picture) {
    return OIIO::ImageBuf(OIIO::ImageSpec(picture.width, picture.height, picture.channels, OIIO::TypeFloat),
                          const_cast<float*>(picture.values.data()));
}

} // namespace

bool map_colours(const Picture& positions, const std::string& name, const std::vector<float>& knots,
                 Picture& colours, std::string& error) {
    const OIIO::ImageBuf scalar = buffer_of(positions);
    const OIIO::ImageBuf mapped = knots.empty()
                                      ? algo::color_map(scalar, 0, name)
                                      : algo::color_map(scalar, 0, static_cast<int>(knots.size() / 3), 3, knots);
    if (mapped.has_error()) {
        error = mapped.geterror();
        return false;
    }
    colours = Picture(positions.width, positions.height);
    const auto* rgb = static_cast<const float*>(mapped.localpixels());
    std::copy_n(rgb, colours.values.size(), colours.values.data());
    return true;
}

bool width_of_text(const std::string& text, int size, const std::string& font, int& width) {
    const OIIO::ROI roi = algo::text_size(text, size, font);
    if (!roi.defined()) return false;
    width = roi.xend; // from the pen's position: leading space counts
    return true;
}

void draw_text_in(Picture& picture, int x, int y, const std::string& text, int size, const std::string& font,
                  const float colour[3]) {
    OIIO::ImageBuf buffer = buffer_of(picture);
    algo::render_text(buffer, x, y, text, size, font, OIIO::cspan<float>(colour, 3), algo::TextAlignX::Left,
                      algo::TextAlignY::Baseline);
}

} // namespace acdf::images
