#include "directions_csv.h"

#include "commands.h"

#include <algorithm>
#include <charconv>
#include <vector>

namespace acdf::tools {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string trimmed(const std::string& text) {
    std::size_t begin = 0, end = text.size();
    while (begin < end && is_space(text[begin])) ++begin;
    while (end > begin && is_space(text[end - 1])) --end;
    return text.substr(begin, end - begin);
}

// At commas where there is one, else at runs of spaces.
std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields;
    const bool commas = line.find(',') != std::string::npos;
    for (std::size_t at = 0; at <= line.size();) {
        std::size_t end = at;
        while (end < line.size() && !(commas ? line[end] == ',' : is_space(line[end]))) ++end;
        if (commas || end > at) fields.push_back(trimmed(line.substr(at, end - at)));
        at = end + 1;
    }
    return fields;
}

// Numbers as C writes them, "nan" and "inf" included: their density is 0.
std::optional<double> number_in(const std::string& field) {
    const char* begin = field.data() + (field.size() > 1 && field[0] == '+' && field[1] != '-' ? 1 : 0);
    const char* end = field.data() + field.size();
    double value = 0.0;
    const auto [rest, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || rest != end) return std::nullopt;
    return value;
}

// Where x, y and z stand in a header line; nothing where this is none.
std::optional<std::array<std::size_t, 3>> header_in(const std::vector<std::string>& fields) {
    std::array<std::size_t, 3> columns = {};
    const char* const names[3] = {"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto found = std::find(fields.begin(), fields.end(), names[i]);
        if (found == fields.end()) return std::nullopt;
        columns[i] = static_cast<std::size_t>(found - fields.begin());
    }
    return columns;
}

} // namespace

std::optional<std::array<double, 3>> DirectionParser::parse(const std::string& line) {
    const std::string text = trimmed(line.substr(0, line.find('#')));
    if (text.empty()) return std::nullopt;
    const std::vector<std::string> fields = fields_of(text);
    if (!header_ && !direction_) {
        if (const auto columns = header_in(fields)) {
            columns_ = *columns;
            header_ = true;
            return std::nullopt;
        }
    }
    if (!header_ && fields.size() != 3)
        throw Failure("expected three numbers x y z, found " + std::to_string(fields.size()) +
                      (fields.size() == 1 ? " field" : " fields") +
                      "; a header line that names the columns x, y and z allows more");
    std::array<double, 3> direction = {};
    for (std::size_t i = 0; i < 3; ++i) {
        if (columns_[i] >= fields.size())
            throw Failure("has " + std::to_string(fields.size()) + " columns, fewer than the header needs");
        const auto value = number_in(fields[columns_[i]]);
        if (!value) throw Failure("'" + fields[columns_[i]] + "' is no number");
        direction[i] = *value;
    }
    direction_ = true;
    return direction;
}

} // namespace acdf::tools
