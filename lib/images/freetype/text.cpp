// The module that renders text: the one that is linked with FreeType.
#include "images/module.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <limits>

namespace acdf::images {
namespace {

/// A font in one size. Each call opens its own: FreeType's objects are for one thread at a time.
class Face {
public:
    Face(const std::string& path, int size) {
        if (FT_Init_FreeType(&library_) != 0) return;
        if (FT_New_Face(library_, path.c_str(), 0, &face_) == 0)
            ready_ = FT_Set_Pixel_Sizes(face_, 0, static_cast<FT_UInt>(size)) == 0;
    }
    ~Face() {
        if (face_) FT_Done_Face(face_);
        if (library_) FT_Done_FreeType(library_);
    }
    Face(const Face&) = delete;
    Face& operator=(const Face&) = delete;

    explicit operator bool() const { return ready_; }

    /// Calls for each glyph, with it and the pen's column, counted from the first.
    template <class Visit>
    void glyphs(const std::string& text, const Visit& visit) const {
        int pen = 0;
        for (const char c : text) {
            if (FT_Load_Char(face_, static_cast<FT_ULong>(static_cast<unsigned char>(c)), FT_LOAD_RENDER) != 0)
                continue;
            visit(*face_->glyph, pen);
            pen += static_cast<int>(face_->glyph->advance.x >> 6); // of 64ths of a pixel
        }
    }

private:
    FT_Library library_ = nullptr;
    FT_Face face_ = nullptr;
    bool ready_ = false;
};

/// A rectangle of how much of each pixel the text covers, in [0, 1].
class Coverage {
public:
    /// From the pen's first position on.
    Coverage(const Face& face, const std::string& text) {
        face.glyphs(text, [&](const FT_GlyphSlotRec& glyph, int pen) {
            left_ = std::min(left_, pen + glyph.bitmap_left);
            right_ = std::max(right_, pen + glyph.bitmap_left + static_cast<int>(glyph.bitmap.width));
            top_ = std::min(top_, -glyph.bitmap_top);
            bottom_ = std::max(bottom_, static_cast<int>(glyph.bitmap.rows) - glyph.bitmap_top);
        });
        if (left_ >= right_ || top_ >= bottom_) return;
        covered_ = Picture(right_ - left_, bottom_ - top_, 1);
        face.glyphs(text, [&](const FT_GlyphSlotRec& glyph, int pen) { add(glyph, pen); });
    }

    void draw(Picture& picture, int x, int y, const float colour[3]) const {
        if (covered_.values.empty()) return; // blanks lie nowhere
        for (int row = std::max(0, -(y + top_)); row < std::min(covered_.height, picture.height - (y + top_));
             ++row)
            for (int column = std::max(0, -(x + left_));
                 column < std::min(covered_.width, picture.width - (x + left_)); ++column) {
                const float share = *covered_.at(column, row);
                float* pixel = picture.at(x + left_ + column, y + top_ + row);
                for (int c = 0; c < 3; ++c) pixel[c] = share * colour[c] + (1.0f - share) * pixel[c];
            }
    }

private:
    /// A pixel of two glyphs is the later one's.
    void add(const FT_GlyphSlotRec& glyph, int pen) {
        const FT_Bitmap& bitmap = glyph.bitmap;
        if (bitmap.pixel_mode != FT_PIXEL_MODE_GRAY) return;
        for (int row = 0; row < static_cast<int>(bitmap.rows); ++row)
            for (int column = 0; column < static_cast<int>(bitmap.width); ++column)
                *covered_.at(pen + glyph.bitmap_left + column - left_, row - glyph.bitmap_top - top_) =
                    static_cast<float>(bitmap.buffer[bitmap.pitch * row + column]) / 255.0f;
    }

    int left_ = std::numeric_limits<int>::max(), right_ = std::numeric_limits<int>::min();
    int top_ = left_, bottom_ = right_; ///< y grows downwards, from the baseline
    Picture covered_{0, 0, 1};
};

bool width_of_text(const std::string& text, int size, const std::string& font, int& width) {
    const Face face(font, size);
    if (!face) return false;
    width = 0;
    face.glyphs(text, [&](const FT_GlyphSlotRec& glyph, int pen) {
        width = std::max(width, pen + glyph.bitmap_left + static_cast<int>(glyph.bitmap.width) + 1);
    });
    return true;
}

void draw_text(Picture& picture, int x, int y, const std::string& text, int size, const std::string& font,
               const float colour[3]) {
    if (const Face face(font, size); face) Coverage(face, text).draw(picture, x, y, colour);
}

} // namespace
} // namespace acdf::images

extern "C" __attribute__((visibility("default"))) const acdf::images::TextModule* acdf_text_module() {
    using namespace acdf::images;
    static const TextModule functions = {ACDF_VERSION, width_of_text, draw_text};
    return &functions;
}
