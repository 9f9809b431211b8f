// The viewer's page (docs/viewer) with a file in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// The page without a file, as it was built and installed with the program. Throws Failure where there is none.
std::string viewer_page();

/// The same, which shows these bytes as soon as it is opened.
std::string page_with(std::string page, const std::string& name, const std::vector<std::uint8_t>& bytes);

} // namespace acdf::tools
