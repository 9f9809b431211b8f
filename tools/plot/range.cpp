#include "tools/plot/range.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace acdf::tools {
namespace {

constexpr double low_share_of_sphere = 0.01;
constexpr double high_share_of_probability = 0.001;
constexpr double least_decades = 1.0, most_decades = 8.0;

// Histogram over log10 of the pdf: float's range, in steps finer than the rounding that follows.
constexpr int bins_a_decade = 50, lowest_decade = -46, highest_decade = 39;
constexpr int bin_count = (highest_decade - lowest_decade) * bins_a_decade;

int bin_of(float pdf) {
    const double decade = std::log10(static_cast<double>(pdf)) - lowest_decade;
    return std::clamp(static_cast<int>(decade * bins_a_decade), 0, bin_count - 1);
}

double log10_of_border(int bin) { return lowest_decade + static_cast<double>(bin) / bins_a_decade; }

struct Histogram {
    std::vector<double> solid_angle = std::vector<double>(bin_count), probability = solid_angle;
    double total_solid_angle = 0.0, total_probability = 0.0;
};

Histogram histogram_of(const PdfImage& image) {
    Histogram h;
    const bool latlong = image.map.layout == build::Layout::latlong;
    for (int y = 0; y < image.map.height; ++y)
        for (int x = 0; x < image.map.width; ++x) {
            const float pdf = image.at(x, y);
            if (!(pdf > 0.0f)) continue;
            const double solid_angle = pixel_solid_angle(image.map, latlong ? 0 : x, y);
            const auto bin = static_cast<std::size_t>(bin_of(pdf));
            h.solid_angle[bin] += solid_angle;
            h.probability[bin] += solid_angle * static_cast<double>(pdf);
            h.total_solid_angle += solid_angle;
            h.total_probability += solid_angle * static_cast<double>(pdf);
        }
    return h;
}

// The double that a person would write, 2e-7, which 2 * 1e-7 need not be.
double round_number(int mantissa, int exponent) {
    return std::strtod((std::to_string(mantissa) + "e" + std::to_string(exponent)).c_str(), nullptr);
}

// The largest (up: smallest) of 1, 2, 5 times a power of ten that is at most (up: at least) 10^exponent.
double round_to_125(double exponent, bool up) {
    constexpr double slack = 1e-9; // a round number stays itself
    const double power = std::floor(exponent + slack);
    const double steps[] = {0.0, std::log10(2.0), std::log10(5.0), 1.0};
    constexpr int mantissas[] = {1, 2, 5, 10};
    const double fraction = exponent - power;
    int i = 0;
    while (i < 3 && steps[i + 1] <= fraction + slack) ++i; // steps[i] <= fraction < steps[i + 1]
    if (up && steps[i] < fraction - slack) ++i;
    return round_number(mantissas[i], static_cast<int>(power));
}

} // namespace

double PdfRange::position(double pdf) const {
    return std::clamp(std::log(pdf / low) / std::log(high / low), 0.0, 1.0);
}

PdfRange automatic_range(const PdfImage& image) {
    const Histogram h = histogram_of(image);
    if (!(h.total_solid_angle > 0.0)) return {0.1, 1.0};
    int first = 0, last = bin_count - 1;
    for (double sum = 0.0; first < last; ++first)
        if ((sum += h.solid_angle[static_cast<std::size_t>(first)]) > low_share_of_sphere * h.total_solid_angle)
            break;
    for (double sum = 0.0; last > first; --last)
        if ((sum += h.probability[static_cast<std::size_t>(last)]) >
            high_share_of_probability * h.total_probability)
            break;
    double low = log10_of_border(first), high = log10_of_border(last + 1);
    low = std::max(low, high - most_decades);
    if (const double lacking = least_decades - (high - low); lacking > 0.0) {
        low -= 0.5 * lacking;
        high += 0.5 * lacking;
    }
    return {round_to_125(low, false), round_to_125(high, true)};
}

std::optional<PdfRange> parse_range(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == text.size()) return {};
    PdfRange range;
    char* end = nullptr;
    range.low = std::strtod(text.c_str(), &end);
    if (end != text.c_str() + colon) return {};
    range.high = std::strtod(text.c_str() + colon + 1, &end);
    if (end != text.c_str() + text.size()) return {};
    if (!(range.low >= 1e-45 && range.high <= 1e39 && range.low < range.high)) return {};
    return range;
}

std::string to_string(const PdfRange& range) {
    char text[64];
    std::snprintf(text, sizeof text, "%g:%g", range.low, range.high);
    return text;
}

double Tick::pdf() const { return round_number(mantissa, exponent); }

std::vector<Tick> ticks(const PdfRange& range) {
    constexpr double slack = 1e-9;
    std::vector<Tick> out;
    const int first = static_cast<int>(std::floor(std::log10(range.low)));
    const int last = static_cast<int>(std::floor(std::log10(range.high) + slack));
    for (int exponent = first; exponent <= last; ++exponent)
        for (int mantissa = 1; mantissa <= 9; ++mantissa) {
            const Tick tick{mantissa, exponent};
            if (tick.pdf() >= range.low * (1.0 - slack) && tick.pdf() <= range.high * (1.0 + slack))
                out.push_back(tick);
        }
    return out;
}

bool is_major(const Tick& tick, const PdfRange& range) {
    constexpr double slack = 1.0 + 1e-9;
    if (tick.mantissa == 1 || range.high * slack < 5.0 * range.low) return true;
    return (tick.mantissa == 2 || tick.mantissa == 5) && range.high <= 100.0 * range.low * slack;
}

} // namespace acdf::tools
