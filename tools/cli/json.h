// How reports are written for scripts.
#pragma once

#include "tools/cli/messages.h"

#include <nlohmann/json.hpp>

#include <string>

namespace acdf::tools {

/// Indented by two, with a line end, and safe on a terminal. Bytes that are no UTF-8 become U+FFFD: JSON has no way
/// to write them.
inline std::string json_text(const nlohmann::ordered_json& json) {
    return printable_json(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) + "\n";
}

/// A number that is known; else null.
inline nlohmann::ordered_json known_json(bool known, double number) {
    return known ? nlohmann::ordered_json(number) : nlohmann::ordered_json();
}

} // namespace acdf::tools
