// What is wrong with a command line.
#pragma once

#include <string>

namespace CLI {
class ParseError;
}

namespace acdf::tools {

/// In our words: CLI11 tells an option without its value, or with commas alone, by the name of a type, which may be
/// empty. One line.
std::string what_is_wrong(const CLI::ParseError& error);

} // namespace acdf::tools
