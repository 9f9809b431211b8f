// What lies where a file should, once version control or a server did not hand the file itself over.
#pragma once

#include <string>

namespace acdf::input {

/// Throws Error where a regular file is a pointer of Git LFS or git-annex, or a web page. No input begins as they
/// do.
void refuse_stand_in(const std::string& path);

} // namespace acdf::input
