// What fits say of goals that no tree reaches.
#pragma once

#include <cstdint>
#include <stdexcept>

namespace acdf::compress {

/// `what` of `wanted` cannot be had; `least` can.
std::runtime_error out_of_reach(const char* what, double wanted, double least);

/// A relative variance of `wanted` takes more than `bytes`, which come to `reached`.
std::runtime_error variance_beyond(std::uint64_t bytes, double wanted, double reached);

} // namespace acdf::compress
