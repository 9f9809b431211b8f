#include "build/accuracy/local.h"

#include "build/accuracy/cells.h"
#include "build/accuracy/combination.h"
#include "build/accuracy/fine_texels.h"
#include "build/accuracy/step_means.h"
#include "build/accuracy/texel_cosines.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace acdf::build {
namespace {

using compress::Sum;
using compress::Target;

/// What a tilt makes of the pdf of a texel, over its mean: the harmonic mean and the smallest.
struct Slope {
    float harmonic = 1.0f, smallest = 1.0f;
};

/// What does not depend on the normal: for each texel its tile and its mean pdf within the tile, sr^-1.
struct TilePicture {
    std::vector<std::uint32_t> tile;
    std::vector<double> density;
    std::vector<Slope> slope; ///< empty where no curve is tilted
    std::uint32_t root = 0; ///< of the tree that is one tile of everything; of no meaning for tiles that are shared
};

class LocalMeasure {
public:
    LocalMeasure(const File& file, const Target& target)
        : file_(file), texels_(target), target_(texels_.target()), local_(file.local().data()), cosines_(target_),
          boxes_(tile_boxes(file)) {
        const std::size_t texels = std::size_t{target_.columns} * target_.rows;
        if (!boxes_.empty()) {
            shared_ = {std::vector<std::uint32_t>(texels), std::vector<double>(texels), {}, 0};
            for (std::uint32_t t = 0; t < boxes_.size(); ++t)
                for_each_tile_cell(file_, t,
                                   [&](const Cell& cell) { fill(cell.range, cell.probability, t, shared_); });
        }
        Sum total;
        for (std::uint32_t r = 0; r < target_.rows; ++r)
            for (std::uint32_t c = 0; c < target_.columns; ++c) total.add(target_.row(r)[c] * solid_angle(r, c));
        total_ = total.value();
    }

    NormalAccuracy measure(const Normal& normal, TilePicture& own) const {
        AcdfLocalPoint source;
        acdf_local_at(&local_, normal.data(), &source);
        const double length = std::hypot(double{normal[0]}, double{normal[1]}, double{normal[2]});
        const float unit[3] = {static_cast<float>(normal[0] / length), static_cast<float>(normal[1] / length),
                               static_cast<float>(normal[2] / length)};
        if (source.what == ACDF_LOCAL_ROWS) return sum(unit, shared_, tile_probabilities(source.by.rows));
        if (source.what == ACDF_LOCAL_NOTHING) return sum(unit, shared_, {});
        if (own.density.empty() || own.root != source.by.root) paint_tree(source.by.root, own);
        return sum(unit, own, {1.0});
    }

private:
    double solid_angle(std::uint32_t r, std::uint32_t c) const {
        return target_.row_measure[r] * target_.column_measure[c];
    }

    void fill(const AcdfTiltedRange* cell, double probability, std::uint32_t tile, TilePicture& out) const {
        const AcdfGrid grid = acdf_environment_grid(&local_.environment);
        const double omega = acdf_grid_solid_angle(&grid, untilted(cell).data());
        const std::array<AcdfTiltedRange, 2> range = texels_.box(cell);
        for (std::uint32_t r = range[1].low; r < range[1].high; ++r) {
            const std::size_t row = std::size_t{r} * target_.columns;
            std::fill(out.density.begin() + std::ptrdiff_t(row + range[0].low),
                      out.density.begin() + std::ptrdiff_t(row + range[0].high), probability / omega);
            std::fill(out.tile.begin() + std::ptrdiff_t(row + range[0].low),
                      out.tile.begin() + std::ptrdiff_t(row + range[0].high), tile);
        }
        if (range[0].tilt != 0.0 || range[1].tilt != 0.0) tilt(range.data(), out);
    }

    void tilt(const AcdfTiltedRange* range, TilePicture& out) const {
        out.slope.resize(out.density.size());
        std::vector<StepMeans> columns, rows;
        range_means(range[0], target_.column_measure, columns);
        range_means(range[1], target_.row_measure, rows);
        for (std::uint32_t r = range[1].low; r < range[1].high; ++r)
            for (std::uint32_t c = range[0].low; c < range[0].high; ++c) {
                const StepMeans &x = columns[c - range[0].low], &y = rows[r - range[1].low];
                const std::size_t i = std::size_t{r} * target_.columns + c;
                const double mean = x.g * y.g;
                out.density[i] *= mean;
                out.slope[i] = {static_cast<float>(1.0 / (mean * x.reciprocal * y.reciprocal)),
                                static_cast<float>(x.smallest * y.smallest / mean)};
            }
    }

    void paint_tree(std::uint32_t root, TilePicture& out) const {
        out.tile.resize(std::size_t{target_.columns} * target_.rows);
        out.density.resize(out.tile.size());
        out.slope.clear();
        out.root = root;
        const auto fill_cell = [&](const Cell& cell) { fill(cell.range, cell.probability, 0, out); };
        if (local_.environment.halved) for_each_cell(file_.local().environment(), fill_cell);
        else for_each_cell(file_, root, fill_cell);
    }

    std::vector<double> tile_probabilities(const AcdfRowMixture& mix) const {
        std::vector<double> out(boxes_.size());
        for (std::uint32_t t = 0; t < out.size(); ++t) out[t] = acdf_rows_mass(&mix, t, t + 1) * 0x1p-52;
        return out;
    }

    /// Over the texels of a row, as far as they are above the horizon.
    struct RowSums {
        double flux = 0.0, second = 0.0, first = 0.0, light = 0.0, light_second = 0.0;
        compress::ChannelSums irradiance; ///< of channels, where f is not g
    };
    /// What goes on from row to row.
    struct Row {
        const float* n;
        const TilePicture& picture;
        /// Probabilities without the share around the normal; empty: nothing is sampled.
        const std::vector<double>& tile;
        double share;               ///< that is sampled around the normal
        Combination both, baseline; ///< with the partner
        double largest = 0.0;
        std::uint64_t violations = 0;
    };

    /// Of files that are sampled from alone, of the integrand g, without slopes and shares: most are.
    bool is_plain(const Row& state) const {
        return !local_.partner && target_.means.empty() && target_.peaks.empty() && state.picture.slope.empty() &&
               state.share == 0.0 && !state.tile.empty();
    }

    /// Sums of every fourth texel of a row: additions to one of them wait for each other, those to several do not.
    struct Lanes {
        static constexpr std::size_t count = 4;
        double flux[count] = {}, second[count] = {}, first[count] = {}, light[count] = {}, light_second[count] = {},
               largest[count] = {};
    };

    /// sum_row() of what is_plain(). `cosine`: room for those of a row.
    RowSums sum_plain_row(std::uint32_t r, Row& state, double* cosine) const {
        cosines_.write_row(state.n, r, cosine);
        const std::size_t whole = target_.columns / Lanes::count * Lanes::count;
        Lanes lanes;
        std::size_t c = 0;
        for (; c < whole; c += Lanes::count) add_texels<Lanes::count>(r, c, cosine + c, state, lanes);
        for (; c < target_.columns; ++c) add_texels<1>(r, c, cosine + c, state, lanes);
        RowSums out;
        for (std::size_t k = 0; k < Lanes::count; ++k) {
            out.flux += lanes.flux[k];
            out.second += lanes.second[k];
            out.first += lanes.first[k];
            out.light += lanes.light[k];
            out.light_second += lanes.light_second[k];
            state.largest = std::max(state.largest, lanes.largest[k]);
        }
        return out;
    }

    /// Of `count` texels from column c on, and of their cosines.
    template <std::size_t count>
    void add_texels(std::uint32_t r, std::size_t c, const double* cosine, Row& state, Lanes& lanes) const {
        double above = 0.0;
        for (std::size_t k = 0; k < count; ++k) above += cosine[k];
        if (above == 0.0) return;
        const std::size_t first = std::size_t{r} * target_.columns + c;
        const std::uint32_t* const tiles = state.picture.tile.data() + first;
        const double* const densities = state.picture.density.data() + first;
        const double* const probability = state.tile.data();
        const double* const measures = target_.column_measure.data() + c;
        const float* const values = target_.row(r) + c;
        const double height = target_.row_measure[r];
        double p[count];
        for (std::size_t k = 0; k < count; ++k) p[k] = probability[tiles[k]] * densities[k];
        for (std::size_t k = 0; k < count; ++k) {
            const double up = cosine[k], omega = up > 0.0 ? height * measures[k] : 0.0;
            const double g = values[k], f = g * up, energy = f * omega;
            const double weight = p[k] > 0.0 ? f / p[k] : 0.0;
            lanes.first[k] += p[k] * omega;
            lanes.flux[k] += energy;
            lanes.light[k] += g * omega;
            lanes.light_second[k] += energy * up;
            lanes.second[k] += weight * energy;
            lanes.largest[k] = weight > lanes.largest[k] ? weight : lanes.largest[k];
        }
        for (std::size_t k = 0; k < count; ++k)
            state.violations += values[k] > 0.0f && cosine[k] > 0.0 && !(p[k] > 0.0);
    }

    RowSums sum_row(std::uint32_t r, Row& state) const {
        const std::size_t row = std::size_t{r} * target_.columns;
        const std::uint32_t* const tiles = state.picture.tile.data() + row;
        const double *const densities = state.picture.density.data() + row, *const probability = state.tile.data();
        const double* const measures = target_.column_measure.data();
        const float* const values = target_.row(r);
        const double height = target_.row_measure[r], share = state.share;
        const bool sampled = !state.tile.empty(), alone = !local_.partner, means_differ = !target_.means.empty();
        const Slope* const slopes = state.picture.slope.empty() ? nullptr : state.picture.slope.data() + row;
        const float* const peaks = target_.peaks.empty() ? nullptr : target_.peaks.data() + row;
        // Copies, which compilers keep in registers.
        double flux = 0.0, second = 0.0, first = 0.0, light = 0.0, light_second = 0.0, largest = state.largest;
        std::uint64_t violations = 0;
        compress::ChannelSums irradiance;
        cosines_.for_each_above(state.n, r, [&](std::uint32_t c, double cosine) {
            const double light_p = sampled ? probability[tiles[c]] * densities[c] : 0.0;
            const double rest = share > 0.0 ? share * cosine / ACDF_PI : 0.0, p = light_p + rest;
            const double omega = height * measures[c], g = values[c];
            first += light_p * omega;
            if (!(g > 0.0)) return;
            const double f = g * cosine, energy = f * omega;
            flux += energy;
            light += g * omega;
            light_second += energy * cosine;
            double means[3];
            std::size_t channels = 0;
            if (!alone || means_differ) {
                channels = compress::means_of(target_, row + c, means);
                irradiance.add(means, channels, cosine * omega);
            }
            if (!alone) {
                for (std::size_t k = 0; k < channels; ++k) means[k] *= cosine;
                state.both.add(f, means, channels, omega, p, cosine / ACDF_PI);
                state.baseline.add(f, means, channels, omega, g / total_, cosine / ACDF_PI);
                return;
            }
            if (!(p > 0.0)) {
                ++violations;
                return;
            }
            // Beside a share of cosine samples the harmonic mean is a bound, near what it stands for.
            const double weight = f / (slopes ? light_p * double{slopes[c].harmonic} + rest : p);
            second += weight * energy;
            const double most = peaks ? cosine * double{peaks[c]} : f;
            largest = std::max(largest, most / (slopes ? light_p * double{slopes[c].smallest} + rest : p));
        });
        state.largest = largest;
        state.violations += violations;
        return {flux, second, first, light, light_second, irradiance};
    }

    NormalAccuracy sum(const float n[3], const TilePicture& picture, std::vector<double> tile) const {
        NormalAccuracy out;
        const bool sampled = !tile.empty(), alone = !local_.partner;
        const double share = sampled ? double{local_.cosine_share} : 0.0;
        for (double& probability : tile) probability *= 1.0 - share;
        Row state{n, picture, tile, share, no_combination(), no_combination()};
        std::vector<double> cosines(is_plain(state) ? target_.columns : 0);
        Sum flux, second, first_above, light, light_second;
        compress::ChannelSums irradiance;
        for (std::uint32_t r = 0; r < target_.rows; ++r) {
            const RowSums row = cosines.empty() ? sum_row(r, state) : sum_plain_row(r, state, cosines.data());
            flux.add(row.flux);
            irradiance.add(row.irradiance);
            second.add(row.second);
            first_above.add(row.first);
            light.add(row.light);
            light_second.add(row.light_second);
        }
        const double e = flux.value();
        if (!(e > 0.0)) return {};
        out.irradiance = e;
        out.support_violations = state.violations;
        const double mean = target_.means.empty() ? e : irradiance.length();
        out.relative_variance = out.support_violations > 0 ? std::numeric_limits<double>::infinity()
                                                           : std::max(0.0, second.value() / mean / mean - 1.0);
        // What is sampled around the normal lies above its horizon, all of it.
        out.share_above_horizon = sampled ? std::min(first_above.value() + share, 1.0) : 0.0;
        out.max_weight = state.largest / mean;
        out.relative_variance_full_cdf = std::max(0.0, total_ / mean * (light_second.value() / mean) - 1.0);
        out.share_above_horizon_full_cdf = light.value() / total_;
        if (alone) return out;
        out.relative_variance = state.both.relative_variance();
        out.relative_variance_full_cdf = state.baseline.relative_variance();
        out.support_violations = state.both.violations();
        out.max_weight = state.both.max_weight();
        out.max_weight_full_cdf = state.baseline.max_weight();
        out.combined = true;
        return out;
    }

    Combination no_combination() const {
        if (!local_.partner) return {0.5, ACDF_HEURISTIC_BALANCE};
        return {double{local_.partner->share}, static_cast<AcdfHeuristic>(local_.partner->heuristic)};
    }

    const File& file_;
    const FineTexels texels_;
    const Target& target_;
    const AcdfLocal local_;
    TexelCosines cosines_;
    const std::vector<std::array<AcdfRange, 2>> boxes_;
    TilePicture shared_;
    double total_ = 0.0;
};

} // namespace

std::vector<NormalAccuracy> measure_normals(const File& file, const Target& target,
                                            const std::vector<Normal>& normals) {
    const AcdfEnvironment environment = file.local().data().environment;
    if (environment.columns != target.columns || environment.rows != target.rows ||
        environment.parameterization != static_cast<std::uint32_t>(target.parameterization))
        throw std::invalid_argument("a target on another grid");
    const LocalMeasure local(file, target);
    std::vector<NormalAccuracy> out(normals.size());
    tbb::enumerable_thread_specific<TilePicture> own;
    compress::parallel_for(std::size_t{0}, normals.size(),
                           [&](std::size_t i) { out[i] = local.measure(normals[i], own.local()); });
    return out;
}

LocalAccuracy summary(const std::vector<NormalAccuracy>& normals) {
    LocalAccuracy out;
    std::vector<double> variances;
    out.least_share_above_horizon = out.least_share_above_horizon_full_cdf = 1.0;
    for (const NormalAccuracy& n : normals) {
        if (!(n.irradiance > 0.0)) continue;
        variances.push_back(n.relative_variance);
        out.relative_variance += n.relative_variance;
        out.relative_variance_full_cdf += n.relative_variance_full_cdf;
        out.share_above_horizon += n.share_above_horizon;
        out.share_above_horizon_full_cdf += n.share_above_horizon_full_cdf;
        out.least_share_above_horizon = std::min(out.least_share_above_horizon, n.share_above_horizon);
        out.least_share_above_horizon_full_cdf =
            std::min(out.least_share_above_horizon_full_cdf, n.share_above_horizon_full_cdf);
        out.max_weight = std::max(out.max_weight, n.max_weight);
        out.support_violations += n.support_violations;
        out.combined = out.combined || n.combined;
    }
    out.lit_normals = static_cast<std::uint32_t>(variances.size());
    if (variances.empty()) return {};
    for (double* mean : {&out.relative_variance, &out.relative_variance_full_cdf, &out.share_above_horizon,
                         &out.share_above_horizon_full_cdf})
        *mean /= out.lit_normals;
    std::sort(variances.begin(), variances.end());
    out.median = variances[variances.size() / 2];
    out.worst = variances.back();
    return out;
}

std::vector<Normal> random_normals(std::uint32_t count) {
    std::mt19937_64 engine(20051); // the standard's own distributions differ from library to library
    const auto uniform = [&] { return double(engine() >> 11) * 0x1p-53; };
    std::vector<Normal> out;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double z = 1.0 - 2.0 * uniform(), r = std::sqrt((1.0 - z) * (1.0 + z));
        double s, c;
        acdf_sincospi(2.0 * uniform() - 1.0, &s, &c);
        out.push_back({static_cast<float>(r * c), static_cast<float>(r * s), static_cast<float>(z)});
    }
    return out;
}

std::vector<Normal> test_normals(const std::vector<compress::SceneNormal>& scene, std::uint32_t count) {
    if (scene.empty()) return random_normals(count);
    double sum = 0.0;
    std::vector<double> upto;
    for (const compress::SceneNormal& n : scene) upto.push_back(sum += n.weight);
    std::vector<Normal> out;
    for (std::uint32_t i = 0; i < count; ++i) { // even steps: the scene's own frequencies
        const double at = sum * (i + 0.5) / count;
        const auto found = std::upper_bound(upto.begin(), upto.end() - 1, at);
        out.push_back(scene[static_cast<std::size_t>(found - upto.begin())].normal);
    }
    return out;
}

} // namespace acdf::build
