// What every option that takes a number with a fraction is checked by.
#pragma once

// Before validators, which lack it.
#include <CLI/Error.hpp>

#include <CLI/Validators.hpp>

#include <cstdio>
#include <limits>
#include <string>

namespace acdf::tools {

inline std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

/// A number from `low` to `high`, so neither NaN, which the comparisons of CLI::Range let pass, nor infinite.
inline CLI::Validator number_range(double low, double high) {
    const std::string range = short_number(low) + " to " + short_number(high);
    return CLI::Validator(
        [low, high, range](std::string& text) {
            double value = 0.0;
            const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
            return good ? std::string() : "Value " + text + " not in range " + range;
        },
        "FLOAT in [" + short_number(low) + " - " + short_number(high) + "]");
}

/// A number above 0, not infinite.
inline CLI::Validator positive_number() {
    return CLI::Validator(
        [](std::string& text) {
            double value = 0.0;
            const bool good = CLI::detail::lexical_cast(text, value) && value > 0.0 &&
                              value <= std::numeric_limits<double>::max();
            return good ? std::string() : "Value " + text + " is not a number above 0";
        },
        "POSITIVE");
}

} // namespace acdf::tools
