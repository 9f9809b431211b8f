// An image file that is open for reading.
#pragma once

#include "images/module.h"

#include <memory>
#include <string>

namespace acdf::images {

/// One part of an image file at a time, the first at first; every format that OpenImageIO reads, and as it reads
/// it. Not for several threads.
class ImageFile {
public:
    /// `threads` 0: all cores. Throws std::runtime_error only where the module is needed and missing.
    explicit ImageFile(const std::string& path, int threads = 0);

    /// Whether it could be opened. If not, error() says why, and nothing else may be called.
    bool is_open() const { return image_ != nullptr; }
    /// What went wrong last.
    const std::string& error() const { return error_; }

    const Header& header() const { return header_; }
    bool seek(int part) { return reader_->seek(image_.get(), part, header_); }
    bool read(const Rows& rows, float* to);

    std::string text(const char* name) const { return reader_->text(image_.get(), name); }
    int integer(const char* name, int otherwise) const { return reader_->integer(image_.get(), name, otherwise); }
    float real(const char* name, float otherwise) const { return reader_->real(image_.get(), name, otherwise); }

private:
    bool open(const ImageReader& reader);

    std::string path_;
    int threads_;
    const ImageReader* reader_ = nullptr;
    Header header_;
    std::string error_;
    std::unique_ptr<void, void (*)(void*)> image_{nullptr, nullptr};
};

} // namespace acdf::images
