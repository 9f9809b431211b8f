#include "tools/plot/brdf.h"
#include "compress/parallel.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace acdf::tools {
namespace {

/// The cell of a direction, by its corner; {0, 0, 0, 0} outside of the picture.
using Corner = std::array<std::uint32_t, 4>;

Corner corner_of(const AcdfBrdf& brdf, const AcdfBrdfView& view, const float wi[3]) {
    AcdfBrdfPosition place;
    AcdfRange range[2];
    double side;
    if (!acdf_brdf_half_position(&brdf, &view, wi, &place, &side)) return {};
    acdf_brdf_find(&brdf, &view, &place, range, nullptr);
    return {range[0].low, range[0].high, range[1].low, range[1].high};
}

} // namespace

std::optional<ViewAngles> parse_view(const std::string& text) {
    ViewAngles out;
    int end = 0;
    if (std::sscanf(text.c_str(), "%lf%n", &out.theta, &end) != 1) return std::nullopt;
    if (static_cast<std::size_t>(end) != text.size()) {
        end = 0;
        if (std::sscanf(text.c_str(), "%lf,%lf%n", &out.theta, &out.phi, &end) != 2) return std::nullopt;
        if (static_cast<std::size_t>(end) != text.size()) return std::nullopt;
    }
    if (!(out.theta >= 0.0 && out.theta < 90.0 && std::abs(out.phi) <= 360.0)) return std::nullopt;
    return out;
}

std::string to_string(const ViewAngles& angles) {
    char text[64];
    std::snprintf(text, sizeof text, angles.phi == 0.0 ? "%g" : "%g,%g", angles.theta, angles.phi);
    return text;
}

void PlottedView::direction(float wo[3]) const {
    constexpr double degree = ACDF_PI / 180.0;
    wo[0] = static_cast<float>(std::sin(angles.theta * degree) * std::cos(angles.phi * degree));
    wo[1] = static_cast<float>(std::sin(angles.theta * degree) * std::sin(angles.phi * degree));
    wo[2] = static_cast<float>(std::cos(angles.theta * degree));
}

PdfFunction pdf_of(const PlottedView& view) {
    return [view](const float wi[3]) {
        float wo[3];
        view.direction(wo);
        return view.brdf.pdf(wo, wi);
    };
}

std::vector<float> knot_opacity(const PlottedView& view, const PlotMap& map) {
    const AcdfBrdf& brdf = view.brdf.data();
    AcdfBrdfView served;
    float wo[3];
    view.direction(wo);
    std::vector<float> out(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height), 0.0f);
    if (!acdf_brdf_view(&brdf, wo, &served)) return out;
    const auto corner = [&](int x, int y) {
        float wi[3];
        return pixel_direction(map, x + 0.5, y + 0.5, wi) ? corner_of(brdf, served, wi) : Corner{};
    };
    compress::parallel_for(0, map.height, [&](int y) {
        for (int x = 0; x < map.width; ++x) {
            const Corner here = corner(x, y);
            const bool left = x > 0 && corner(x - 1, y) != here, above = y > 0 && corner(x, y - 1) != here;
            const bool thin = (left && x + 1 < map.width && corner(x + 1, y) != here) ||
                              (above && y + 1 < map.height && corner(x, y + 1) != here);
            const std::size_t at =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
            if ((left || above) && !thin) out[at] = 1.0f;
        }
    });
    return out;
}

} // namespace acdf::tools
