#include "parts.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>

namespace acdf::images {

// In memory, so that pictures go to pipes too, and are written as all other output is.
bool encode_picture(const Picture& picture, const Encoding& encoding, std::vector<std::uint8_t>& bytes,
                    std::string& error) {
    OIIO::ImageSpec spec(picture.width, picture.height, picture.channels,
                         encoding.eight_bits ? OIIO::TypeUInt8 : OIIO::TypeFloat);
    if (!encoding.channels.empty()) spec.channelnames = encoding.channels;
    for (const Attribute& attribute : encoding.attributes) {
        if (attribute.is_number) spec.attribute(attribute.name, attribute.number);
        else spec.attribute(attribute.name, attribute.text);
    }
    spec.attribute("DateTime", ""); // else OpenImageIO writes the time of day: other bytes on every run
    OIIO::Filesystem::IOVecOutput memory;
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(encoding.name, &memory);
    if (!output) {
        error = "cannot be written: " + OIIO::geterror();
        return false;
    }
    if (!output->open(encoding.name, spec) || !output->write_image(OIIO::TypeFloat, picture.values.data()) ||
        !output->close()) {
        error = "cannot be made: " + output->geterror();
        return false;
    }
    bytes = memory.buffer();
    return true;
}

} // namespace acdf::images
