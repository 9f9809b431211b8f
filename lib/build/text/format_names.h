// The names of the format's enumerations, as people and JSON see them.
#pragma once

#include <acdf/layout.h>

#include <cstdint>
#include <string>

namespace acdf::build {

std::string kind_name(std::uint32_t kind);
std::string parameterization_name(std::uint32_t parameterization);
std::string fit_name(std::uint32_t fit);
std::string filter_name(std::uint32_t filter);
std::string codec_name(std::uint32_t codec);
std::string role_name(std::uint32_t role);
std::string measure_name(std::uint32_t measure);
/// "TREE"; bytes that do not print become '?'.
std::string chunk_name(std::uint32_t type);

} // namespace acdf::build
