#include "images/png.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>

namespace acdf::images {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kSamples = 3, kChunkOfPixels = 1 << 16;

void append_number(Bytes& to, std::uint32_t number) {
    for (const int shift : {24, 16, 8, 0}) to.push_back(static_cast<std::uint8_t>(number >> shift));
}

void append_chunk(Bytes& png, const std::string& type, const Bytes& data) {
    append_number(png, static_cast<std::uint32_t>(data.size()));
    const std::size_t checked = png.size();
    png.insert(png.end(), type.begin(), type.end());
    png.insert(png.end(), data.begin(), data.end());
    append_number(
        png, static_cast<std::uint32_t>(crc32(0, png.data() + checked, static_cast<uInt>(png.size() - checked))));
}

Bytes size_and_kind(const Picture& rgb) {
    Bytes out;
    append_number(out, static_cast<std::uint32_t>(rgb.width));
    append_number(out, static_cast<std::uint32_t>(rgb.height));
    constexpr std::uint8_t kBits = 8, kColours = 2;
    out.insert(out.end(), {kBits, kColours, 0, 0, 0}); // deflated, filtered, not interlaced
    return out;
}

/// Text in UTF-8, neither compressed nor in a language.
Bytes international(const Note& note) {
    Bytes out(note.name.begin(), note.name.end());
    out.insert(out.end(), 5, 0);
    out.insert(out.end(), note.text.begin(), note.text.end());
    return out;
}

/// What lies beside a sample: to the left, above, and above to the left.
struct Neighbours {
    int left, above, corner;
};

int paeth(const Neighbours& n) {
    const int guess = n.left + n.above - n.corner;
    const int left = std::abs(guess - n.left), above = std::abs(guess - n.above),
              corner = std::abs(guess - n.corner);
    if (left <= above && left <= corner) return n.left;
    return above <= corner ? n.above : n.corner;
}

/// Filters by their numbers: what each expects of a sample.
constexpr std::array<int (*)(const Neighbours&), 5> kFilters = {
    [](const Neighbours&) { return 0; }, [](const Neighbours& n) { return n.left; },
    [](const Neighbours& n) { return n.above; }, [](const Neighbours& n) { return (n.left + n.above) / 2; }, paeth};

/// A row as one filter stores it, after the filter's number. Returns the sum of what is left of samples, as signed
/// numbers.
template <std::size_t filter>
long filter_row(const Bytes& above, const Bytes& row, Bytes& to) {
    long sum = 0;
    to[0] = static_cast<std::uint8_t>(filter);
    for (std::size_t i = 0; i < row.size(); ++i) {
        const bool first = i < kSamples;
        const Neighbours beside = {first ? 0 : row[i - kSamples], above[i], first ? 0 : above[i - kSamples]};
        const auto rest = static_cast<std::uint8_t>(row[i] - kFilters[filter](beside));
        to[i + 1] = rest;
        sum += rest < 128 ? rest : 256 - rest;
    }
    return sum;
}

/// Rows as they are stored: by the filter that leaves least, which mostly deflates best.
class Rows8 {
public:
    explicit Rows8(std::size_t samples) : above_(samples), row_(samples), best_(samples + 1), other_(samples + 1) {}

    const Bytes& next(const float* values) {
        std::swap(above_, row_);
        std::transform(values, values + row_.size(), row_.begin(), [](float value) {
            return static_cast<std::uint8_t>(value > 0.0f ? std::min(value, 1.0f) * 255.0f + 0.5f : 0.0f);
        });
        least_ = filter_row<0>(above_, row_, best_);
        try_filter<1>();
        try_filter<2>();
        try_filter<3>();
        try_filter<4>();
        return best_;
    }

private:
    template <std::size_t filter>
    void try_filter() {
        const long sum = filter_row<filter>(above_, row_, other_);
        if (sum >= least_) return;
        least_ = sum;
        std::swap(best_, other_);
    }

    Bytes above_, row_, best_, other_;
    long least_ = 0;
};

/// Deflates what is given into chunks of pixels.
class Pixels {
public:
    explicit Pixels(Bytes& png) : png_(png), chunk_(kChunkOfPixels) {
        if (deflateInit(&stream_, Z_BEST_COMPRESSION) != Z_OK) throw std::bad_alloc();
        restart();
    }
    ~Pixels() { deflateEnd(&stream_); }
    Pixels(const Pixels&) = delete;
    Pixels& operator=(const Pixels&) = delete;

    void add(const Bytes& bytes) {
        stream_.next_in = const_cast<Bytef*>(bytes.data());
        stream_.avail_in = static_cast<uInt>(bytes.size());
        while (stream_.avail_in > 0) advance(Z_NO_FLUSH);
    }
    void finish() {
        while (advance(Z_FINISH) != Z_STREAM_END) {
        }
        write();
    }

private:
    int advance(int flush) {
        if (stream_.avail_out == 0) write();
        return deflate(&stream_, flush);
    }
    void write() {
        append_chunk(png_, "IDAT", {chunk_.begin(), chunk_.end() - static_cast<std::ptrdiff_t>(stream_.avail_out)});
        restart();
    }
    void restart() {
        stream_.next_out = chunk_.data();
        stream_.avail_out = static_cast<uInt>(chunk_.size());
    }

    Bytes& png_;
    Bytes chunk_;
    z_stream stream_{};
};

} // namespace

std::vector<std::uint8_t> encode_png(const Picture& rgb, const std::vector<Note>& notes) {
    Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    append_chunk(png, "IHDR", size_and_kind(rgb));
    append_chunk(png, "sRGB", {0}); // 0: perceptual, as for pictures
    for (const Note& note : notes) append_chunk(png, "iTXt", international(note));
    Rows8 rows(static_cast<std::size_t>(rgb.width) * kSamples);
    Pixels pixels(png);
    for (int y = 0; y < rgb.height; ++y) pixels.add(rows.next(rgb.at(0, y)));
    pixels.finish();
    append_chunk(png, "IEND", {});
    return png;
}

} // namespace acdf::images
