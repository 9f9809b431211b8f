#include "tools/cli/usage.h"

#include "tools/cli/messages.h"

#include <CLI/CLI.hpp>

namespace acdf::tools {

std::string what_is_wrong(const CLI::ParseError& error) {
    const std::string text = on_one_line(error.what());
    const auto option = [&](const char* what) { return text.substr(0, text.find(what)); };
    if (text.find(": 1 required ") != std::string::npos) return option(": 1 required ") + ": needs a value";
    if (text.find(": At Most 1 required ") != std::string::npos)
        return option(": At Most ") + ": is given more than once";
    const std::string at_least = ": At least ";
    if (const std::size_t count = text.find(at_least), end = text.find(" required but received ");
        count < end && end != std::string::npos)
        return option(at_least.c_str()) + ": needs " +
               text.substr(count + at_least.size(), end - count - at_least.size()) +
               " numbers with commas between them";
    return text;
}

} // namespace acdf::tools
