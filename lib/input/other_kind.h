// Files of the kinds that acdf knows, where another kind was asked for.
#pragma once

#include <string>

namespace acdf::input {

/// Of a file that holds no image: what it is and which command takes it, or empty where its first bytes tell
/// nothing.
std::string kind_of_no_image(const std::string& path);

/// The same of a file that holds no BRDF.
std::string kind_of_no_brdf(const std::string& path);

} // namespace acdf::input
