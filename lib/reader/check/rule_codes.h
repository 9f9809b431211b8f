// What opening returns where a rule of format/SPEC.md is broken. Not installed.
#pragma once

#include <acdf/reader.h>

namespace acdf {

/// ACDF_OK for rules of which only a warning is reported: such a file is read.
AcdfErrorCode code_of(int rule) noexcept;

} // namespace acdf
