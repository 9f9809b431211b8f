// `acdf measure` for BRDFs.
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <string>

namespace acdf::tools {

/// Compares a BRDF file with `source`, on `view_count` random views, and with what else one could sample by: the
/// full table of Lawrence et al. 2005, §6.2, the best-fitting GGX lobe and the cosine. Prints text or JSON. Throws
/// Failure.
void measure_brdf(const std::string& path, const File& file, const std::string& source, std::uint32_t view_count,
                  bool json, bool quiet);

} // namespace acdf::tools
