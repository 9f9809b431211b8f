#include "images/image_file.h"

#include "images/float_map.h"
#include "images/openexr_header.h"
#include "images/radiance.h"

#include <filesystem>

namespace acdf::images {
ImageFile::ImageFile(const std::string& path, int threads) : path_(path), threads_(threads) {
    std::error_code error; // a pipe is not looked into
    const bool regular = std::filesystem::is_regular_file(path, error);
    if (regular && (open(float_map_reader()) || open(radiance_reader()))) return;
    if (regular) error_ = openexr_claims_too_much(path);
    if (!error_.empty()) return;
    if (regular && is_usual_openexr(path) && open(openexr_module().reader)) return;
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
    // OpenImageIO reports errors of a file, and whether it can be read all the same.
    const ImageReader& other = module().reader;
    if (reader_ == &other || !other.read) return false;
    return open(other) && reader_->read(image_.get(), rows, to, error_);
}

} // namespace acdf::images
