// Whether bytes are text.
#pragma once

#include "sources.h"

#include <string_view>

namespace acdf {

// Length of the UTF-8 sequence at `s`, 0 where there is none (Unicode 15, table 3-7).
inline u64 utf8_sequence(const u8* s, u64 left) {
    const u8 b = s[0];
    if (b < 0x80) return 1;
    const u64 length = b >= 0xC2 && b <= 0xDF ? 2 : b >= 0xE0 && b <= 0xEF ? 3 : b >= 0xF0 && b <= 0xF4 ? 4 : 0;
    if (length == 0 || length > left) return 0;
    for (u64 i = 1; i < length; ++i)
        if ((s[i] & 0xC0) != 0x80) return 0;
    if ((b == 0xE0 && s[1] < 0xA0) || (b == 0xED && s[1] > 0x9F)) return 0; // overlong, surrogates
    if ((b == 0xF0 && s[1] < 0x90) || (b == 0xF4 && s[1] > 0x8F)) return 0; // overlong, above U+10FFFF
    return length;
}

inline bool is_utf8(const u8* s, u64 size) {
    for (u64 at = 0; at < size;) {
        const u64 length = utf8_sequence(s + at, size - at);
        if (length == 0) return false;
        at += length;
    }
    return true;
}

// A text's beginning may have a mark that it is UTF-8, as spreadsheets write it.
inline std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return text.substr(text.substr(0, mark.size()) == mark ? mark.size() : 0);
}

} // namespace acdf
