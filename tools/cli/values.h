// What no option takes as its value, whatever it is for.
#pragma once

#include <CLI/CLI.hpp>

#include <charconv>
#include <cstdint>
#include <string>

namespace acdf::tools {

/// Leaves decimal digits as they are, but for zeros before them: CLI11 would take them for octal digits. What is
/// wrong with any other text, and with numbers beyond 64 bits, of which CLI11 would take the nearest.
inline std::string to_whole_number(std::string& text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument)
        return "'" + text + "' is not a whole number";
    if (error != std::errc()) return "'" + text + "' is too large";
    text = std::to_string(value);
    return "";
}

/// Makes all options of a command refuse empty text, as of a variable of the shell that is not set, and those that
/// take counts refuse what is none.
inline void refuse_what_is_no_value(CLI::App& command) {
    for (CLI::Option* option : command.get_options()) {
        if (option->get_positional() || option->get_items_expected_max() == 0) continue;
        const std::string type = option->get_type_name();
        const bool count = type.rfind("UINT", 0) == 0 || type.rfind("INT", 0) == 0;
        option->transform(CLI::Validator(
            [count](std::string& text) {
                if (text.empty()) return std::string("needs a value");
                return count ? to_whole_number(text) : std::string();
            },
            ""));
    }
}

} // namespace acdf::tools
