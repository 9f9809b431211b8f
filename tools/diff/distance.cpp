#include "tools/diff/distance.h"

#include "build/text/format_names.h"
#include "measure/sequences.h"
#include "visibility/visible_view.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace acdf::tools {
namespace {

constexpr std::uint32_t kNormals = 64, kViews = 32, kBins = 64;
constexpr std::uint32_t kSamplesAlone = 65536, kSamplesEach = 2048; // for one condition, and for each of several

/// Collects what samples of both files see of both pdfs, at one condition.
class Meeting {
public:
    explicit Meeting(Distance& distance) : distance_(distance) {}

    /// p and q at a sample of either.
    void take(double p, double q) {
        if (!(p > 0.0) && !(q > 0.0)) return;
        sum_ += std::abs(p - q) / (p + q);
        ++count_;
        const double low = std::min(p, q), high = std::max(p, q);
        distance_.largest_ratio =
            std::max(distance_.largest_ratio, low > 0.0 ? high / low : std::numeric_limits<double>::infinity());
    }

    /// `empty`: of how many of the two nothing is sampled here.
    void end(int empty) {
        const double share = empty == 1 ? 1.0 : count_ > 0 ? sum_ / double(count_) : 0.0;
        ++distance_.conditions;
        distance_.mean += (share - distance_.mean) / double(distance_.conditions);
        distance_.worst = std::max(distance_.worst, share);
    }

private:
    Distance& distance_;
    double sum_ = 0.0;
    std::size_t count_ = 0;
};

/// Samples `samples` from each of two, (p + q) / 2 in all, and compares. `sample(which, u, x)` is false where
/// nothing is sampled, `pdf(which, x)` a pdf; x are `Point`s.
template <class Point, class Sample, class Pdf>
void meet(Distance& distance, std::uint32_t samples, std::uint32_t dimensions, const Sample& sample,
          const Pdf& pdf) {
    Meeting meeting(distance);
    int empty = 0;
    for (const int which : {0, 1}) {
        std::mt19937_64 random(2005); // of more dimensions than two
        bool any = false;
        for (std::uint32_t i = 0; i < samples; ++i) {
            std::array<double, ACDF_MAX_AXES> u{};
            if (dimensions == 2) {
                const std::array<std::uint32_t, 2> point = measure::sobol_point(i);
                for (std::size_t k = 0; k < 2; ++k) u[k] = point[k] * 0x1p-32;
            } else {
                for (std::uint32_t k = 0; k < dimensions; ++k) u[k] = static_cast<double>(random() >> 11) * 0x1p-53;
            }
            Point x{};
            if (!sample(which, u.data(), x)) continue;
            any = true;
            meeting.take(pdf(0, x), pdf(1, x));
        }
        empty += !any;
    }
    meeting.end(empty);
}

using Direction = std::array<float, 3>;

/// Direction `i` of `count`, evenly over the sphere from `least` height up: Fibonacci's spiral.
Direction spread(std::uint32_t i, std::uint32_t count, double least) {
    const double z = 1.0 - (1.0 - least) * (i + 0.5) / count, r = std::sqrt(std::max(0.0, 1.0 - z * z));
    double sine, cosine;
    acdf_sincospi(2.0 * std::fmod(0.618033988749895 * i, 1.0), &sine, &cosine);
    return {static_cast<float>(r * cosine), static_cast<float>(r * sine), static_cast<float>(z)};
}

double relative(double a, double b) {
    const double high = std::max(std::abs(a), std::abs(b));
    return high > 0.0 ? std::abs(a - b) / high : 0.0;
}

bool is_drawn(const DirectionSample& s, Direction& x) {
    std::copy_n(s.direction, 3, x.begin());
    return s.pdf > 0.0f;
}

Distance of_environments(const EnvironmentView (&view)[2], std::uint32_t samples) {
    Distance out;
    meet<Direction>(
        out, samples, 2,
        [&](int which, const double* u, Direction& x) { return is_drawn(view[which].sample(u[0], u[1]), x); },
        [&](int which, const Direction& x) { return double{view[which].pdf(x.data())}; });
    return out;
}

Distance of_locals(const LocalEnvironmentView (&view)[2], std::uint32_t samples) {
    Distance out;
    for (std::uint32_t i = 0; i < kNormals; ++i) {
        const Direction n = spread(i, kNormals, -1.0);
        const AcdfLocalPoint at[2] = {view[0].at(n.data()), view[1].at(n.data())};
        meet<Direction>(
            out, samples, 2,
            [&](int which, const double* u, Direction& x) {
                return at[which].what != ACDF_LOCAL_NOTHING &&
                       is_drawn(view[which].sample(at[which], u[0], u[1]), x);
            },
            [&](int which, const Direction& x) {
                return at[which].what == ACDF_LOCAL_NOTHING ? 0.0 : double{view[which].pdf(at[which], x.data())};
            });
    }
    return out;
}

Distance of_brdfs(const BrdfView (&view)[2], std::uint32_t samples) {
    Distance out;
    for (std::uint32_t i = 0; i < kViews; ++i) {
        const Direction wo = spread(i, kViews, 0.05);
        const bool reflects[2] = {view[0].albedo(wo.data()) > 0.0, view[1].albedo(wo.data()) > 0.0};
        meet<Direction>(
            out, samples, 2,
            [&](int which, const double* u, Direction& x) {
                return reflects[which] && is_drawn(view[which].sample(wo.data(), u[0], u[1]), x);
            },
            [&](int which, const Direction& x) {
                return reflects[which] ? double{view[which].pdf(wo.data(), x.data())} : 0.0;
            });
        out.total = std::max(out.total, relative(view[0].albedo(wo.data()), view[1].albedo(wo.data())));
    }
    return out;
}

/// Up to kBins of the bins of a table, spread over all of them.
std::vector<std::vector<std::uint32_t>> some_bins(const TableView& view) {
    std::uint64_t count = 1;
    for (std::uint32_t axis = 0; axis < view.indexed_count(); ++axis) count *= view.data().axes[axis].resolution;
    const std::uint64_t chosen = std::min<std::uint64_t>(count, kBins);
    std::vector<std::vector<std::uint32_t>> out;
    for (std::uint64_t i = 0; i < chosen; ++i) {
        std::uint64_t bin = count / chosen * i;
        std::vector<std::uint32_t> index(view.indexed_count() + 1); // a table without has one bin
        for (std::uint32_t axis = view.indexed_count(); axis-- > 0;) {
            index[axis] = static_cast<std::uint32_t>(bin % view.data().axes[axis].resolution);
            bin /= view.data().axes[axis].resolution;
        }
        out.push_back(std::move(index));
    }
    return out;
}

Distance of_tables(const TableView (&view)[2], std::uint32_t samples) {
    using Point = std::array<double, ACDF_MAX_AXES>;
    Distance out;
    for (const std::vector<std::uint32_t>& bin : some_bins(view[0])) {
        const double share[2] = {view[0].share(bin.data()), view[1].share(bin.data())};
        meet<Point>(
            out, samples, view[0].sampled_count(),
            [&](int which, const double* u, Point& x) {
                return share[which] > 0.0 && view[which].sample(bin.data(), u, x.data()) > 0.0;
            },
            [&](int which, const Point& x) {
                return share[which] > 0.0 ? view[which].pdf(bin.data(), x.data()) : 0.0;
            });
    }
    return out;
}

} // namespace

std::string why_not_compared(const File& a, const File& b) {
    if (a.kind() != b.kind())
        return "one is of kind " + build::kind_name(a.kind()) + ", the other of kind " + build::kind_name(b.kind());
    if (a.kind() == ACDF_KIND_LOCAL && (visible_view(a).has_cells() || visible_view(b).has_cells()))
        return "files that store visibility cells are compared by their bytes alone";
    if (a.kind() == ACDF_KIND_INDEXED) return "files of several maps are compared by their bytes alone";
    if (a.kind() != ACDF_KIND_TABLE) return "";
    const TableView view[2] = {a.table(), b.table()};
    bool same =
        view[0].indexed_count() == view[1].indexed_count() && view[0].sampled_count() == view[1].sampled_count();
    for (std::uint32_t axis = 0; same && axis < view[0].indexed_count(); ++axis)
        same = view[0].data().axes[axis].resolution == view[1].data().axes[axis].resolution;
    return same ? "" : "their axes differ";
}

Distance distance(const File& a, const File& b, std::uint32_t samples) {
    Distance out;
    if (samples == 0) samples = a.kind() == ACDF_KIND_ENVIRONMENT ? kSamplesAlone : kSamplesEach;
    switch (a.kind()) {
    case ACDF_KIND_LOCAL:
        out = of_locals({a.local(), b.local()}, samples);
        break;
    case ACDF_KIND_BRDF:
        return of_brdfs({a.brdf(), b.brdf()}, samples); // its totals are those of views
    case ACDF_KIND_TABLE:
        out = of_tables({a.table(), b.table()}, samples);
        break;
    default:
        out = of_environments({a.environment(), b.environment()}, samples);
    }
    out.total = relative(a.description().total, b.description().total);
    return out;
}

} // namespace acdf::tools
