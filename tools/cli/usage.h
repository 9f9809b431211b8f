// What is wrong with a command line.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace acdf::tools {

/// In our words, on one line: CLI11 reports an option without its value, or with commas alone, by the name of a
/// type, which may be empty, and words that nothing takes last first. `program` is what was parsed: names that were
/// likely meant are its own, and those of the subcommand that was called.
std::string what_is_wrong(const CLI::App& program, const CLI::ParseError& error);

/// That there is no such subcommand of `program`, and which was likely meant.
std::string no_such_command(const CLI::App& program, const std::string& name);

} // namespace acdf::tools
