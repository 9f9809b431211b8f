#include "tools/plot/image.h"

#include "images/openexr.h"
#include "images/png.h"

#include <algorithm>

namespace acdf::tools {
namespace {

std::vector<images::Note> in_file(const ImageNotes& notes) {
    return {{"Software", notes.software}, {"Description", notes.description}};
}

} // namespace

std::vector<std::uint8_t> encode_png(const images::Picture& picture, const ImageNotes& notes) {
    return images::encode_png(picture, in_file(notes));
}

std::vector<std::uint8_t> encode_rgb_exr(const images::Picture& picture, const ImageNotes& notes) {
    return images::encode_exr(picture, {"R", "G", "B"}, in_file(notes));
}

std::vector<std::uint8_t> encode_exr(const PdfImage& image, const ImageNotes& notes) {
    images::Picture picture(image.map.width, image.map.height, 1);
    std::replace_copy(image.pdf.begin(), image.pdf.end(), picture.values.begin(), shows_nothing, 0.0f);
    return images::encode_exr(picture, {"Y"}, in_file(notes));
}

} // namespace acdf::tools
