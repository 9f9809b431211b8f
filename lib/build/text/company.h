// A company in the words of the command line.
#pragma once

#include "compress/company.h"

#include <string>

namespace acdf::build {

/// "none", "cosine", "brdf", "mean", "table".
const char* company_name(AcdfCompanyKind kind);
/// "balance" or "power".
const char* heuristic_name(AcdfHeuristic heuristic);
/// "--with cosine --shares 2:1 --heuristic power ", or empty for none; options that have their defaults are left
/// out.
std::string company_text(const compress::Company& company);

} // namespace acdf::build
