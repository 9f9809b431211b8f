#include "input/text_lines.h"

#include "input/error.h"
#include "input/stand_in.h"
#include "reader/utf8.h"

#include <charconv>
#include <string_view>

namespace acdf::input {
namespace {

constexpr std::size_t longest_line = 1024;

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == '\r'; }

const char* skip_separators(const char* at, const char* end) {
    while (at != end && is_separator(*at)) ++at;
    return at;
}

} // namespace

void for_each_line(const std::string& path, const std::string& what,
                   const std::function<void(const TextLine&)>& take) {
    refuse_stand_in(path);
    std::ifstream file(path, std::ios::binary);
    if (!file) throw input_error(path, "it cannot be opened; check its permissions");
    char text[longest_line];
    for (TextLine line{1};; ++line.number) {
        file.getline(text, sizeof text);
        const auto read =
            static_cast<std::size_t>(file.gcount()); // with the newline, but not at the end of the file
        if (read == 0) break;
        if (file.fail())
            throw input_error(path, "line " + std::to_string(line.number) + " is longer than any " + what);
        std::string_view content(text, read - (file.eof() ? 0 : 1));
        if (line.number == 1) content = without_byte_order_mark(content);
        line.begin = content.data();
        line.end = content.data() + content.size();
        take(line);
    }
    if (file.bad()) throw input_error(path, "it cannot be read");
}

int read_numbers(const char*& at, const char* end, double* numbers, int most) {
    for (int count = 0;; ++count) {
        at = skip_separators(at, end);
        if (at == end || count == most) return count;
        const char* const begin = *at == '+' && at + 1 != end && at[1] != '-' ? at + 1 : at;
        const auto [after, error] = std::from_chars(begin, end, numbers[count]);
        if (error != std::errc() || (after != end && !is_separator(*after) && *after != '#')) return count;
        at = after;
    }
}

bool is_blank(const char* at, const char* end) {
    at = skip_separators(at, end);
    return at == end || *at == '#';
}

} // namespace acdf::input
