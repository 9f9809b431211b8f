// `acdf measure` for tables.
#pragma once

#include <acdf/reader.h>

#include <string>

namespace acdf::tools {

/// Compares a table file with the .npy file at `source` and prints what comes out: as text or JSON. Throws Failure.
void measure_table(const std::string& path, const File& file, const std::string& source, bool json, bool quiet);

} // namespace acdf::tools
