#include "tools/plot/image.h"

#include "images/image_file.h"

#include <algorithm>

namespace acdf::tools {
namespace {

using images::Attribute;

const Attribute zip{"compression", "zip"};

std::vector<std::uint8_t> encode(const images::Picture& picture, images::Encoding encoding,
                                 const ImageNotes& notes) {
    encoding.attributes.push_back({"Software", notes.software});
    encoding.attributes.push_back({"ImageDescription", notes.description});
    return images::encode(picture, encoding);
}

} // namespace

std::vector<std::uint8_t> encode_png(const images::Picture& picture, const ImageNotes& notes) {
    return encode(picture,
                  {"picture.png", true, {}, {{"oiio:ColorSpace", "sRGB"}, {"png:compressionLevel", "", true, 9}}},
                  notes);
}

std::vector<std::uint8_t> encode_rgb_exr(const images::Picture& picture, const ImageNotes& notes) {
    return encode(picture, {"picture.exr", false, {}, {zip}}, notes);
}

std::vector<std::uint8_t> encode_exr(const DensityImage& image, const ImageNotes& notes) {
    images::Picture picture(image.map.width, image.map.height, 1);
    std::replace_copy(image.density.begin(), image.density.end(), picture.values.begin(), shows_nothing, 0.0f);
    return encode(picture, {"picture.exr", false, {"Y"}, {zip}}, notes);
}

} // namespace acdf::tools
