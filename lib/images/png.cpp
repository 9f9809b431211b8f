#include "images/png.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <new>

namespace acdf::images {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kSamples = 3;
constexpr int kLevel = 9; // of zlib: pictures are kept and sent

Bytes displayed_samples(const Picture& rgb) {
    Bytes samples(rgb.values.size());
    std::transform(rgb.values.begin(), rgb.values.end(), samples.begin(), [](float value) {
        return static_cast<std::uint8_t>(value > 0.0f ? std::min(value, 1.0f) * 255.0f + 0.5f : 0.0f);
    });
    return samples;
}

/// As they are stored: in UTF-8, neither compressed nor in a language. They refer to `notes`.
std::vector<png_text> texts_of(const std::vector<Note>& notes) {
    std::vector<png_text> texts;
    for (const Note& note : notes) {
        png_text text{};
        text.compression = PNG_ITXT_COMPRESSION_NONE;
        text.key = const_cast<char*>(note.name.c_str());
        text.text = const_cast<char*>(note.text.c_str());
        text.itxt_length = note.text.size();
        texts.push_back(text);
    }
    return texts;
}

// What libpng calls. It has nothing to say but that memory is short: the picture is ours.
[[noreturn]] void leave(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void say_nothing(png_structp, png_const_charp) {}
void keep(png_structp) {}

void append(png_structp png, png_bytep data, std::size_t size) {
    Bytes& to = *static_cast<Bytes*>(png_get_io_ptr(png));
    try { // nothing is thrown through libpng
        to.insert(to.end(), data, data + size);
        return;
    } catch (const std::bad_alloc&) {
    }
    leave(png, nullptr);
}

/// libpng's state.
class Writer {
public:
    Writer() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leave, say_nothing)) {
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
    }
    ~Writer() { png_destroy_write_struct(&png_, &info_); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    /// False where memory is short.
    bool write(png_uint_32 width, png_uint_32 height, const Bytes& samples, const std::vector<png_text>& texts,
               Bytes& to) {
        if (!info_) return false;
        // Where libpng fails, it comes back to here: nothing that has a destructor lives below.
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_write_fn(png_, &to, append, keep);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_compression_level(png_, kLevel);
        png_set_IHDR(png_, info_, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL); // as for pictures
        png_set_text(png_, info_, texts.data(), static_cast<int>(texts.size()));
        png_write_info(png_, info_);
        for (png_uint_32 y = 0; y < height; ++y) png_write_row(png_, samples.data() + y * kSamples * width);
        png_write_end(png_, info_);
        return true;
    }

private:
    png_structp png_;
    png_infop info_;
};

} // namespace

std::vector<std::uint8_t> encode_png(const Picture& rgb, const std::vector<Note>& notes) {
    Bytes png;
    if (!Writer().write(static_cast<png_uint_32>(rgb.width), static_cast<png_uint_32>(rgb.height),
                        displayed_samples(rgb), texts_of(notes), png))
        throw std::bad_alloc();
    return png;
}

} // namespace acdf::images
