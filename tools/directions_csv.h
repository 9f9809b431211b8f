// Reads directions as people and `acdf sample` write them.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace acdf::tools {

/// Parses text line by line. A line is "x y z" or "x,y,z"; further columns are ignored only below a header line,
/// which names the columns (x, y and z among them). Blank lines and what follows a # are skipped.
class DirectionParser {
public:
    /// The direction in `line` as it stands, or nothing for a header, a blank or a comment. Throws Failure, which
    /// says what is wrong but not where.
    std::optional<std::array<double, 3>> parse(const std::string& line);

private:
    std::array<std::size_t, 3> columns_ = {0, 1, 2};
    bool header_ = false;    // a header line was seen
    bool direction_ = false; // a direction was seen: a header may not follow
};

} // namespace acdf::tools
