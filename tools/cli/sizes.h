// Sizes as people write them: in bytes (64KiB, 2MB, 1.5 GiB, 1000, "1000 bytes"), and of grids.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace acdf::tools {

/// KiB, MiB, GiB are powers of 1024; k, kB, MB, GB are powers of 1000; case does not matter. A fraction is
/// rounded down to whole bytes. Empty where `text` is no size, is negative or does not fit.
std::optional<std::uint64_t> parse_size(const std::string& text);

/// For people: "64 KiB", "1.52 MiB", "1000 bytes"; at most three digits after rounding, or exact.
std::string to_readable_size(std::uint64_t bytes);

/// "64x32": two counts from 1 to `most`.
bool parse_pair(const std::string& text, std::uint32_t most, std::uint32_t& first, std::uint32_t& second);

} // namespace acdf::tools
