// How a call of acdf/builder.h is watched and cancelled, and what came of it.
#pragma once

#include <functional>

namespace acdf::builder {

/// What kind of failure; the numbers are stable.
enum class ErrorCode : int {
    none = 0,
    invalid_argument = 1, ///< an option is out of its range, or contradicts another one or the input
    bad_source = 2,       ///< the input holds what cannot be built from: NaN that is to be refused, ...
    no_energy = 3,        ///< the input is black, or reflects nothing: there is nothing to sample
    out_of_reach = 4,     ///< no file reaches the goal; the message reports what can be had
    cancelled = 5,        ///< Control::progress returned false
    out_of_memory = 6,
    callback_failed = 7, ///< a callback threw, or Rows::read returned false
    internal = 8,        ///< a mistake of this library
};

/// The outcome of a call.
struct Status {
    ErrorCode code = ErrorCode::none;
    char message[400] = {}; ///< one line, UTF-8: what is wrong and what would help

    /// Whether the call did what it was asked for.
    bool ok() const noexcept { return code == ErrorCode::none; }
};

/// Called with the share that is done, in [0, 1] and never less than before, and what is being done ("fitting").
/// Returning false cancels: the call that is being served returns ErrorCode::cancelled soon, and leaves nothing
/// running. By one thread at a time, not always the same one.
using Progress = std::function<bool(double share, const char* what)>;

/// How a call works; what it makes does not depend on it.
struct Control {
    int threads = 0; ///< at most so many; 0: all cores that oneTBB has
    Progress progress = {};
};

} // namespace acdf::builder
