// Pieces of pages that are one file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// Text in HTML and XML, in elements and in quoted attributes.
std::string escaped(const std::string& text);

/// A PNG as an element that holds all of it.
std::string html_image(const std::vector<std::uint8_t>& png, int width, int height, const std::string& alternative);

} // namespace acdf::tools
