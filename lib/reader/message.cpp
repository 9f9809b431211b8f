#include "message.h"

#include <acdf/elementary.h>

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

#ifndef ACDF_ENVIRONMENT_ONLY
    // Without zeros at the end; in powers of ten where it is below 1e-4 or has more digits before the point.
    void put(double x, int digits) {
        u64 bits;
        std::memcpy(&bits, &x, sizeof bits);
        if (!acdf_is_finite(x)) return put(bits << 12 ? "nan" : bits >> 63 ? "-inf" : "inf");
        if (x < 0.0) put('-'), x = -x;
        int power = 0;
        for (; x >= 10.0; x /= 10.0) ++power;
        for (; x > 0.0 && x < 1.0; x *= 10.0) --power;
        u64 one = 1; // of its first digit
        for (int i = 1; i < digits; ++i) one *= 10;
        u64 number = static_cast<u64>(x * static_cast<double>(one) + 0.5);
        if (number == 10 * one) number = one, ++power;
        const bool short_power = power >= -4 && power < digits;
        const int whole = short_power ? power : 0; // the power of the last digit before the point
        if (whole < 0) put("0.");
        for (int i = whole; i < -1; ++i) put('0');
        for (int place = 0; number > 0 || place <= whole; ++place) {
            if (place == whole + 1 && place > 0) put('.');
            put(static_cast<char>('0' + number / one % 10));
            number %= one;
            one /= 10;
            if (one == 0) one = 1;
        }
        if (short_power) return;
        put(power < 0 ? "e-" : "e+");
        put(static_cast<u64>(power < 0 ? -power : power), 10, 2);
    }
#endif

private:
    char *out_, *last_;
};

} // namespace

void write_message(char* out, std::size_t size, const char* format, std::va_list arguments) noexcept {
    Writer writer(out, size);
    while (const char* next = std::strchr(format, '%')) {
        writer.put(format, static_cast<std::size_t>(next - format));
        int width = 0, longs = 0;
        for (format = next + 1; (*format >= '0' && *format <= '9') || *format == '.' || *format == 'l'; ++format) {
            if (*format == 'l') ++longs;
            else if (*format != '.') width = 10 * width + (*format - '0');
        }
        if (*format == 's') writer.put(va_arg(arguments, const char*));
#ifndef ACDF_ENVIRONMENT_ONLY
        else if (*format == 'g') writer.put(va_arg(arguments, double), width ? width : 6);
#endif
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
