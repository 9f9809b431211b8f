#include "images/image_file.h"

#include <stdexcept>

namespace acdf::images {

ImageFile::ImageFile(const std::string& path, int threads)
    : module_(module()), image_(module_.open(path, threads, header_, error_), module_.close) {}

std::vector<std::uint8_t> encode(const Picture& picture, const Encoding& encoding) {
    std::vector<std::uint8_t> bytes;
    std::string error;
    if (!module().encode(picture, encoding, bytes, error)) throw std::runtime_error(encoding.name + ": " + error);
    return bytes;
}

} // namespace acdf::images
