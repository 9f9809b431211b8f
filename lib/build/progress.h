// The progress callback of long work.
#pragma once

#include <functional>

namespace acdf::build {

/// Called by long work with the share that is done, in [0, 1], and what is being done ("fitting"). May be called
/// from several threads, and as often as is convenient.
using Progress = std::function<void(double fraction, const char* what)>;

} // namespace acdf::build
