// Reasons why a file cannot be built, beside std::invalid_argument and std::runtime_error.
#pragma once

#include "compress/no_energy.h"

#include <stdexcept>

namespace acdf::build {

/// An option is out of its range, or contradicts another one or the source.
struct OptionError : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

using compress::NoEnergy;

/// The caller's progress callback said no. Not a std::runtime_error, which says that a goal is out of reach.
struct Cancelled : std::exception {
    const char* what() const noexcept override { return "cancelled"; }
};

/// A callback of the caller threw, or gave up.
struct CallbackFailed : std::exception {
    const char* what() const noexcept override { return "a callback failed"; }
};

} // namespace acdf::build
