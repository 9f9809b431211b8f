#include "images/openexr.h"

#include "images/module.h"

#include <stdexcept>

namespace acdf::images {

std::vector<std::uint8_t> encode_exr(const Picture& picture, const std::vector<std::string>& channels,
                                     const std::vector<Note>& notes) {
    std::vector<std::uint8_t> bytes;
    std::string error;
    if (!openexr_module().encode(picture, channels, notes, bytes, error))
        throw std::runtime_error("a picture cannot be made: " + error);
    return bytes;
}

} // namespace acdf::images
