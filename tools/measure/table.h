// `acdf measure` for tables.
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <string>

namespace acdf::tools {

/// Compares a table file with the .npy file at `source`, beside that at `other` if it has an MIS partner, and
/// prints what comes out: as text or JSON. Throws Failure.
void measure_table(const std::string& path, const File& file, const std::string& source, const std::string& other,
                   bool json, bool quiet);

} // namespace acdf::tools
