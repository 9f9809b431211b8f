// Pieces of pages that are one file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// A line in the head of such a page: whatever comes into it from names and metadata, a browser runs no script,
/// loads nothing and sends nothing.
constexpr const char* closed_page_policy =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
    "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n";

/// Text in HTML and XML, in elements and in quoted attributes.
std::string escaped(const std::string& text);

/// Bytes in the 64 letters of RFC 4648, with padding.
std::string base64(const std::vector<std::uint8_t>& bytes);

/// A PNG as an element that holds all of it.
std::string html_image(const std::vector<std::uint8_t>& png, int width, int height, const std::string& alternative);

} // namespace acdf::tools
