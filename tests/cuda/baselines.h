// Samplers of all texels of a lat-long map, as GPU renderers have them: in floats from the random numbers to the
// direction. Built on the host; kernels' parameters by value.
#pragma once

#include "on_device.h"

#include "compress/target.h"
#include "measure/samplers/alias_choices.h"

#include <acdf/sphere.h>

#include <cstring>
#include <memory>
#include <vector>

namespace acdf_cuda {

/// Where texels lie.
struct TexelGrid {
    std::uint32_t columns, rows;

    __device__ AcdfDirectionSample place(float column, float row, float pdf) const {
        float sine, cosine, s, c;
        sincospif(1.0f - 2.0f * column / static_cast<float>(columns), &s, &c);
        sincospif(row / static_cast<float>(rows), &sine, &cosine);
        return {{sine * c, sine * s, cosine}, pdf};
    }
    __device__ void find(const float w[3], std::uint32_t& column, std::uint32_t& row) const {
        const float x =
            static_cast<float>(columns) * (0.5f - atan2f(w[1], w[0]) * static_cast<float>(0.5 / ACDF_PI));
        const float y = static_cast<float>(rows) * acosf(w[2]) * static_cast<float>(1.0 / ACDF_PI);
        column = min(static_cast<std::uint32_t>(x), columns - 1);
        row = min(static_cast<std::uint32_t>(y), rows - 1);
    }
};

/// Marginal and conditional CDFs, searched by halving (pbrt's FindInterval): eight bytes a texel.
struct FullTable {
    TexelGrid grid;
    const float *marginal, *conditional, *densities;

    __device__ static float invert(const float* cdf, std::uint32_t count, float u, std::uint32_t& at) {
        std::uint32_t first = 1, size = count - 1;
        while (size > 0) {
            const std::uint32_t half = size >> 1;
            const bool beyond = cdf[first + half] <= u;
            first = beyond ? first + half + 1 : first;
            size = beyond ? size - half - 1 : half;
        }
        at = first - 1;
        const float low = cdf[at], width = cdf[first] - low;
        return static_cast<float>(at) + (width > 0.0f ? min((u - low) / width, 0.99999994f) : 0.5f);
    }
    __device__ AcdfDirectionSample sample(float u0, float u1) const {
        std::uint32_t row, column;
        const float y = invert(marginal, grid.rows, u1, row);
        const float x = invert(conditional + std::size_t{row} * (grid.columns + 1), grid.columns, u0, column);
        return grid.place(x, y, densities[std::size_t{row} * grid.columns + column]);
    }
    __device__ float pdf(const float w[3]) const {
        std::uint32_t row, column;
        grid.find(w, column, row);
        return densities[std::size_t{row} * grid.columns + column];
    }
};

/// The alias method. Sixteen bytes a texel, so that a sample is one load: what the texel keeps, its alias, and
/// the pdfs of both.
struct AliasTable {
    TexelGrid grid;
    const float4* entries;

    __device__ AcdfDirectionSample sample(float u0, float u1) const {
        const float x = u0 * static_cast<float>(grid.columns), y = u1 * static_cast<float>(grid.rows);
        std::uint32_t column = min(static_cast<std::uint32_t>(x), grid.columns - 1);
        std::uint32_t row = min(static_cast<std::uint32_t>(y), grid.rows - 1);
        const float4 entry = entries[std::size_t{row} * grid.columns + column];
        float left = x - static_cast<float>(column);
        const float across = y - static_cast<float>(row);
        const bool keeps = left < entry.x;
        left = keeps ? left / entry.x : (left - entry.x) / (1.0f - entry.x);
        if (!keeps) {
            const std::uint32_t alias = __float_as_uint(entry.y);
            column = alias % grid.columns;
            row = alias / grid.columns;
        }
        return grid.place(static_cast<float>(column) + left, static_cast<float>(row) + across,
                          keeps ? entry.z : entry.w);
    }
    __device__ float pdf(const float w[3]) const {
        std::uint32_t row, column;
        grid.find(w, column, row);
        return entries[std::size_t{row} * grid.columns + column].z;
    }
};

/// Hierarchical warping of a map whose sides are powers of two: of each four texels, side by side in memory, one.
struct WarpTable {
    TexelGrid grid;
    const float4* quads;      ///< level by level, the coarsest first
    const float* solid_angle; ///< of a texel of each row
    std::uint32_t levels;     ///< of 2^i columns and half as many rows, but the first, which has one

    __device__ static bool second(float low, float high, float& u) {
        const float scaled = u * (low + high);
        const bool yes = scaled >= low && high > 0.0f;
        u = min(yes ? (scaled - low) / high : scaled / low, 0.99999994f);
        return yes;
    }
    __device__ AcdfDirectionSample sample(float u0, float u1) const {
        std::uint32_t column = 0, row = 0;
        const float4* level = quads;
        float share = 1.0f;
        for (std::uint32_t i = 0; i < levels; ++i) {
            const float4 s = level[(row << i) + column];
            const bool lower = second(s.x + s.y, s.z + s.w, u1);
            const float left = lower ? s.z : s.x, right = lower ? s.w : s.y;
            const bool is_right = second(left, right, u0);
            share = is_right ? right : left;
            row = 2 * row + lower;
            column = 2 * column + is_right;
            level += i == 0 ? 1u : 1u << (2u * i - 1u);
        }
        return grid.place(static_cast<float>(column) + u0, static_cast<float>(row) + u1, share / solid_angle[row]);
    }
};

/// All three of a map of 2 n x n texels, n a power of two.
class Baselines {
public:
    explicit Baselines(const acdf::compress::Target& target) : grid_{target.columns, target.rows} {
        const std::size_t texels = std::size_t{target.columns} * target.rows;
        std::vector<double> mass(texels);
        double total = 0.0;
        for (std::uint32_t r = 0; r < target.rows; ++r)
            for (std::uint32_t c = 0; c < target.columns; ++c)
                total += mass[std::size_t{r} * target.columns + c] =
                    target.row(r)[c] * target.column_measure[c] * target.row_measure[r];
        for (double& m : mass) m /= total;
        std::vector<float> densities(texels);
        for (std::size_t i = 0; i < texels; ++i) densities[i] = static_cast<float>(target.values[i] / total);
        make_cdfs(mass, densities);
        make_alias(mass, densities);
        make_warp(mass, target);
    }
    FullTable full() const { return {grid_, marginal_->data(), conditional_->data(), pdfs_->data()}; }
    AliasTable alias() const { return {grid_, entries_->data()}; }
    WarpTable warp() const { return {grid_, quads_->data(), solid_angle_->data(), levels_}; }

private:
    template <class T>
    static std::unique_ptr<DeviceArray<T>> to_device(const std::vector<T>& values) {
        return std::make_unique<DeviceArray<T>>(values.data(), values.size());
    }
    void make_cdfs(const std::vector<double>& mass, const std::vector<float>& densities) {
        std::vector<float> conditional, marginal{0.0f};
        std::vector<double> rows(grid_.rows);
        double below = 0.0;
        for (std::uint32_t r = 0; r < grid_.rows; ++r) {
            const double* row = mass.data() + std::size_t{r} * grid_.columns;
            double sum = 0.0;
            for (std::uint32_t c = 0; c < grid_.columns; ++c) rows[r] += row[c];
            conditional.push_back(0.0f);
            for (std::uint32_t c = 0; c < grid_.columns; ++c)
                conditional.push_back(static_cast<float>((sum += row[c]) / rows[r]));
            marginal.push_back(static_cast<float>(below += rows[r]));
        }
        marginal_ = to_device(marginal);
        conditional_ = to_device(conditional);
        pdfs_ = to_device(densities);
    }
    void make_alias(std::vector<double> mass, const std::vector<float>& densities) {
        for (double& m : mass) m *= static_cast<double>(mass.size());
        const std::vector<acdf::measure::AliasChoice> choices = acdf::measure::alias_choices(mass);
        std::vector<float4> entries(mass.size());
        for (std::size_t i = 0; i < mass.size(); ++i) {
            float number;
            std::memcpy(&number, &choices[i].alias, sizeof number);
            entries[i] = {choices[i].keep, number, densities[i], densities[choices[i].alias]};
        }
        entries_ = to_device(entries);
    }
    void make_warp(std::vector<double> share, const acdf::compress::Target& target) {
        std::vector<std::vector<float4>> levels; // the finest first
        std::uint32_t columns = grid_.columns, rows = grid_.rows;
        while (share.size() > 1) {
            const std::uint32_t half_columns = columns / 2, half_rows = (rows + 1) / 2;
            std::vector<double> above(std::size_t{half_columns} * half_rows);
            std::vector<float4> quads(above.size());
            for (std::uint32_t r = 0; r < half_rows; ++r)
                for (std::uint32_t c = 0; c < half_columns; ++c) {
                    const auto at = [&](std::uint32_t down, std::uint32_t right) {
                        return 2 * r + down < rows ? share[std::size_t{2 * r + down} * columns + 2 * c + right]
                                                   : 0.0;
                    };
                    const double four[4] = {at(0, 0), at(0, 1), at(1, 0), at(1, 1)};
                    const std::size_t quad = std::size_t{r} * half_columns + c;
                    above[quad] = four[0] + four[1] + four[2] + four[3];
                    quads[quad] = {float(four[0]), float(four[1]), float(four[2]), float(four[3])};
                }
            levels.push_back(std::move(quads));
            share.swap(above);
            columns = half_columns;
            rows = half_rows;
        }
        std::vector<float4> all;
        for (auto level = levels.rbegin(); level != levels.rend(); ++level)
            all.insert(all.end(), level->begin(), level->end());
        std::vector<float> solid_angle;
        for (const double height : target.row_measure)
            solid_angle.push_back(static_cast<float>(height * target.column_measure[0]));
        levels_ = static_cast<std::uint32_t>(levels.size());
        quads_ = to_device(all);
        solid_angle_ = to_device(solid_angle);
    }

    TexelGrid grid_;
    std::uint32_t levels_ = 0;
    std::unique_ptr<DeviceArray<float>> marginal_, conditional_, pdfs_, solid_angle_;
    std::unique_ptr<DeviceArray<float4>> entries_, quads_;
};

} // namespace acdf_cuda
