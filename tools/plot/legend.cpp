#include "tools/plot/legend.h"

#include "images/font.h"
#include "images/module.h"
#include "tools/plot/colour.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace acdf::tools {
namespace {

constexpr Colour ink = {0.12f, 0.12f, 0.12f};

// Text is in ASCII.
std::string to_ascii(const std::string& utf8) {
    std::string out;
    for (const char c : utf8) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7F) out += c;
        else if (byte < 0x20 || byte >= 0xC0) out += '?'; // the bytes that follow the first are skipped
    }
    return out;
}

class Pen {
public:
    Pen(images::Picture& image, const std::string& font) : image_(image), font_(font) {}

    int width(const std::string& text, int size) const {
        int out = 0;
        return images::text_module().width(text, size, font_, out) ? out : 0;
    }

    /// Text that begins at x; `y` is the baseline. Returns where it ends.
    int write(int x, int y, const std::string& text, int size) const {
        images::text_module().draw(image_, x, y, text, size, font_, ink.data());
        return x + width(text, size);
    }

    /// base^exponent. The exponent is small and high, since there are no superscripts in ASCII.
    void write_power(int x, int y, const std::string& base, int exponent, int size) const {
        const int end = write(x, y, base, size);
        const int small = std::max(size * 3 / 4, 8);
        write(end + std::max(size / 12, 1), y - size * 2 / 5, std::to_string(exponent), small);
    }

private:
    images::Picture& image_;
    const std::string& font_;
};

void fill(images::Picture& image, const Box& box, const Colour& colour) {
    for (int y = std::max(box.y, 0); y < std::min(box.y + box.height, image.height); ++y)
        for (int x = std::max(box.x, 0); x < std::min(box.x + box.width, image.width); ++x)
            std::copy(colour.begin(), colour.end(), image.at(x, y));
}

/// Copies `part` to where its top left is at (x, y); all of it lies in the image.
void paste(images::Picture& image, int x, int y, const images::Picture& part) {
    for (int row = 0; row < part.height; ++row) std::copy_n(part.at(0, row), 3 * part.width, image.at(x, y + row));
}

void draw_bar(images::Picture& image, const Legend& legend, const LegendLayout& layout) {
    const Box& bar = layout.bar;
    PdfImage ramp{{build::Layout::latlong, 1, bar.height}, {}};
    for (int y = 0; y < bar.height; ++y) {
        const double t = 1.0 - static_cast<double>(y) / std::max(bar.height - 1, 1);
        const double pdf = legend.range.low * std::pow(legend.range.high / legend.range.low, t);
        ramp.pdf.push_back(static_cast<float>(pdf));
    }
    const images::Picture colours = false_colour(ramp, legend.range, legend.colours);
    for (int x = 0; x < bar.width; ++x) paste(image, bar.x + x, bar.y, colours);
}

// 10^-3 where all labels are powers of ten, 0.002 else.
void write_label(const Pen& pen, int x, int y, const Tick& tick, const PdfRange& range, int size) {
    if (!is_major({2, 0}, range)) return pen.write_power(x, y, "10", tick.exponent, size);
    char text[32];
    std::snprintf(text, sizeof text, "%g", tick.pdf());
    pen.write(x, y, text, size);
}

void draw_ticks(images::Picture& image, const Legend& legend, const LegendLayout& layout, const Pen* pen) {
    const int edge = layout.bar.x + layout.bar.width, size = layout.font_size;
    const double rows_a_decade = layout.bar.height / std::log10(legend.range.high / legend.range.low);
    int free_row = layout.height; // labels are written upwards; above this row there is room for one
    for (const Tick& tick : ticks(legend.range)) {
        const int row = layout.row_of(tick.pdf(), legend.range);
        const bool major = is_major(tick, legend.range);
        if (!major && rows_a_decade < 20.0) continue;
        fill(image, {edge, row, major ? layout.tick_length : layout.tick_length / 2, 1}, ink);
        if (!pen || !major || row > free_row) continue;
        write_label(*pen, edge + layout.tick_length + size / 4, row + size * 2 / 5, tick, legend.range, size);
        free_row = row - size * 3 / 2;
    }
}

// The parts that fit, or the beginning of the first.
std::string fitting_title(const Legend& legend, const LegendLayout& layout, const Pen& pen) {
    std::string title;
    for (const std::string& part : legend.title) {
        const std::string longer = (title.empty() ? "" : title + ", ") + to_ascii(part);
        if (pen.width(longer, layout.font_size) > layout.picture.width) {
            if (title.empty()) title = longer;
            break;
        }
        title = longer;
    }
    const std::string whole = title;
    for (std::size_t n = whole.size(); n > 0 && pen.width(title, layout.font_size) > layout.picture.width;)
        title = whole.substr(0, --n) + "...";
    return title;
}

} // namespace

LegendLayout legend_layout(int picture_width, int picture_height) {
    LegendLayout out;
    const int s = std::clamp((picture_height + 16) / 32, 12, 32);
    out.font_size = s;
    out.tick_length = s / 2;
    out.picture = {s, 9 * s / 4, picture_width, picture_height};
    const int column_height = std::max(picture_height, 8 * s);
    out.bar = {out.picture.x + picture_width + s, out.picture.y, 5 * s / 4, column_height - 9 * s / 4};
    out.zero = {out.bar.x, out.picture.y + column_height - 5 * s / 4, out.bar.width, 5 * s / 4};
    out.width = out.bar.x + out.bar.width + 9 * s / 2;
    out.height = out.picture.y + column_height + s;
    return out;
}

int LegendLayout::row_of(double pdf, const PdfRange& range) const {
    return bar.y + static_cast<int>(std::lround((1.0 - range.position(pdf)) * (bar.height - 1)));
}

std::string find_font() {
    for (const char* name : {"DejaVuSans", "LiberationSans-Regular", "NotoSans-Regular", "FreeSans", "Arial"}) {
        const std::string path = images::find_font_file(name);
        if (int width = 0; !path.empty() && images::text_module().width("0", 16, path, width)) return path;
    }
    return {};
}

images::Picture add_legend(const images::Picture& picture, const Legend& legend, const std::string& font) {
    const LegendLayout layout = legend_layout(picture.width, picture.height);
    images::Picture image(layout.width, layout.height);
    fill(image, {0, 0, layout.width, layout.height}, background);
    paste(image, layout.picture.x, layout.picture.y, picture);
    draw_bar(image, legend, layout);
    if (legend.shows_zero) fill(image, layout.zero, zero_colour);

    const Pen pen(image, font);
    draw_ticks(image, legend, layout, font.empty() ? nullptr : &pen);
    if (font.empty()) return image;
    const int baseline = 3 * layout.font_size / 2;
    pen.write(layout.picture.x, baseline, fitting_title(legend, layout, pen), layout.font_size);
    if (legend.per_steradian) pen.write_power(layout.bar.x, baseline, "sr", -1, layout.font_size);
    if (legend.shows_zero)
        pen.write(layout.zero.x + layout.zero.width + layout.tick_length + layout.font_size / 4,
                  layout.zero.y + layout.font_size, "0", layout.font_size);
    return image;
}

} // namespace acdf::tools
