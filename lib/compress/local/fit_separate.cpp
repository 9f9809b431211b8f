#include "compress/local/fit_separate.h"

#include "compress/boxes.h"
#include "compress/local/light.h"
#include "compress/parallel.h"

#include <acdf/curves/normals.h>
#include <acdf/local.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kSide = 4; // samples of a bin's normals along a side

/// Normals spread evenly over a bin, and how far any normal of the bin may be from the nearest of them (a sine).
struct BinNormals {
    std::vector<Direction> normals;
    double gap = 0.0;
};

BinNormals of_cell(const NormalBins& bins, std::size_t bin) {
    BinNormals out;
    const auto row = static_cast<double>(bin / bins.columns), column = static_cast<double>(bin % bins.columns);
    for (std::uint32_t i = 0; i < kSide; ++i)
        for (std::uint32_t k = 0; k < kSide; ++k) {
            double s, c, radius, z;
            acdf_sincospi((row + (i + 0.5) / kSide) / bins.rows, &radius, &z);
            acdf_sincospi(1.0 - 2.0 * (column + (k + 0.5) / kSide) / bins.columns, &s, &c);
            out.normals.push_back({radius * c, radius * s, z});
        }
    out.gap = ACDF_PI / kSide * std::hypot(0.5 / bins.rows, 1.0 / bins.columns);
    return out;
}

/// Corners of an octahedron `kSide` times as fine that are nearer to the bin's corner than to another.
BinNormals of_corner(const NormalBins& bins, std::size_t bin) {
    static_assert(kSide == 4);
    const Direction& n = bins.normals[bin];
    const double sum = std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]), step = 1.0 / (bins.subdivisions * kSide);
    BinNormals out;
    for (int x = -4; x <= 4; ++x)
        for (int y = -4; y <= 4; ++y)
            for (int z = -4; z <= 4; ++z) {
                // Steps on the lattice of the finer octahedron; those off its surface belong to other layers.
                const Direction d = {n[0] / sum + x * step, n[1] / sum + y * step, n[2] / sum + z * step};
                if (std::abs(std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]) - 1.0) > 0.5 * step) continue;
                const float normal[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]),
                                         static_cast<float>(d[2])};
                AcdfNormalBins found;
                if (!bins.find(normal, found) || acdf_nearest_bin(&found) != bin) continue;
                const double length = std::sqrt(dot(d, d));
                out.normals.push_back({d[0] / length, d[1] / length, d[2] / length});
            }
    out.gap = 2.5 * step; // an edge at the middle of a face is the longest: sqrt(6) steps
    return out;
}

BinNormals normals_of(const NormalBins& bins, std::size_t bin, BinTarget kind) {
    if (kind == BinTarget::centre) return {{bins.normals[bin]}, 0.0};
    return bins.subdivisions > 0 ? of_corner(bins, bin) : of_cell(bins, bin);
}

/// The mean over normals of (max(0, n . omega) / E_n)^2.
class MeanSquare {
public:
    MeanSquare(const BinNormals& bin, const std::vector<LightPoint>& light, double reach) : bin_(bin) {
        double best = 0.0;
        for (const Direction& n : bin.normals) {
            double irradiance = 0.0;
            for (const LightPoint& p : light) irradiance += p.amount * std::max(0.0, dot(p.direction, n));
            inverse_.push_back(irradiance > 0.0 ? 1.0 / irradiance : 0.0);
            mean_irradiance += irradiance / double(bin.normals.size());
            best = std::max(best, inverse_.back());
        }
        // What lies below all of the samples, but above the horizon of a normal between them: all there is, where
        // no sample sees any light.
        edge_ = bin.gap > 0.0 ? bin.gap + reach : 0.0;
        glimpse_ = best > 0.0 ? 1e-8 * best * best : 1.0;
    }
    double mean_irradiance = 0.0;

    double operator()(const Direction& omega) const {
        double sum = 0.0, highest = -1.0;
        for (std::size_t i = 0; i < bin_.normals.size(); ++i) {
            const double cosine = dot(bin_.normals[i], omega);
            highest = std::max(highest, cosine);
            const double f = std::max(0.0, cosine) * inverse_[i];
            sum += f * f;
        }
        const double mean = sum / double(bin_.normals.size());
        return mean < glimpse_ && highest > -edge_ ? glimpse_ : mean;
    }

private:
    const BinNormals& bin_;
    std::vector<double> inverse_;
    double edge_ = 0.0, glimpse_ = 0.0;
};

struct OneBin {
    Target target;
    double irradiance = 0.0;

    /// Its part of all light: nothing is sampled where that is 0.
    float share(double total) const {
        return target.total > 0.0 ? static_cast<float>(std::max(irradiance / total, 1e-12)) : 0.0f;
    }
};

OneBin target_of(const Target& target, const std::vector<LightPoint>& light, const NormalBins& bins,
                 std::size_t bin, BinTarget kind) {
    const BinNormals normals = normals_of(bins, bin, kind);
    // Half the diagonal of a texel; on the octahedral square no point is farther from the middle than this.
    const double texel = is_octahedral(target)
                             ? 0.5 * ACDF_OCTAHEDRAL_SPEED * (1.0 / target.rows + 1.0 / target.columns)
                             : ACDF_PI * std::hypot(0.5 / target.rows, 1.0 / target.columns);
    const MeanSquare square(normals, light, texel);
    OneBin out{of_values(target), square.mean_irradiance};
    parallel_for(std::uint32_t{0}, target.rows, [&](std::uint32_t r) {
        float* row = out.target.values.data() + std::size_t{r} * target.columns;
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            if (row[c] == 0.0f) continue;
            const double value = row[c] * std::sqrt(square(direction_at(target, r + 0.5, c + 0.5)));
            row[c] = value > 0.0 ? std::max(static_cast<float>(value), std::numeric_limits<float>::min()) : 0.0f;
        }
    });
    out.target.total = integral(out.target);
    out.target.mean_square = 0.0;
    return out;
}

/// A curve that is never entered.
Cascade dark_tree() {
    Cascade out;
    out.roots = {0};
    out.curves.push_back({ACDF_AXIS_PHI, {}, {1.0}, {}, {}});
    return out;
}

} // namespace

Target bin_target(const Target& target, const NormalBins& bins, std::size_t bin, BinTarget kind) {
    return target_of(target, light_points(target), bins, bin, kind).target;
}

SeparateFit fit_local_separate(const Target& target, const NormalBins& bins, BinTarget kind,
                               const FitOptions& options) {
    if (!has_energy(target)) throw std::invalid_argument("a target without energy");
    const std::vector<LightPoint> light = light_points(target);
    SeparateFit out;
    out.shares.assign(bins.normals.size(), 0.0f);
    FitOptions own = options;
    own.progress = {};
    Cascade trees = fit(target, own).cascade;
    std::vector<bool> stored(bins.normals.size(), false);
    const double total = integral(target);
    for (std::size_t b = 0; b < stored.size(); ++b) {
        if (!(bins.weight[b] > 0.0)) continue;
        const OneBin bin = target_of(target, light, bins, b, kind);
        stored[b] = true;
        out.shares[b] = bin.share(total);
        append(bin.target.total > 0.0 ? fit(bin.target, own).cascade : dark_tree(), trees);
        if (options.progress) options.progress(double(b + 1) / double(stored.size()));
    }
    out.tree = encode_tree(trees);
    const std::vector<std::uint32_t> of_trees = std::move(out.tree.roots); // the first is the environment's own
    out.tree.roots.assign(stored.size(), ACDF_NO_ROOT);
    for (std::size_t b = 0, next = 1; b < stored.size(); ++b)
        if (stored[b]) out.tree.roots[b] = of_trees[next++];
    return out;
}

} // namespace acdf::compress
