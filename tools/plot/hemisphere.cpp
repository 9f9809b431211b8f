#include "tools/plot/hemisphere.h"

#include "images/module.h"
#include "tools/plot/colour.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace acdf::tools {
namespace {

constexpr Colour line_colour = {1.0f, 1.0f, 1.0f}, text_colour = {0.12f, 0.12f, 0.12f};

/// Paints over a disc whose top left lies at (margin, margin).
class HemisphereAxes {
public:
    HemisphereAxes(images::Picture& picture, int margin, const std::string& font)
        : picture_(picture), font_(font), margin_(margin), radius_(0.5 * (picture.width - 2 * margin)),
          size_(std::max(margin / 2, 12)) {}

    /// All directions at an angle from the normal.
    void ring(double degrees) const {
        const double r = std::sqrt(1.0 - std::cos(degrees * ACDF_PI / 180.0));
        const int steps = static_cast<int>(8.0 * radius_);
        for (int i = 0; i < steps; ++i) {
            const double phi = 2.0 * ACDF_PI * i / steps;
            blend(r * std::cos(phi), r * std::sin(phi), 0.25f);
        }
        char text[16];
        std::snprintf(text, sizeof text, "%g", degrees);
        const double diagonal = r * std::sqrt(0.5);
        write(diagonal, -diagonal, text, line_colour);
    }
    void name(double x, double y, const char* text) const {
        const double out = 1.0 + 0.5 * margin_ / radius_;
        write(out * x, out * y, text, text_colour);
    }
    void cross(const float d[3], bool open) const {
        const double scale = d[2] > -1.0f ? 1.0 / std::sqrt(1.0 + double{d[2]}) : 0.0, arm = 6.0 / radius_;
        const double x = d[0] * scale, y = d[1] * scale; // sin = sqrt(1 - z) sqrt(1 + z), r = sqrt(1 - z)
        for (int i = -60; i <= 60; ++i) {
            const double t = i / 60.0;
            if (open) {
                blend(x + arm * std::cos(ACDF_PI * t), y + arm * std::sin(ACDF_PI * t), 1.0f);
            } else {
                blend(x + arm * t, y, 1.0f);
                blend(x, y + arm * t, 1.0f);
            }
        }
    }

private:
    void place(double x, double y, int& column, int& row) const {
        column = margin_ + static_cast<int>((1.0 + x) * radius_);
        row = margin_ + static_cast<int>((1.0 - y) * radius_);
    }
    void blend(double x, double y, float opacity) const {
        int column, row;
        place(x, y, column, row);
        if (column < 0 || row < 0 || column >= picture_.width || row >= picture_.height) return;
        float* pixel = picture_.at(column, row);
        for (std::size_t c = 0; c < 3; ++c) pixel[c] += opacity * (line_colour[c] - pixel[c]);
    }
    /// Text around a position.
    void write(double x, double y, const char* text, const Colour& colour) const {
        int column, row, width = 0;
        if (font_.empty() || !images::text_module().width(text, size_, font_, width)) return;
        place(x, y, column, row);
        images::text_module().draw(picture_, column - width / 2, row + size_ * 2 / 5, text, size_, font_,
                                   colour.data());
    }

    images::Picture& picture_;
    const std::string& font_;
    int margin_;
    double radius_;
    int size_;
};

} // namespace

images::Picture label_hemisphere(const images::Picture& disc, const float view[3], const std::string& font) {
    const int margin = std::clamp(disc.width / 16, 20, 48);
    images::Picture out(disc.width + 2 * margin, disc.height + 2 * margin);
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) std::copy(background.begin(), background.end(), out.at(x, y));
    for (int y = 0; y < disc.height; ++y) std::copy_n(disc.at(0, y), 3 * disc.width, out.at(margin, y + margin));
    const HemisphereAxes axes(out, margin, font);
    axes.ring(30.0);
    axes.ring(60.0);
    axes.name(1.0, 0.0, "+x");
    axes.name(-1.0, 0.0, "-x");
    axes.name(0.0, 1.0, "+y");
    axes.name(0.0, -1.0, "-y");
    const float mirror[3] = {-view[0], -view[1], view[2]};
    axes.cross(view, true);
    axes.cross(mirror, false);
    return out;
}

} // namespace acdf::tools
