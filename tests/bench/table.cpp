// Time of samples and pdfs of table files, beside the full conditional CDFs and an alias table of the same
// numbers in floats. Writes tables in Markdown.
#include "tests/bench/turns.h"

#include "measure/samplers/alias_choices.h"

#include <acdf/builder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace {

using acdf_bench::Candidate;
using acdf_bench::keep;

constexpr std::size_t kPoints = std::size_t{1} << 18; // before they repeat
constexpr std::uint64_t kBudget = 64 << 10;

/// A smooth array with noise and a narrow peak, of as many axes as sides.
std::vector<float> numbers(const std::vector<std::uint32_t>& sides) {
    std::size_t count = 1;
    for (const std::uint32_t side : sides) count *= side;
    std::vector<float> out(count);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < count; ++i) {
        double value = 1.0, from_peak = 0.0;
        for (std::size_t axis = sides.size(), rest = i; axis-- > 0; rest /= sides[axis]) {
            const double x = (static_cast<double>(rest % sides[axis]) + 0.5) / sides[axis];
            value *= 1.2 + std::sin(5.0 * x + 2.0 * static_cast<double>(axis));
            from_peak = std::hypot(from_peak, x - 0.3);
        }
        const double noise = 0.8 + 0.4 * static_cast<double>(random() % 1000) / 1000.0;
        out[i] = static_cast<float>(noise * (from_peak < 0.02 ? 500.0 : value));
    }
    return out;
}

/// Cumulative sums along the last axis, of their totals along the one before, and so on, all in floats: one search
/// an axis samples, one load gives a pdf. Points are in units of cells.
class FullTable {
public:
    FullTable(const std::vector<float>& values, std::vector<std::uint32_t> sides)
        : sides_(std::move(sides)), sums_(sides_.size()), pdf_(values) {
        std::vector<double> mass(values.begin(), values.end());
        for (std::size_t axis = sides_.size(); axis-- > 0;) {
            const std::size_t side = sides_[axis], lines = mass.size() / side;
            std::vector<double> total(lines);
            sums_[axis].resize(lines * (side + 1));
            for (std::size_t line = 0; line < lines; ++line) {
                const double* const from = &mass[line * side];
                total[line] = std::accumulate(from, from + side, 0.0);
                double sum = 0.0;
                for (std::size_t i = 0; i <= side; sum += i < side ? from[i] : 0.0, ++i)
                    sums_[axis][line * (side + 1) + i] = static_cast<float>(sum / total[line]);
            }
            mass = std::move(total);
        }
        for (float& value : pdf_) value = static_cast<float>(value / mass[0]);
    }

    float sample(const float* u, float* x) const {
        std::size_t line = 0;
        for (std::size_t axis = 0; axis < sides_.size(); ++axis) {
            const std::size_t side = sides_[axis];
            const float* const sums = &sums_[axis][line * (side + 1)];
            const auto above = static_cast<std::size_t>(std::upper_bound(sums, sums + side + 1, u[axis]) - sums);
            const std::size_t i = std::min(above, side) - 1;
            x[axis] = static_cast<float>(i) + (u[axis] - sums[i]) / (sums[i + 1] - sums[i]);
            line = line * side + i;
        }
        return pdf_[line];
    }
    float pdf(const float* x) const {
        std::size_t cell = 0;
        for (std::size_t axis = 0; axis < sides_.size(); ++axis)
            cell = cell * sides_[axis] + static_cast<std::size_t>(x[axis]);
        return pdf_[cell];
    }

private:
    std::vector<std::uint32_t> sides_;
    std::vector<std::vector<float>> sums_; ///< of each axis, a line of all indices before it
    std::vector<float> pdf_;
};

/// Cells by the alias method, where in a cell by the other numbers.
class AliasCells {
public:
    AliasCells(const std::vector<float>& values, std::vector<std::uint32_t> sides)
        : sides_(std::move(sides)), entries_(values.size()) {
        const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
        std::vector<double> share(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) share[i] = values[i] / mean;
        const std::vector<acdf::measure::AliasChoice> choices = acdf::measure::alias_choices(share);
        for (std::size_t i = 0; i < values.size(); ++i)
            entries_[i] = {choices[i].keep, choices[i].alias,
                           static_cast<float>(share[i] / static_cast<double>(values.size()))};
    }

    float sample(const float* u, float* x) const {
        const float at = u[0] * static_cast<float>(entries_.size()); // enough numbers for a million cells
        const auto sampled = std::min(static_cast<std::size_t>(at), entries_.size() - 1);
        std::size_t cell = u[1] < entries_[sampled].keep ? sampled : entries_[sampled].alias;
        const float pdf = entries_[cell].pdf;
        for (std::size_t axis = sides_.size(); axis-- > 0; cell /= sides_[axis])
            x[axis] = static_cast<float>(cell % sides_[axis]) + u[axis];
        return pdf;
    }
    float pdf(const float* x) const {
        std::size_t cell = 0;
        for (std::size_t axis = 0; axis < sides_.size(); ++axis)
            cell = cell * sides_[axis] + static_cast<std::size_t>(x[axis]);
        return entries_[cell].pdf;
    }

private:
    struct Entry {
        float keep;
        std::uint32_t alias;
        float pdf;
    };
    std::vector<std::uint32_t> sides_;
    std::vector<Entry> entries_;
};

/// Numbers and points, of up to three axes, as doubles and as floats.
struct Asked {
    std::vector<std::array<double, 3>> wide{kPoints};
    std::vector<std::array<float, 3>> narrow{kPoints};

    /// `sides`: of points; null: of numbers, which have 24 bits as those of renderers.
    Asked(const std::vector<std::uint32_t>* sides, unsigned seed) {
        std::mt19937_64 random(seed);
        for (std::size_t i = 0; i < kPoints; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float u = static_cast<float>(random() >> 40) * 0x1p-24f;
                const float side = sides && axis < sides->size() ? static_cast<float>((*sides)[axis]) : 1.0f;
                narrow[i][axis] = std::min(u * side, side * (1.0f - 0x1p-24f));
                wide[i][axis] = double{narrow[i][axis]};
            }
    }
};

template <class Baseline>
Candidate draws(const Baseline& baseline, const Asked& u) {
    return {"", [&](std::size_t first, std::size_t count) {
                float x[3];
                for (std::size_t i = first; i < first + count; ++i) {
                    keep(baseline.sample(u.narrow[i].data(), x));
                    keep(x);
                }
            }};
}
template <class Baseline>
Candidate densities(const Baseline& baseline, const Asked& x) {
    return {"", [&](std::size_t first, std::size_t count) {
                for (std::size_t i = first; i < first + count; ++i) keep(baseline.pdf(x.narrow[i].data()));
            }};
}

void report(const char* what, std::vector<Candidate> rows, bool evicted) {
    acdf_bench::Turns turns;
    if (evicted) turns = {20, 1024, kPoints, true};
    acdf_bench::take_turns(rows, turns);
    std::printf("| %s |", what);
    for (const Candidate& row : rows) std::printf(" %.1f (%.2f) |", row.least, row.least / rows[0].least);
    std::puts("");
    std::fflush(stdout);
}

bool run(const std::vector<std::uint32_t>& sides) {
    const std::vector<float> values = numbers(sides);
    acdf::builder::Array array;
    array.data = values.data();
    array.shape = sides;
    acdf::builder::TableOptions options;
    options.goal = acdf::builder::Goal::of_budget(kBudget);
    acdf::builder::Table made;
    const acdf::builder::Status status = acdf::builder::table(array, options, made);
    acdf::File file;
    if (!status.ok() || !acdf::File::from_memory(made.bytes.data(), made.bytes.size(), file).ok()) {
        std::fprintf(stderr, "bench_table: %s\n", status.message);
        return false;
    }
    const acdf::TableView view = file.table();
    const FullTable full(values, sides);
    const AliasCells alias(values, sides);
    const Asked u(nullptr, 2), anywhere(&sides, 3);
    Asked sampled(nullptr, 4);
    for (std::size_t i = 0; i < kPoints; ++i) {
        view.sample(nullptr, u.wide[i].data(), sampled.wide[i].data());
        for (std::size_t axis = 0; axis < sides.size(); ++axis)
            sampled.narrow[i][axis] = std::min(static_cast<float>(sampled.wide[i][axis]),
                                               static_cast<float>(sides[axis]) * (1.0f - 0x1p-24f));
    }
    const auto ours_samples = [&u](const acdf::TableView& of) -> Candidate {
        return {"", [&](std::size_t first, std::size_t count) {
                    double x[3];
                    for (std::size_t i = first; i < first + count; ++i) {
                        keep(of.sample(nullptr, u.wide[i].data(), x));
                        keep(x);
                    }
                }};
    };
    const auto ours = [](const acdf::TableView& of, const Asked& x) -> Candidate {
        return {"", [&](std::size_t first, std::size_t count) {
                    for (std::size_t i = first; i < first + count; ++i) keep(of.pdf(nullptr, x.wide[i].data()));
                }};
    };
    std::string shape;
    for (const std::uint32_t side : sides) shape += (shape.empty() ? "" : " x ") + std::to_string(side);
    std::printf("\n%s numbers; a file of %zu bytes with tables of %llu, %.4g relative variance; full table "
                "%zu\n\n| ns a call (of the full "
                "table's) | full table | alias table | file |\n|---|---|---|---|\n",
                shape.c_str(), made.bytes.size(), static_cast<unsigned long long>(file.table_bytes()),
                made.accuracy.relative_variance, 2 * 4 * values.size());
    for (const bool evicted : {false, true}) {
        report(evicted ? "sample, caches evicted" : "sample", {draws(full, u), draws(alias, u), ours_samples(view)},
               evicted);
        report(evicted ? "pdf of uniform points, caches evicted" : "pdf of uniform points",
               {densities(full, anywhere), densities(alias, anywhere), ours(view, anywhere)}, evicted);
    }
    report("pdf of sampled points", {densities(full, sampled), densities(alias, sampled), ours(view, sampled)},
           false);
    return true;
}

} // namespace

int main() { return run({1024, 1024}) && run({96, 96, 96}) ? 0 : 1; }
