// An MIS partner in the words of the command line.
#pragma once

#include "compress/partner.h"

#include <string>

namespace acdf::build {

/// "none", "cosine", "brdf", "mean", "table".
const char* partner_name(AcdfPartnerKind kind);
/// "balance" or "power".
const char* heuristic_name(AcdfHeuristic heuristic);
/// "--mis cosine --shares 2:1 --heuristic power ", or empty for none; options that have their defaults are left
/// out.
std::string partner_text(const compress::Partner& partner);

} // namespace acdf::build
