// Options of files that are made for a company: --with, --shares, --heuristic.
#pragma once

#include <acdf/builder.h>

namespace CLI {
class App;
}

namespace acdf::tools {

/// `mean`: whether there is --with mean.
void add_company(CLI::App& command, builder::Company& company, bool mean);
/// Adds --shares and --heuristic.
void add_weighing(CLI::App& command, builder::Company& company);

} // namespace acdf::tools
