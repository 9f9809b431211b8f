// What cannot be fitted, whatever the options.
#pragma once

#include <stdexcept>

namespace acdf::compress {

/// A source is black, or reflects nothing.
struct NoEnergy : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

} // namespace acdf::compress
