// Where fonts are.
#pragma once

#include <string>

namespace acdf::images {

/// The path of a TrueType or PostScript font by its name without extension ("DejaVuSans"), in the folders where
/// systems and people keep fonts and in those below; empty where none has it.
std::string find_font_file(const std::string& name);

} // namespace acdf::images
