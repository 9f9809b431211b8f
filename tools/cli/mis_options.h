// Options of files that are made for an MIS partner: --mis, --shares, --heuristic.
#pragma once

#include <acdf/builder.h>

namespace CLI {
class App;
}

namespace acdf::tools {

/// Of files of a kind: local ones have the cosine alone.
void add_partner(CLI::App& command, builder::Partner& partner, AcdfKind kind);
/// Adds --shares and --heuristic.
void add_weighing(CLI::App& command, builder::Partner& partner);

} // namespace acdf::tools
