// What a batch made, at a glance: a page of thumbnails.
#pragma once

#include "tools/batch/report.h"

#include <string>

namespace acdf::tools {

/// How every page made here begins.
extern const char gallery_mark[];

/// A page that is one file: for each job its density in false colours, each in a range of its own, size and noise;
/// what failed comes last, with its error. `folder` is where outputs lie. An environment is shown as a lat-long
/// map, a local one for the normal +z, a BRDF on the hemisphere for a view at 45 degrees.
std::string gallery_page(const BatchReport& report, const std::string& folder);

} // namespace acdf::tools
