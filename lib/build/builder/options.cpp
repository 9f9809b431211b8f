#include "build/builder/options.h"

#include "build/builder/sources.h"
#include "build/errors.h"
#include "build/own_terms.h"
#include "build/text/options.h"

#include <algorithm>
#include <optional>

namespace acdf::builder {
namespace {

/// `automatic`: the budget where no goal is given.
compress::Goal internal(const Goal& goal, std::uint64_t automatic) {
    switch (goal.kind) {
    case Goal::Kind::cells:
        return {compress::Goal::Kind::cells, goal.cells, 0, 0.0};
    case Goal::Kind::variance:
        return {compress::Goal::Kind::variance, 0, 0, goal.variance};
    default:
        return {compress::Goal::Kind::budget, 0, goal.kind == Goal::Kind::budget ? goal.budget : automatic, 0.0};
    }
}

compress::ChannelWeights internal(const ChannelWeights& weights) { return {weights.r, weights.g, weights.b}; }

std::optional<compress::Order> internal(Order order) {
    if (order == Order::best) return {};
    return order == Order::phi ? compress::Order::phi : compress::Order::z;
}

compress::FitOptions internal(const FitOptions& options) {
    compress::FitOptions out;
    out.fit = options.fit;
    out.order = internal(options.order);
    out.max_weight = options.max_weight;
    out.column_segments = options.phi_segments;
    out.row_segments = options.theta_segments;
    out.epsilon = options.epsilon;
    out.gradient_knots = options.gradient_knots;
    out.conditional =
        options.conditional == Conditional::mean ? compress::Conditional::mean : compress::Conditional::energy;
    return out;
}

compress::Partner internal(const Partner& partner) {
    return {partner.kind, partner.heuristic, partner.light, partner.other};
}

std::vector<compress::SceneNormal> internal(const std::vector<SceneNormal>& normals) {
    std::vector<compress::SceneNormal> out;
    for (const SceneNormal& n : normals) out.push_back({{n.normal[0], n.normal[1], n.normal[2]}, n.weight});
    return out;
}

template <class Options>
std::string text_of(const Options& options) noexcept {
    try {
        return build::option_text(options.source.reading + wrap_text(repeats(options.target)), internal(options));
    } catch (...) {
        return {};
    }
}

} // namespace

bool repeats(const TargetOptions& options) {
    return options.wrap == Wrap::repeat && options.filter == ACDF_FILTER_BILINEAR;
}

std::string wrap_text(bool repeats) { return repeats ? "--wrap repeat " : ""; }

compress::TargetOptions internal(const TargetOptions& options) {
    return {internal(options.channels.weights), options.channels.mode, options.filter};
}

build::EnvironmentOptions internal(const EnvironmentOptions& options) {
    build::EnvironmentOptions out;
    out.target = internal(options.target);
    out.fit = internal(options.fit);
    out.fit.goal = internal(options.goal, DefaultBudget::environment);
    out.codec = options.codec;
    out.mis = internal(options.mis);
    out.scene = internal(options.normals);
    out.scene_text = options.normals_text;
    return out;
}

bool mirrors(const float transform[3][4]) {
    double determinant = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
        determinant +=
            double{transform[0][k]} * (double{transform[1][(k + 1) % 3]} * double{transform[2][(k + 2) % 3]} -
                                       double{transform[1][(k + 2) % 3]} * double{transform[2][(k + 1) % 3]});
    return determinant < 0.0;
}

namespace {

/// A callback of the caller's, whose exceptions are distinguished from others.
template <class Call>
bool called(const Call& call) {
    try {
        return call();
    } catch (...) {
        throw build::CallbackFailed();
    }
}

VisibilityPoint external(const compress::VisibilityPoint& point) {
    VisibilityPoint out;
    std::copy_n(point.position.begin(), 3, out.position);
    std::copy_n(point.normal.begin(), 3, out.normal);
    return out;
}

/// Among the cells. Where the transform mirrors, the sides change visibility, so that light comes from where it
/// did.
compress::PortalRectangle internal(const Portal& portal, const float transform[3][4]) {
    compress::PortalRectangle out;
    for (std::size_t k = 0; k < 3; ++k) {
        const float* t = transform[k];
        const auto turned = [t](const float v[3]) {
            return double{t[0]} * double{v[0]} + double{t[1]} * double{v[1]} + double{t[2]} * double{v[2]};
        };
        out.corner[k] = turned(portal.corner) + double{t[3]};
        out.across[k] = turned(portal.across);
        out.up[k] = turned(portal.up);
    }
    if (mirrors(transform)) std::swap(out.across, out.up);
    return out;
}

build::SceneVisibility internal(const Visibility& visibility) {
    build::SceneVisibility out;
    if (!visibility.point) return out;
    out.scene.points = [point = visibility.point](std::uint64_t index, compress::VisibilityPoint& result) {
        VisibilityPoint told;
        if (!called([&] { return point(index, told); })) return false;
        std::copy_n(told.position, 3, result.position.begin());
        std::copy_n(told.normal, 3, result.normal.begin());
        return true;
    };
    out.scene.occluded = [occluded = visibility.occluded](const compress::VisibilityPoint& point,
                                                          const std::array<float, 3>& direction) {
        const VisibilityPoint told = external(point);
        return called([&] { return occluded(told, direction.data()); });
    };
    out.beside_cosine = visibility.beside_cosine;
    for (int k = 0; k < 3; ++k) std::copy_n(visibility.transform[k], 4, out.frame.transform[k]);
    for (const Portal& portal : visibility.portals) out.portals.push_back(internal(portal, visibility.transform));
    return out;
}

} // namespace

build::LocalOptions internal(const LocalOptions& options) {
    build::LocalOptions out;
    out.target = internal(options.target);
    out.goal = internal(options.goal, options.visibility.point ? DefaultBudget::visibility : DefaultBudget::local);
    out.subdivisions = options.subdivisions;
    out.columns = options.columns;
    out.rows = options.rows;
    out.tiles = options.tiles;
    out.max_weight = options.max_weight;
    out.scene = internal(options.normals);
    out.mis = internal(options.mis);
    out.sharing = options.sharing;
    out.bin_target =
        options.bin_target == BinTarget::centre ? compress::BinTarget::centre : compress::BinTarget::mean;
    out.fit = internal(options.fit);
    // Bins have a size that all orders share: the paper's.
    if (!out.sharing && !out.fit.order) out.fit.order = compress::Order::z;
    out.cosine_share = options.cosine_share;
    out.scene_text = options.normals_text;
    out.visibility = internal(options.visibility);
    out.codec = options.codec;
    return out;
}

build::BrdfFileOptions internal(const BrdfOptions& options) {
    build::BrdfFileOptions out;
    out.fit.fit = options.fit;
    out.fit.goal = internal(options.goal, DefaultBudget::brdf);
    out.fit.theta_views = options.theta_views;
    out.fit.phi_views = options.phi_views;
    out.fit.theta_segments = options.theta_segments;
    out.fit.phi_segments = options.phi_segments;
    out.fit.epsilon = options.epsilon;
    out.max_weight = options.max_weight;
    out.channels = options.channels.mode;
    out.weights = internal(options.channels.weights);
    out.diffuse_share = options.diffuse_share;
    out.codec = options.codec;
    return out;
}

build::IndexedOptions internal(const IndexedOptions& options) {
    build::IndexedOptions out;
    out.target = internal(options.target);
    out.budget = internal(options.goal, DefaultBudget::environment).budget;
    out.codec = options.codec;
    out.axes = options.axes;
    out.sun = options.sun;
    out.suns = options.suns;
    out.reading = options.source.reading + wrap_text(repeats(options.target));
    return out;
}

build::TableOptions internal(const TableOptions& options, std::uint64_t bins) {
    build::TableOptions out;
    out.indexed = options.indexed;
    out.names = options.names;
    out.ranges = options.ranges;
    if (options.goal.kind == Goal::Kind::cells) out.cells = options.goal.cells;
    out.goal = internal(options.goal, DefaultBudget::table(bins));
    out.max_weight = options.max_weight;
    out.mis = internal(options.mis);
    out.other_name = options.other_source.name;
    out.other_sha256 = options.other_source.sha256;
    out.codec = options.codec;
    return out;
}

namespace {

template <class Options>
std::string own_text_of(const Options& options) noexcept {
    try {
        return build::option_text(internal(options));
    } catch (...) {
        return {};
    }
}

} // namespace

std::string option_text(const EnvironmentOptions& options) noexcept { return text_of(options); }
std::string option_text(const LocalOptions& options) noexcept { return text_of(options); }
std::string option_text(const BrdfOptions& options) noexcept { return own_text_of(options); }
std::string option_text(const IndexedOptions& options) noexcept { return own_text_of(options); }

} // namespace acdf::builder
