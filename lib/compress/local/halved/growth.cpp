#include "compress/local/halved/growth.h"

#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kCoarse = 4;     // subdivisions of an octahedron, whose corners stand for all normals
constexpr std::size_t kMostNormals = 66; // that many
constexpr float kLeastWorth = 0.1f;      // of the largest

} // namespace

SomeNormals few_normals(const NormalBins& bins) {
    SomeNormals out;
    NormalBins coarse;
    const NormalBins* of = &bins;
    if (bins.stored() > kMostNormals) {
        std::vector<SceneNormal> all;
        for (std::size_t b = 0; b < bins.normals.size(); ++b) {
            const Direction& n = bins.normals[b];
            if (bins.weight[b] > 0.0)
                all.push_back({{static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])},
                               bins.weight[b]});
        }
        coarse = octahedral_bins(kCoarse);
        weigh(coarse, all);
        of = &coarse;
    }
    for (std::size_t b = 0; b < of->normals.size(); ++b) {
        if (!(of->weight[b] > 0.0)) continue;
        out.normals.add(of->normals[b]);
        out.weights.push_back(of->weight[b]);
    }
    return out;
}

void weigh_by_light(const Blocks& blocks, const BlockMoments& light, SomeNormals& normals) {
    std::vector<std::vector<double>> of_row(blocks.rows(), std::vector<double>(normals.weights.size()));
    parallel_for(std::uint32_t{0}, blocks.rows(), [&](std::uint32_t r) {
        std::vector<float> seen(normals.weights.size());
        for (std::uint32_t c = 0; c < blocks.columns(); ++c) {
            const HalvedBox box{blocks.rows() + r, blocks.columns() + c};
            light.seen(box, normals.normals, seen.data());
            for (std::size_t i = 0; i < seen.size(); ++i)
                of_row[r][i] += std::sqrt(double{light[box].sum} * double{seen[i]});
        }
    });
    double lit = 0.0;
    std::vector<double> least(normals.weights.size());
    for (std::size_t i = 0; i < least.size(); ++i) {
        for (const std::vector<double>& row : of_row) least[i] += row[i];
        if (least[i] > 0.0) lit += normals.weights[i];
    }
    for (std::size_t i = 0; i < least.size(); ++i)
        normals.weights[i] = least[i] > 0.0 ? normals.weights[i] / (lit * least[i]) : 0.0;
}

TopCosts::TopCosts(const Blocks& blocks, const BlockMoments& light, std::vector<LitNormals> normals)
    : HalvedCosts(blocks.axes()), blocks_(blocks), light_(light), normals_(std::move(normals)),
      known_(blocks.size()) {
    for (std::atomic<float>& known : known_) known.store(-1.0f, std::memory_order_relaxed);
    std::vector<double> of_row(blocks.rows());
    parallel_for(std::uint32_t{0}, blocks.rows(), [&](std::uint32_t r) {
        for (std::uint32_t c = 0; c < blocks.columns(); ++c)
            of_row[r] += double{cost({blocks.rows() + r, blocks.columns() + c})};
    });
    for (const double row : of_row) least_ += row;
}

double TopCosts::root_sum(HalvedBox box) const {
    thread_local std::vector<float> seen;
    double sum = 0.0;
    for (const LitNormals& of : normals_) {
        seen.resize(of.normals.weights.size());
        of.light->seen(box, of.normals.normals, seen.data());
        for (std::size_t i = 0; i < seen.size(); ++i) sum += of.normals.weights[i] * double{std::sqrt(seen[i])};
    }
    return sum;
}

float TopCosts::cost(HalvedBox box) const {
    std::atomic<float>& known = known_[blocks_.index(box)];
    if (const float cost = known.load(std::memory_order_relaxed); cost >= 0.0f) return cost;
    const double light = double{light_[box].sum};
    const auto cost = static_cast<float>(light > 0.0 ? std::sqrt(light) * root_sum(box) : 0.0);
    known.store(cost, std::memory_order_relaxed); // the same whichever thread is first
    return cost;
}

std::vector<float> worth_of_blocks(const Blocks& blocks, const SomeNormals& of) {
    std::vector<float> out(blocks.size(), 0.0f);
    parallel_for(blocks.rows(), 2 * blocks.rows(), [&](std::uint32_t r) {
        for (std::uint32_t c = blocks.columns(); c < 2 * blocks.columns(); ++c) {
            const Direction d = blocks.middle({r, c});
            double sum = 0.0;
            for (std::size_t i = 0; i < of.weights.size(); ++i) {
                const Direction n = {double{of.normals.x[i]}, double{of.normals.y[i]}, double{of.normals.z[i]}};
                sum += of.weights[i] * std::max(0.0, dot(d, n));
            }
            out[blocks.index({r, c})] = static_cast<float>(sum);
        }
    });
    const float largest = *std::max_element(out.begin(), out.end());
    const float least = largest > 0.0f ? kLeastWorth * largest : 1.0f;
    for (float& worth : out) worth = std::max(worth, least);
    return out;
}

std::vector<std::uint32_t> blocks_of_texels(const std::vector<double>& borders) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t block = 0; double(out.size()) < borders.back();) {
        if (borders[block + 1] > double(out.size()) + 0.5) out.push_back(block);
        else ++block;
    }
    return out;
}

SharedLight::SharedLight(const Blocks& blocks, std::vector<float> worth, double unit)
    : blocks_(blocks), worth_(std::move(worth)) {
    const Target& grid = blocks.grid();
    const std::vector<std::uint32_t> row = blocks_of_texels(blocks.borders(0)),
                                     column = blocks_of_texels(blocks.borders(1));
    values_.resize(grid.values.size());
    std::vector<double> sums(grid.rows);
    parallel_for(std::uint32_t{0}, grid.rows, [&](std::uint32_t r) {
        const float* of_row = worth_.data() + blocks.index({blocks.rows() + row[r], blocks.columns()});
        for (std::uint32_t c = 0; c < grid.columns; ++c) {
            float& value = values_[std::size_t{r} * grid.columns + c];
            value = relative_light(grid.row(r)[c], unit * double{of_row[column[c]]});
            sums[r] += double{value} * grid.column_measure[c];
        }
    });
    Grid of = grid_of(grid);
    of.values = values_.data();
    of.peaks = of.left = of.least = nullptr;
    costs_ = std::make_unique<HalvedSums>(of);
    costs_->set_mean(std::inner_product(sums.begin(), sums.end(), grid.row_measure.begin(), 0.0));
}

} // namespace acdf::compress
