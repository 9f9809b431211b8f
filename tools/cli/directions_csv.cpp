#include "tools/cli/directions_csv.h"

#include "reader/utf8.h"
#include "tools/commands.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <string_view>
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

// Numbers as C writes them, "nan" and "inf" included: their pdf is 0.
std::optional<double> number_in(const std::string& field) {
    const char* begin = field.data() + (field.size() > 1 && field[0] == '+' && field[1] != '-' ? 1 : 0);
    const char* end = field.data() + field.size();
    double value = 0.0;
    const auto [rest, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || rest != end) return std::nullopt;
    return value;
}

} // namespace

PointParser::PointParser(std::vector<std::string> names) : names_(std::move(names)), columns_(names_.size()) {
    std::iota(columns_.begin(), columns_.end(), std::size_t{0});
}

// Finds the columns in a header line; false where this is none.
bool PointParser::read_header(const std::vector<std::string>& fields) {
    std::vector<std::size_t> columns;
    for (const std::string& name : names_) {
        const auto found = std::find(fields.begin(), fields.end(), name);
        if (found == fields.end()) return false;
        columns.push_back(static_cast<std::size_t>(found - fields.begin()));
    }
    columns_ = std::move(columns);
    return header_ = true;
}

// "3 numbers x y z"
std::string PointParser::expected() const {
    std::string text = std::to_string(names_.size()) + (names_.size() == 1 ? " number" : " numbers");
    for (const std::string& name : names_) text += " " + name;
    return text;
}

std::optional<std::vector<double>> PointParser::parse(const std::string& line) {
    const std::string_view content = header_ || point_ ? std::string_view(line) : without_byte_order_mark(line);
    const std::string text = trimmed(std::string(content.substr(0, content.find('#'))));
    if (text.empty()) return std::nullopt;
    const std::vector<std::string> fields = fields_of(text);
    if (!header_ && !point_ && read_header(fields)) return std::nullopt;
    if (!header_ && fields.size() != names_.size())
        throw Failure("expected " + expected() + ", found " + std::to_string(fields.size()) +
                      (fields.size() == 1 ? " field" : " fields") +
                      "; a header line that names the columns allows more");
    std::vector<double> point;
    for (const std::size_t column : columns_) {
        if (column >= fields.size())
            throw Failure("has " + std::to_string(fields.size()) + " columns, fewer than the header needs");
        const auto value = number_in(fields[column]);
        if (!value) throw Failure("'" + fields[column] + "' is not a number");
        point.push_back(*value);
    }
    point_ = true;
    return point;
}

} // namespace acdf::tools
