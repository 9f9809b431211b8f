// What readers of formats that have one part and no attributes have in common.
#pragma once

#include "images/module.h"

namespace acdf::images {

inline bool seek_one_part(void*, int part, Header&) { return part == 0; }
inline std::string no_text(const void*, const char*) { return ""; }
inline int no_integer(const void*, const char*, int otherwise) { return otherwise; }
inline float no_real(const void*, const char*, float otherwise) { return otherwise; }

} // namespace acdf::images
