// The conversion of a job of `acdf batch`.
#pragma once

#include "tools/batch/plan.h"

namespace acdf::tools {

/// MakeConversion of this program: options are read as on the command line of the kind.
std::shared_ptr<Conversion> make_conversion(const BatchJob& job);

} // namespace acdf::tools
