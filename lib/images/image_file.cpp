#include "images/image_file.h"

#include "images/float_map.h"

#include <stdexcept>

namespace acdf::images {

ImageFile::ImageFile(const std::string& path, int threads)
    : reader_(&float_map_reader()), image_(reader_->open(path, threads, header_, error_), reader_->close) {
    if (image_) return;
    reader_ = &module().reader;
    image_ = {reader_->open(path, threads, header_, error_), reader_->close};
}

std::vector<std::uint8_t> encode(const Picture& picture, const Encoding& encoding) {
    std::vector<std::uint8_t> bytes;
    std::string error;
    if (!module().encode(picture, encoding, bytes, error)) throw std::runtime_error(encoding.name + ": " + error);
    return bytes;
}

} // namespace acdf::images
