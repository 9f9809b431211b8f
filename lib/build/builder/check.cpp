// What options may be, so that nothing behind has to ask.
#include "build/builder/guard.h"
#include "build/builder/options.h"
#include "reader/utf8.h"

#include <cmath>
#include <string>

namespace acdf::builder {
namespace {

bool is_share(double value, double most) { return value >= 0.0 && value <= most; }

bool is_fit(AcdfFit fit) { return fit >= ACDF_FIT_UNIFORM && fit <= ACDF_FIT_VARIANCE; }

void check(const Channels& channels) {
    const AcdfChannels mode = channels.mode;
    require(mode == ACDF_CHANNELS_WEIGHTED || mode == ACDF_CHANNELS_SEPARATE || mode == ACDF_CHANNELS_LARGEST,
            "channels.mode is not an AcdfChannels");
    const ChannelWeights& w = channels.weights;
    for (const double weight : {w.r, w.g, w.b})
        require(weight >= 0.0 && weight <= 1e6, "a weight of channels is negative, not finite or above 1e6");
    require(w.r + w.g + w.b >= 1e-6, "the weights of all channels are 0");
    require(mode == ACDF_CHANNELS_WEIGHTED || (w.r == 1.0 && w.g == 1.0 && w.b == 1.0),
            "channels that count separately, or by the largest, have weights 1, 1, 1");
}

void check(AcdfCodec codec) {
    require(codec == ACDF_CODEC_NONE || codec == ACDF_CODEC_ZLIB || codec == ACDF_CODEC_PLANES,
            "codec is not an AcdfCodec");
}

void check(const Goal& goal, std::uint32_t least_cells) {
    using Kind = Goal::Kind;
    require(goal.kind >= Kind::automatic && goal.kind <= Kind::variance, "goal.kind is not a Goal::Kind");
    require(goal.kind != Kind::cells || (goal.cells >= least_cells && goal.cells <= 1u << 28),
            "goal.cells is too small, or above 2^28");
    require(goal.kind != Kind::budget || (goal.budget > 0 && goal.budget <= std::uint64_t{1} << 40),
            "goal.budget is 0, or above 2^40 bytes");
    require(goal.kind != Kind::variance || (goal.variance > 0.0 && std::isfinite(goal.variance)),
            "goal.variance is not a positive, finite number");
}

bool is_text(const std::string& text, std::size_t most) {
    return text.size() <= most && is_utf8(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

void check_text(const std::string& text) {
    require(is_text(text, 4096), "a text for the metadata is not UTF-8 or too long");
}

void check(const Source& source) {
    for (const std::string* text : {&source.name, &source.sha256, &source.projection, &source.reading})
        check_text(*text);
}

void check_max_weight(double bound) {
    require(bound == 0.0 || (bound >= 1.0 && bound <= 1e30), "max_weight is neither 0 nor in [1, 1e30]");
}

void check_segments(std::uint32_t phi, std::uint32_t theta, double epsilon) {
    for (const std::uint32_t count : {phi, theta})
        require(count >= 1 && count <= ACDF_MAX_SEGMENTS, "the segments of a curve are 0, or above 2^20 - 1");
    require(is_share(epsilon, 1.0), "epsilon is not in [0, 1]");
}

void check(const FitOptions& fit) {
    require(is_fit(fit.fit), "fit is not an AcdfFit");
    require(fit.order == Order::best || fit.order == Order::phi || fit.order == Order::z, "order is not an Order");
    require(fit.conditional == Conditional::energy || fit.conditional == Conditional::mean,
            "conditional is not a Conditional");
    check_max_weight(fit.max_weight);
    check_segments(fit.phi_segments, fit.theta_segments, fit.epsilon);
    require(fit.gradient_knots <= 1u << 20, "gradient_knots is above 2^20");
    const bool variance = fit.fit == ACDF_FIT_VARIANCE;
    require(variance || fit.max_weight == 0.0, "max_weight is for the variance fit");
}

void check(const SceneNormal& n) {
    const double square = double{n.normal[0]} * double{n.normal[0]} + double{n.normal[1]} * double{n.normal[1]} +
                          double{n.normal[2]} * double{n.normal[2]};
    require(square > 0.0 && std::isfinite(square), "a normal is zero or not finite");
    require(n.weight > 0.0 && n.weight <= 1e100, "the weight of a normal is not positive, or above 1e100");
}

void check(const Partner& partner, AcdfPartnerKind most) {
    require(partner.kind >= ACDF_PARTNER_NONE && partner.kind <= most, "mis.kind is none of those of the file");
    require(partner.heuristic == ACDF_HEURISTIC_BALANCE || partner.heuristic == ACDF_HEURISTIC_POWER,
            "mis.heuristic is not an AcdfHeuristic");
    for (const double share : {partner.light, partner.other})
        require(share >= 1e-3 && share <= 1e3, "a share of the partner is not in [0.001, 1000]");
}

void check_bins(const LocalOptions& options) {
    require(options.subdivisions <= 256, "subdivisions is above 256");
    require(options.columns <= 1024 && options.rows <= 1024, "there are more than 1024 columns or rows of bins");
    require((options.columns == 0) == (options.rows == 0), "columns and rows of bins are given together");
    require(options.columns == 0 || options.subdivisions == 0, "bins are either subdivisions, or columns and rows");
    require(options.columns == 0 || !options.sharing,
            "columns and rows are for bins without sharing: those that share tiles are interpolated");
    require(options.tiles <= max_tiles, "tiles is above max_tiles");
    require(options.tiles == 0 || options.sharing, "tiles is for bins that share them");
    check_max_weight(options.max_weight);
    require(options.max_weight == 0.0 ||
                (options.sharing && !options.visibility.point && options.mis.kind == ACDF_PARTNER_NONE),
            "max_weight is for bins that share tiles, without visibility cells or an MIS partner");
}

} // namespace

void check(const TargetOptions& options) {
    check(options.channels);
    require(options.filter == ACDF_FILTER_NEAREST || options.filter == ACDF_FILTER_BILINEAR,
            "filter is not an AcdfFilter");
    require(options.wrap == Wrap::clamp || options.wrap == Wrap::repeat, "wrap is not a Wrap");
    const Domain domain = options.domain;
    require(domain == Domain::source || domain == Domain::latlong || domain == Domain::octahedral,
            "domain is not a Domain");
    const BadTexelPolicy policy = options.bad_texels;
    require(policy == BadTexelPolicy::zero || policy == BadTexelPolicy::clamp || policy == BadTexelPolicy::error,
            "bad_texels is not a BadTexelPolicy");
}

void check(const EnvironmentOptions& options) {
    check(options.fit);
    check(options.codec);
    check(options.source);
    check(options.mis, ACDF_PARTNER_MEAN);
    for (const SceneNormal& n : options.normals) check(n);
    check_text(options.normals_text);
    const bool alone = options.mis.kind == ACDF_PARTNER_NONE;
    require(alone || (options.fit.fit == ACDF_FIT_VARIANCE && options.fit.max_weight == 0.0 &&
                      options.goal.kind != Goal::Kind::variance),
            "an MIS partner is for the variance fit, without max_weight, of a number of cells or a budget");
    require(!alone || options.normals.empty(), "normals of an environment are those that its partner lights");
    if (options.fit.fit != ACDF_FIT_VARIANCE) return;
    require(options.fit.order == Order::best, "order is for the fits cdf, pdf and uniform");
    check(options.goal, 1);
}

/// Whether a transform turns, mirrors and scales as a whole: rays then have the directions between positions.
static bool keeps_angles(const float t[3][4]) {
    const auto dot = [t](int i, int k) {
        return double{t[i][0]} * double{t[k][0]} + double{t[i][1]} * double{t[k][1]} +
               double{t[i][2]} * double{t[k][2]};
    };
    const double square = dot(0, 0), most = 1e-5 * square;
    return square > 0.0 && std::fabs(dot(1, 1) - square) <= most && std::fabs(dot(2, 2) - square) <= most &&
           std::fabs(dot(0, 1)) <= most && std::fabs(dot(0, 2)) <= most && std::fabs(dot(1, 2)) <= most;
}

static void check_visibility(const LocalOptions& options) {
    require(!options.visibility.point == !options.visibility.occluded,
            "visibility cells need both callbacks, or none");
    require(options.visibility.point || options.visibility.portals.empty(),
            "portals are for files with visibility cells");
    if (!options.visibility.point) return;
    require(options.sharing, "visibility cells are for bins that share tiles");
    require(options.goal.kind == Goal::Kind::budget || options.goal.kind == Goal::Kind::automatic,
            "the goal of visibility cells is a budget");
    for (const auto& row : options.visibility.transform)
        for (const float t : row) require(std::isfinite(t), "the transform of visibility cells is not finite");
    require(options.visibility.portals.empty() || keeps_angles(options.visibility.transform),
            "with portals, the transform of visibility cells must keep angles");
    require(options.visibility.portals.size() <= ACDF_MAX_PORTALS, "there are more than 8 portals");
}

void check(const LocalOptions& options) {
    check_bins(options);
    check_visibility(options);
    for (const SceneNormal& n : options.normals) check(n);
    require(is_share(options.cosine_share, 0.99), "cosine_share is not in [0, 0.99]");
    require(options.bin_target == BinTarget::mean || options.bin_target == BinTarget::centre,
            "bin_target is not a BinTarget");
    check(options.codec);
    check(options.source);
    check_text(options.normals_text);
    check(options.mis, ACDF_PARTNER_COSINE);
    require(options.mis.kind == ACDF_PARTNER_NONE || (options.sharing && options.cosine_share == 0.0),
            "an MIS partner is for bins that share tiles, without a cosine_share");
    if (options.sharing) return check(options.goal, 16);
    check(options.fit);
    require(options.fit.fit != ACDF_FIT_VARIANCE, "without sharing fit.fit is ACDF_FIT_CDF, _PDF or _UNIFORM");
    require(options.goal.kind == Goal::Kind::automatic, "a goal is for bins that share tiles");
}

void check(const BrdfOptions& options) {
    check(options.channels);
    check(options.codec);
    check(options.source);
    require(is_fit(options.fit), "fit is not an AcdfFit");
    const std::uint32_t theta = options.theta_views, phi = options.phi_views;
    require(theta == 0 || (theta >= 2 && theta <= 1024), "theta_views is neither 0 nor in [2, 1024]");
    require(phi <= 1 || (phi >= 4 && phi <= 1024), "phi_views is neither 0, 1 nor in [4, 1024]");
    require(phi == 0 || theta > 0, "phi_views needs theta_views");
    check_segments(options.phi_segments, options.theta_segments, options.epsilon);
    require(is_share(double{options.diffuse_share}, 0.99f), "diffuse_share is not in [0, 0.99]");
    check_max_weight(options.max_weight);
    require(options.max_weight == 0.0 || options.fit == ACDF_FIT_VARIANCE, "max_weight is for the variance fit");
    if (options.fit != ACDF_FIT_VARIANCE) return;
    check(options.goal, 1);
    require(options.goal.kind != Goal::Kind::cells || options.goal.cells <= max_tiles,
            "goal.cells of a BRDF is above max_tiles");
}

void check(const IndexedOptions& options, std::size_t maps) {
    check(options.target);
    check(options.goal, 1);
    require(options.goal.kind == Goal::Kind::budget || options.goal.kind == Goal::Kind::automatic,
            "the goal of several maps is a budget");
    check(options.codec);
    check(options.source);
    for (const MapAxis& axis : options.axes)
        require(is_text(axis.name, 15), "the name of an axis is not UTF-8 or has more than 15 bytes");
    build::check(internal(options), maps);
}

void check(const TableOptions& options) {
    check(options.goal, 1);
    check_max_weight(options.max_weight);
    check(options.codec);
    check(options.source);
    for (const std::string& name : options.names)
        require(is_text(name, 15), "the name of an axis is not UTF-8 or has more than 15 bytes");
    check(options.other_source);
    const bool alone = options.mis.kind == ACDF_PARTNER_NONE;
    require(alone || options.mis.kind == ACDF_PARTNER_TABLE, "the partner of a table is another table");
    check(options.mis, ACDF_PARTNER_TABLE);
    require(alone || (options.max_weight == 0.0 && options.goal.kind != Goal::Kind::variance),
            "an MIS partner is for a number of cells or a budget, without max_weight");
    require(alone == (options.other.data == nullptr), "mis.kind and the other table are given together");
}

} // namespace acdf::builder
