#include "tools/render/images.h"

#include "tools/plot/legend.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

constexpr int kLeastWidth = 384; ///< of a figure: smaller ones are enlarged, pixel by pixel

/// 1, 2 or 5 times a power of ten, at most `value` or, upwards, at least.
double round_number(double value, bool upwards) {
    const double decade = std::pow(10.0, std::floor(std::log10(value)));
    constexpr double steps[] = {1.0, 2.0, 5.0, 10.0};
    if (upwards) return decade * *std::find_if(steps, steps + 3, [&](double s) { return s * decade >= value; });
    double out = decade;
    for (const double s : steps)
        if (s * decade <= value) out = s * decade;
    return out;
}

} // namespace

images::Picture scene_picture(const measure::Scene& scene, const measure::ScenePoints& points,
                              const std::vector<measure::Rgb>& values) {
    images::Picture image(static_cast<int>(scene.width), static_cast<int>(scene.height));
    float* out = image.values.data();
    for (std::uint32_t y = 0; y < scene.height; ++y)
        for (std::uint32_t x = 0; x < scene.width; ++x) {
            const std::uint32_t point = points.of_pixel[std::size_t{y} * scene.width + x];
            measure::Rgb value;
            if (point == measure::ScenePoints::none) {
                const measure::Vec3 d = scene.camera.ray(x, y, scene.width, scene.height).direction;
                const float direction[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]),
                                            static_cast<float>(d[2])};
                value = scene.light.radiance(direction);
            } else {
                value = values[point];
            }
            for (const double channel : value) *out++ = static_cast<float>(channel);
        }
    return image;
}

double exposure(const std::vector<measure::Rgb>& values) {
    std::vector<double> luminances;
    for (const measure::Rgb& value : values) luminances.push_back(measure::luminance(value));
    if (luminances.empty()) return 1.0;
    const std::size_t at = luminances.size() * 98 / 100;
    std::nth_element(luminances.begin(), luminances.begin() + static_cast<std::ptrdiff_t>(at), luminances.end());
    constexpr double headroom = 1.5; // for colours, of which one channel is brighter than their luminance
    return luminances[at] > 0.0 ? headroom * luminances[at] : 1.0;
}

images::Picture displayed(const images::Picture& linear, double exposure) {
    images::Picture image = linear;
    for (float& value : image.values)
        value = linear_to_srgb(std::clamp(value / static_cast<float>(exposure), 0.0f, 1.0f));
    return image;
}

images::Picture figure_picture(const measure::Scene& scene, const measure::ScenePoints& points,
                               const std::vector<double>& values, const FigureImage& figure) {
    const int times =
        std::max(1, (kLeastWidth + static_cast<int>(scene.width) - 1) / static_cast<int>(scene.width));
    PdfImage image;
    image.map.width = times * static_cast<int>(scene.width);
    image.map.height = times * static_cast<int>(scene.height);
    for (int y = 0; y < image.map.height; ++y)
        for (int x = 0; x < image.map.width; ++x) {
            const std::size_t pixel =
                static_cast<std::size_t>(y / times) * scene.width + static_cast<std::size_t>(x / times);
            const std::uint32_t point = points.of_pixel[pixel];
            image.pdf.push_back(point == measure::ScenePoints::none ? shows_nothing
                                                                    : static_cast<float>(values[point]));
        }
    Legend legend;
    legend.title = {figure.title};
    legend.range = figure.range;
    legend.shows_zero = figure.shows_zero;
    legend.per_steradian = false;
    legend.colours = figure.colours;
    return add_legend(false_colour(image, figure.range, figure.colours), legend, find_font());
}

PdfRange figure_range(std::vector<double> values) {
    values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !(v > 0.0); }), values.end());
    if (values.empty()) return {0.1, 1.0};
    std::sort(values.begin(), values.end());
    const std::size_t margin = values.size() / 100;
    PdfRange range{round_number(values[margin], false), round_number(values[values.size() - 1 - margin], true)};
    range.high = std::max(range.high, 10.0 * range.low);
    range.low = std::max(range.low, 1e-8 * range.high);
    return range;
}

} // namespace acdf::tools
