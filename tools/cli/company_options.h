// Options of files that are made for a company: --with, --shares, --heuristic.
#pragma once

#include <acdf/builder.h>

#include <CLI/CLI.hpp>

#include <string>

namespace acdf::tools {

/// "2:1" as samples of the file and of its company; false for anything else, and out of [0.001, 1000].
bool parse_shares(const std::string& text, builder::Company& company);
/// "cosine", "brdf", "mean" and "none"; "balance" and "power". False for anything else.
bool parse_company(const std::string& text, builder::Company& company);
bool parse_heuristic(const std::string& text, builder::Company& company);

/// `mean`: whether there is --with mean.
void add_company(CLI::App& command, builder::Company& company, bool mean);
/// Adds --shares and --heuristic.
void add_weighing(CLI::App& command, builder::Company& company);

} // namespace acdf::tools
