#include "compress/local/halved/filling.h"

#include "compress/parallel.h"

#include <acdf/layout.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::compress {
namespace {

constexpr int kRadiances = 128;      // of radiances, each the square root of 2 times the one before
constexpr double kFirst = -24.0;     // the first, as an exponent of 2
constexpr std::uint32_t kAcross = 4; // blocks across a cell whose thresholds are kept
constexpr double kLeastOfAll = 0.1;  // of the samples of all light alone, those that stay whatever the partner has

std::uint32_t step_of(double light) {
    return static_cast<std::uint32_t>(std::clamp(2.0 * (std::log2(light) - kFirst), 0.0, kRadiances - 1.0));
}

} // namespace

Radiances::Radiances(const Blocks& blocks, double unit) : blocks_(blocks) {
    const Target& grid = blocks.grid();
    const std::uint32_t rows = blocks.rows(), columns = blocks.columns();
    std::vector<std::vector<Part>> parts(std::size_t{rows} * columns);
    parallel_for(std::uint32_t{0}, rows, [&](std::uint32_t i) {
        std::array<double, kRadiances> light{}, area{};
        const double top = blocks.borders(0)[i], bottom = blocks.borders(0)[i + 1];
        for (std::uint32_t k = 0; k < columns; ++k) {
            const double left = blocks.borders(1)[k], right = blocks.borders(1)[k + 1];
            std::uint32_t low = kRadiances, high = 0;
            for (auto r = static_cast<std::uint32_t>(top); r < bottom; ++r)
                for (auto c = static_cast<std::uint32_t>(left); c < right; ++c) {
                    const double l = double{grid.row(r)[c]} * unit;
                    if (!(l > 0.0)) continue;
                    const double tall = std::min(bottom, r + 1.0) - std::max(top, double(r)),
                                 wide = std::min(right, c + 1.0) - std::max(left, double(c));
                    const double measure = tall * grid.row_measure[r] * wide * grid.column_measure[c];
                    const std::uint32_t step = step_of(l);
                    light[step] += l * measure;
                    area[step] += measure;
                    low = std::min(low, step);
                    high = std::max(high, step);
                }
            for (std::uint32_t step = low; step <= high; ++step) {
                if (!(area[step] > 0.0)) continue;
                parts[std::size_t{i} * columns + k].push_back(
                    {step, static_cast<float>(light[step]), static_cast<float>(area[step])});
                light[step] = area[step] = 0.0;
            }
        }
    });
    for (const std::vector<Part>& of_block : parts) {
        begin_.push_back(static_cast<std::uint32_t>(parts_.size()));
        parts_.insert(parts_.end(), of_block.begin(), of_block.end());
    }
    begin_.push_back(static_cast<std::uint32_t>(parts_.size()));
}

LitNormal Radiances::seen(const Direction& normal, double ratio) const {
    std::array<double, kRadiances> light{}, area{};
    const float n[3] = {static_cast<float>(normal[0]), static_cast<float>(normal[1]),
                        static_cast<float>(normal[2])};
    std::size_t block = 0;
    for (std::uint32_t r = blocks_.rows(); r < 2 * blocks_.rows(); ++r)
        for (std::uint32_t c = blocks_.columns(); c < 2 * blocks_.columns(); ++c, ++block) {
            const float* axis = blocks_.cone({r, c}).axis;
            const float cosine = axis[0] * n[0] + axis[1] * n[1] + axis[2] * n[2];
            if (!(cosine > 0.0f)) continue;
            for (std::uint32_t i = begin_[block]; i < begin_[block + 1]; ++i) {
                light[parts_[i].level] += double{cosine * parts_[i].light};
                area[parts_[i].level] += double{cosine * parts_[i].area};
            }
        }
    LitNormal out;
    for (const double l : light) out.irradiance += l;
    double low = out.irradiance / (ACDF_PI * (1.0 + ratio)) / 64.0, high = out.irradiance / (ACDF_PI * ratio);
    for (int step = 0; step < 32 && out.irradiance > 0.0; ++step) {
        const double at = std::sqrt(low * high);
        double sum = 0.0;
        for (std::size_t k = 0; k < kRadiances; ++k) sum += std::max(0.0, light[k] - at * area[k]);
        (sum > ACDF_PI * at * ratio ? low : high) = at;
    }
    out.threshold = high;
    return out;
}

double Radiances::brightest(HalvedBox box) const {
    std::uint32_t r[2] = {box.rows, box.rows + 1}, c[2] = {box.columns, box.columns + 1}, most = 0;
    while (r[0] < blocks_.rows()) r[0] *= 2, r[1] *= 2;
    while (c[0] < blocks_.columns()) c[0] *= 2, c[1] *= 2;
    for (std::uint32_t i = r[0]; i < r[1]; ++i)
        for (std::uint32_t k = c[0]; k < c[1]; ++k) {
            const std::size_t block = std::size_t{i - blocks_.rows()} * blocks_.columns() + (k - blocks_.columns());
            if (begin_[block + 1] > begin_[block]) most = std::max(most, parts_[begin_[block + 1] - 1].level + 1);
        }
    return most < kRadiances ? std::exp2(0.5 * most + kFirst) : std::numeric_limits<double>::infinity();
}

FilledLight::FilledLight(const Blocks& blocks, const SomeNormals& normals, const Radiances& radiances, double ratio)
    : blocks_(blocks), normals_(normals) {
    const std::size_t count = normals_.weights.size();
    std::vector<LitNormal> lit(count);
    const auto normal = [&](std::size_t i) -> Direction {
        return {double{normals_.normals.x[i]}, double{normals_.normals.y[i]}, double{normals_.normals.z[i]}};
    };
    parallel_for(std::size_t{0}, count, [&](std::size_t i) { lit[i] = radiances.seen(normal(i), ratio); });
    double low = 1e300, high = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool any = lit[i].irradiance > 0.0;
        normals_.weights[i] = any ? normals_.weights[i] / lit[i].irradiance : 0.0;
        if (!any) continue;
        low = std::min(low, lit[i].threshold);
        high = std::max(high, lit[i].threshold);
    }
    if (!(high > 0.0)) low = high = 1.0; // no light reaches any
    const double range = std::log(std::max(high / low, 1.0 + 1e-6));
    const auto place = [&](double threshold, std::size_t of) {
        return std::clamp(std::log(threshold / low) / range, 0.0, 1.0) * double(of);
    };
    for (std::size_t j = 0; j < kLevels; ++j)
        level_[j] = static_cast<float>(low * std::exp(range * double(j) / (kLevels - 1)));
    classes_.resize(kClasses);
    for (std::size_t j = 0; j < kClasses; ++j)
        class_threshold_.push_back(low * std::exp(range * (double(j) + 0.5) / kClasses));
    for (std::size_t i = 0; i < count; ++i) {
        if (!(normals_.weights[i] > 0.0)) continue;
        SomeNormals& of =
            classes_[std::min(static_cast<std::size_t>(place(lit[i].threshold, kClasses)), kClasses - 1)];
        of.normals.add(normal(i));
        of.weights.push_back(normals_.weights[i]);
    }
    const std::uint32_t rows = blocks.rows() / kAcross, columns = blocks.columns() / kAcross;
    shares_.resize(std::size_t{rows} * columns);
    parallel_for(std::size_t{0}, shares_.size(), [&](std::size_t cell) {
        const HalvedBox box{rows + static_cast<std::uint32_t>(cell / columns),
                            columns + static_cast<std::uint32_t>(cell % columns)};
        const float* axis = blocks.cone(box).axis;
        const Direction d = {double{axis[0]}, double{axis[1]}, double{axis[2]}};
        std::array<double, kLevels> of{};
        double sum = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const double own = normals_.weights[i] * std::max(0.0, dot(d, normal(i)));
            if (!(own > 0.0)) continue;
            const double at = place(lit[i].threshold, kLevels - 1);
            const auto j = std::min(static_cast<std::size_t>(at), kLevels - 2);
            of[j] += own * (1.0 - (at - double(j)));
            of[j + 1] += own * (at - double(j));
            sum += own;
        }
        if (!(sum > 0.0)) of[0] = sum = 1.0; // no normal sees it
        for (std::size_t j = 0; j < kLevels; ++j) shares_[cell][j] = static_cast<float>(of[j] / sum);
    });
}

std::size_t FilledLight::cell(HalvedBox block) const {
    return std::size_t{(block.rows - blocks_.rows()) / kAcross} * (blocks_.columns() / kAcross) +
           (block.columns - blocks_.columns()) / kAcross;
}

float FilledLight::spread(HalvedBox block, float light) const {
    const Shares& of = shares_[cell(block)];
    float sum = 0.0f;
    for (std::size_t j = 0; j < kLevels; ++j) {
        const float above = std::max(0.0f, light - level_[j]);
        sum += of[j] * above * above;
    }
    return sum > 0.0f ? sum / light : 0.0f;
}

double FilledLight::above(HalvedBox block, double light) const {
    const Shares& of = shares_[cell(block)];
    double sum = 0.0;
    for (std::size_t j = 0; j < kLevels; ++j) sum += double{of[j]} * std::max(0.0, light - double{level_[j]});
    return sum;
}

float FilledLight::cost(HalvedBox block, float light) const {
    const Shares& of = shares_[cell(block)];
    float sum = 0.0f;
    for (std::size_t j = 0; j < kLevels; ++j) {
        const float ratio = light / level_[j];
        sum += of[j] * (ratio > 1.0f ? 1.0f - 0.5f / ratio : 0.5f * ratio);
    }
    return sum;
}

FilledCosts::FilledCosts(const Blocks& blocks, const SharedLight& shared, const FilledLight& light)
    : HalvedCosts(shared.costs().axes()), blocks_(blocks), shared_(shared), light_(light) {}

float FilledCosts::cost(HalvedBox box) const {
    const float alone = shared_.costs().cost(box);
    return alone > 0.0f ? alone * light_.cost(blocks_.block_of(box), static_cast<float>(radiance(box))) : 0.0f;
}

double FilledCosts::weight(HalvedBox box) const {
    const double alone = shared_.alone(box);
    if (!(alone > 0.0)) return 0.0;
    return std::max(kLeastOfAll * alone, axes().measure(box) * light_.above(blocks_.block_of(box), radiance(box)));
}

} // namespace acdf::compress
