#include "message.h"

#include <cstring>

namespace acdf {

namespace {

class Writer {
public:
    Writer(char* out, std::size_t size) : out_(out), last_(out + size - 1) {}
    ~Writer() { *out_ = 0; }

    void put(char c) {
        if (out_ < last_) *out_++ = c;
    }
    void put(const char* text, std::size_t size) {
        const auto room = static_cast<std::size_t>(last_ - out_);
        if (size > room) size = room;
        std::memcpy(out_, text, size);
        out_ += size;
    }
    void put(const char* text) { put(text, std::strlen(text)); }
    void put(u64 number, u32 base, int width) {
        char digits[20];
        int first = sizeof digits;
        do digits[--first] = "0123456789abcdef"[number % base];
        while ((number /= base) > 0 || first > static_cast<int>(sizeof digits) - width);
        put(digits + first, sizeof digits - static_cast<std::size_t>(first));
    }

private:
    char *out_, *last_;
};

} // namespace

void write_message(char* out, std::size_t size, const char* format, std::va_list arguments) noexcept {
    Writer writer(out, size);
    while (const char* next = std::strchr(format, '%')) {
        writer.put(format, static_cast<std::size_t>(next - format));
        int width = 0, longs = 0;
        for (format = next + 1; (*format >= '0' && *format <= '9') || *format == 'l'; ++format) {
            if (*format == 'l') ++longs;
            else width = 10 * width + (*format - '0');
        }
        if (*format == 's') writer.put(va_arg(arguments, const char*));
        else {
            const u64 number = longs ? va_arg(arguments, unsigned long long) : va_arg(arguments, u32);
            writer.put(number, *format == 'x' ? 16 : 10, width);
        }
        ++format;
    }
    writer.put(format);
}

void write_message(char* out, std::size_t size, const char* format, ...) noexcept {
    std::va_list arguments;
    va_start(arguments, format);
    write_message(out, size, format, arguments);
    va_end(arguments);
}

} // namespace acdf
