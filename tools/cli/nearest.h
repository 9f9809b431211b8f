// "did you mean"
#pragma once

#include <string>
#include <vector>

namespace acdf::tools {

/// The one of `names` that was likely meant by `word`: it begins with it, as no other does, or the fewest letters
/// that are wrong, missing, too many or swapped make one of the other, at most a third of them, whatever their
/// case. Empty: none is.
std::string nearest_name(const std::string& word, const std::vector<std::string>& names);

} // namespace acdf::tools
