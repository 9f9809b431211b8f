// Reads directions, and points of tables, as people and `acdf sample` write them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace acdf::tools {

/// Parses text line by line. With the names x, y and z a line is "x y z" or "x,y,z"; further columns are ignored
/// only below a header line, which names the columns (x, y and z among them). Blank lines and what follows a # are
/// skipped.
class PointParser {
public:
    explicit PointParser(std::vector<std::string> names = {"x", "y", "z"});

    /// The numbers in `line` as they stand, in the order of the names, or nothing for a header, a blank or a
    /// comment. Throws Failure, which says what is wrong but not where.
    std::optional<std::vector<double>> parse(const std::string& line);

private:
    std::vector<std::string> names_;
    std::vector<std::size_t> columns_;
    bool header_ = false; // a header line was seen
    bool point_ = false;  // a point was seen: a header may not follow

    bool read_header(const std::vector<std::string>& fields);
    std::string expected() const;
};

} // namespace acdf::tools
