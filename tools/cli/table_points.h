// Points of tables as text, and the bin they are in.
#pragma once

#include "tools/cli/comma_list.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// --at: an index for each indexed axis.
inline void add_bin(CLI::App& command, std::vector<std::string>& at, const char* group) {
    comma_separated(command.add_option("--at", at,
                                       "Of a table with indexed axes: which bin, by its index on each of them, "
                                       "from 0 (--at 3,0). Of an environment "
                                       "of several maps: where among them, by name (--at time=9.5)"))
        ->option_text("I,J,...|NAME=V,...")
        ->group(group);
}

/// The index that --at gave. Throws CLI::ValidationError where that is no list of numbers, and Failure where it is
/// not one of the table's.
std::vector<std::uint32_t> chosen_bin(const std::string& path, const TableView& view,
                                      const std::vector<std::string>& at);

/// "x0", "x1", ...
std::vector<std::string> point_names(std::uint32_t n);
/// "x0,x1," for the letter x and 2 axes.
std::string point_columns(const std::string& letter, std::uint32_t n);

/// 17 digits: read back, they are the same double.
std::string number_text(double value);
/// "0.25,1.5,"
std::string point_text(const double* x, std::size_t n);

} // namespace acdf::tools
