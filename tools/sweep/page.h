// One page that reports what a sweep found: plots, pictures, a recommendation. It stands alone: no network, no
// scripts.
#pragma once

#include "tools/sweep/sweep.h"

#include <string>

namespace acdf::tools {

/// UTF-8. The same for the same sweep; whatever names hold is shown as text.
std::string sweep_html(const Sweep& sweep);

} // namespace acdf::tools
