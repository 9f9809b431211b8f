// What is looked at of an OpenEXR file before a library opens it.
#pragma once

#include <string>

namespace acdf::images {

/// Whether a file begins as an OpenEXR file that has one part in rows, and no deep pixels.
bool is_usual_openexr(const std::string& path);

/// What is wrong with an OpenEXR file whose header has an attribute that claims more bytes than follow it; else,
/// and for files of other kinds, nothing. Libraries ask for up to 2 GiB on such a claim before they find that the
/// file ends. After "OpenEXR File Layout", openexr.com.
std::string openexr_claims_too_much(const std::string& path);

} // namespace acdf::images
