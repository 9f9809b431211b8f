#include "images/image_file.h"

#include "images/float_map.h"
#include "images/radiance.h"

#include <array>
#include <filesystem>
#include <fstream>

namespace acdf::images {
namespace {

/// Whether a file begins as one of OpenEXR does that has one part in rows, and no deep pixels.
bool begins_as_openexr(const std::string& path) {
    std::array<unsigned char, 8> begin{}; // its number, the version, flags
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(begin.data()), begin.size());
    constexpr unsigned kTilesDeepOrParts = 0x1A;
    return begin[0] == 0x76 && begin[1] == 0x2F && begin[2] == 0x31 && begin[3] == 0x01 && begin[4] == 2 &&
           (begin[5] & kTilesDeepOrParts) == 0;
}

} // namespace

ImageFile::ImageFile(const std::string& path, int threads) : path_(path), threads_(threads) {
    std::error_code error; // a pipe is not looked into
    const bool regular = std::filesystem::is_regular_file(path, error);
    if (regular && (open(float_map_reader()) || open(radiance_reader()))) return;
    if (regular && begins_as_openexr(path) && open(openexr_module().reader)) return;
    open(module().reader);
}

bool ImageFile::open(const ImageReader& reader) {
    reader_ = &reader;
    error_.clear();
    image_ = {reader.open(path_, threads_, header_, error_), reader.close};
    return is_open();
}

bool ImageFile::read(const Rows& rows, float* to) {
    if (reader_->read(image_.get(), rows, to, error_)) return true;
    // What is wrong with a file, and whether it can be read all the same, OpenImageIO tells.
    const ImageReader& other = module().reader;
    return reader_ != &other && open(other) && reader_->read(image_.get(), rows, to, error_);
}

} // namespace acdf::images
