// Files of the kinds that acdf knows, where another kind was asked for.
#pragma once

#include <string>

namespace acdf::input {

/// The kind of a file that holds no image, by its first bytes, and which command takes it; empty where they show
/// nothing.
std::string kind_of_no_image(const std::string& path);

/// The same of a file that holds no BRDF.
std::string kind_of_no_brdf(const std::string& path);

} // namespace acdf::input
