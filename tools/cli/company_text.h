// How a file is combined with its company, as people write it.
#pragma once

#include <acdf/builder.h>

#include <string>

namespace acdf::tools {

/// "2:1" as samples of the file and of its company; false for anything else, and out of [0.001, 1000].
bool parse_shares(const std::string& text, builder::Company& company);
/// "cosine", "brdf", "mean" and "none"; "balance" and "power". False for anything else.
bool parse_company(const std::string& text, builder::Company& company);
bool parse_heuristic(const std::string& text, builder::Company& company);

} // namespace acdf::tools
