// How a file is combined with its MIS partner, as people write it.
#pragma once

#include <acdf/builder.h>

#include <string>

namespace acdf::tools {

/// "2:1" as samples of the file and of its partner; false for anything else, and out of [0.001, 1000].
bool parse_shares(const std::string& text, builder::Partner& partner);
/// "cosine", "brdf", "mean" and "none"; "balance" and "power". False for anything else.
bool parse_partner(const std::string& text, builder::Partner& partner);
bool parse_heuristic(const std::string& text, builder::Partner& partner);

} // namespace acdf::tools
