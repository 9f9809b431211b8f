// What a batch made, at a glance: a page of thumbnails.
#pragma once

#include "tools/batch/plan.h"
#include "tools/batch/report.h"

#include <string>
#include <vector>

namespace acdf::tools {

/// How every page made here begins.
extern const char gallery_mark[];

/// A page that is one file: for each job its source and its pdf in false colours, each in a range of its own,
/// size and noise; what failed comes last, with its error. `folder` is where outputs lie, `plan` has the job of
/// each result. An environment is shown as a lat-long map, a local one for the normal +z, a BRDF on the hemisphere
/// for a view at 45 degrees. Sources are read once more.
std::string gallery_page(const BatchReport& report, const std::string& folder, const std::vector<PlannedJob>& plan,
                         const MakeConversion& make);

} // namespace acdf::tools
