#include "tools/plot/image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace acdf::tools {
namespace {

// In memory, so that pictures go to pipes too, and are written as all other output is.
std::vector<std::uint8_t> encode(const char* name, OIIO::ImageSpec spec, const float* pixels,
                                 const ImageNotes& notes) {
    spec.attribute("Software", notes.software);
    spec.attribute("ImageDescription", notes.description);
    spec.attribute("DateTime", ""); // else OpenImageIO writes the time of day into OpenEXR files
    OIIO::Filesystem::IOVecOutput memory;
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name, &memory);
    if (!output) throw std::runtime_error(std::string(name) + ": cannot be written: " + OIIO::geterror());
    if (!output->open(name, spec) || !output->write_image(OIIO::TypeFloat, pixels) || !output->close())
        throw std::runtime_error(std::string(name) + ": cannot be made: " + output->geterror());
    return memory.buffer();
}

} // namespace

std::vector<std::uint8_t> encode_png(const OIIO::ImageBuf& picture, const ImageNotes& notes) {
    OIIO::ImageSpec spec(picture.spec().width, picture.spec().height, 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("png:compressionLevel", 9);
    return encode("picture.png", spec, static_cast<const float*>(picture.localpixels()), notes);
}

std::vector<std::uint8_t> encode_rgb_exr(const OIIO::ImageBuf& picture, const ImageNotes& notes) {
    OIIO::ImageSpec spec(picture.spec().width, picture.spec().height, 3, OIIO::TypeFloat);
    spec.attribute("compression", "zip");
    return encode("picture.exr", spec, static_cast<const float*>(picture.localpixels()), notes);
}

std::vector<std::uint8_t> encode_exr(const DensityImage& image, const ImageNotes& notes) {
    OIIO::ImageSpec spec(image.map.width, image.map.height, 1, OIIO::TypeFloat);
    spec.channelnames = {"Y"};
    spec.attribute("compression", "zip");
    std::vector<float> pixels = image.density;
    std::replace(pixels.begin(), pixels.end(), shows_nothing, 0.0f);
    return encode("picture.exr", spec, pixels.data(), notes);
}

} // namespace acdf::tools
