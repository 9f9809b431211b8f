#include "tools/cli/messages.h"

#include "reader/utf8.h"

#include <cstdint>

namespace acdf::tools {
namespace {

/// C0 and DEL; C1, which terminals take as commands too, is C2 80 to C2 9F in UTF-8.
bool is_control(const std::uint8_t* s, std::uint64_t length) {
    if (length == 1) return (s[0] < 0x20 && s[0] != '\n' && s[0] != '\t') || s[0] == 0x7F;
    return s[0] == 0xC2 && s[1] < 0xA0;
}

std::FILE* const stderr_at_start = stderr;

} // namespace

std::FILE* to_person() { return stderr_at_start; }

std::string printable(const std::string& text) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = utf8_sequence(bytes + i, text.size() - i);
        if (length > 0 && !is_control(bytes + i, length)) {
            out.append(text, i, length);
            i += length;
            continue;
        }
        for (const std::size_t end = i + (length > 0 ? length : 1); i < end; ++i) {
            char code[5];
            std::snprintf(code, sizeof code, "\\x%02x", unsigned{bytes[i]});
            out += code;
        }
    }
    return out;
}

std::string on_one_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    for (char& c : text)
        if (c == '\n') c = ' ';
    return printable(text);
}

void say(const std::string& text) { std::fprintf(to_person(), "%s\n", on_one_line(text).c_str()); }

void put(const std::string& text) { std::fputs(printable(text).c_str(), stdout); }

} // namespace acdf::tools
