// Plots as the bytes of image files.
#pragma once

#include "images/picture.h"
#include "tools/plot/pdf_image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// What an image says of itself.
struct ImageNotes {
    std::string software, description;
};

/// RGB floats as displayed, rounded to 8 bits. Throws std::runtime_error.
std::vector<std::uint8_t> encode_png(const images::Picture& picture, const ImageNotes& notes);

/// The floats of an RGB image as they are. Throws std::runtime_error.
std::vector<std::uint8_t> encode_rgb_exr(const images::Picture& picture, const ImageNotes& notes);

/// One float channel Y: the pdf in sr^-1, and 0 where nothing is shown. Throws std::runtime_error.
std::vector<std::uint8_t> encode_exr(const PdfImage& image, const ImageNotes& notes);

} // namespace acdf::tools
