#include "tools/cli/messages.h"

#include "reader/utf8.h"

#include <cstdint>

namespace acdf::tools {
namespace {

/// The code point of a sequence that utf8_sequence accepts.
std::uint32_t code_point(const std::uint8_t* s, std::uint64_t length) {
    std::uint32_t code = length == 1 ? s[0] : s[0] & (0x7Fu >> length);
    for (std::uint64_t i = 1; i < length; ++i) code = code << 6 | (s[i] & 0x3Fu);
    return code;
}

/// Whether a character does something to a terminal or to the text around it: C0 without line ends and tabs, DEL
/// and C1, which terminals take as commands, too; what turns the direction of writing; separators of lines and
/// paragraphs.
bool is_active(std::uint32_t code) {
    return (code < 0x20 && code != '\n' && code != '\t') || (code >= 0x7F && code < 0xA0) || code == 0x061C ||
           code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
           (code >= 0x2066 && code <= 0x2069);
}

/// `text` with `replaced` for each sequence of bytes that is no UTF-8 or acts on its surroundings.
template <class Replaced>
std::string without_active(const std::string& text, const Replaced& replaced) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t found = utf8_sequence(bytes + i, text.size() - i), length = found > 0 ? found : 1;
        if (found > 0 && !is_active(code_point(bytes + i, found))) out.append(text, i, length);
        else out += replaced(bytes + i, length);
        i += length;
    }
    return out;
}

std::FILE* const stderr_at_start = stderr;

} // namespace

std::FILE* to_person() { return stderr_at_start; }

std::string printable(const std::string& text) {
    return without_active(text, [](const std::uint8_t* bytes, std::size_t length) {
        std::string out;
        for (std::size_t i = 0; i < length; ++i) {
            char code[5];
            std::snprintf(code, sizeof code, "\\x%02x", unsigned{bytes[i]});
            out += code;
        }
        return out;
    });
}

std::string printable_json(const std::string& json) {
    return without_active(json, [](const std::uint8_t* bytes, std::size_t length) {
        char code[16];
        std::snprintf(code, sizeof code, "\\u%04x", unsigned{code_point(bytes, length)});
        return std::string(code);
    });
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
