// Makes .acdf files from what a program holds in memory: pixels, BRDFs, tables. C++17; needs oneTBB and zlib alone.
//
// A whole program; docs/examples/build_environment.cpp is the same:
//
//     #include <acdf/builder.h>
//
//     #include <cstdio>
//     #include <vector>
//
//     int main() {
//         const int width = 512, height = 256;
//         std::vector<float> rgb(3 * width * height, 0.2f); // the program's own pixels: an even sky ...
//         rgb[3 * (60 * width + 300)] = 4e4f;               // ... and a red sun
//
//         acdf::builder::Pixels pixels;
//         pixels.data = rgb.data();
//         pixels.width = width, pixels.height = height;
//         acdf::builder::EnvironmentOptions options;
//         options.goal = acdf::builder::Goal::of_budget(16 << 10); // at most 16 KiB
//         acdf::builder::Environment made;
//         const acdf::builder::Status status = acdf::builder::environment(pixels, options, made);
//         if (!status.ok()) return std::fprintf(stderr, "%s\n", status.message), 1;
//
//         acdf::File file; // reads made.bytes where they lie
//         if (!acdf::File::from_memory(made.bytes.data(), made.bytes.size(), file).ok()) return 1;
//         const acdf::DirectionSample s = file.environment().sample(0.5, 0.25);
//         std::printf("relative variance %.2g; a direction (%.2f, %.2f, %.2f) of pdf %.3g per steradian\n",
//                     made.accuracy.relative_variance, double(s.direction[0]), double(s.direction[1]),
//                     double(s.direction[2]), double(s.pdf));
//     }
//
// Results are the bytes of files (format/SPEC.md): acdf::File::from_memory reads them in place, or write them to
// disk. The same input, options and version give the same bytes, for any number of threads. Errors are values:
// nothing is thrown and nothing is printed, whatever the input. After an error the result is empty. Functions may
// be called by several threads at once. The frame is that of docs/conventions.md: right-handed, z up.
#pragma once

#include <acdf/accuracy.h>
#include <acdf/outcome.h>
#include <acdf/pixels.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace acdf::builder {

/// Most tiles of a local file, and cells of each view of a BRDF.
constexpr std::uint32_t max_tiles = 32768;

// ---- options ----

/// How large a file is to be, or how accurate; only what `kind` names counts. `automatic`, the default, is the
/// budget of DefaultBudget.
struct Goal {
    enum class Kind { automatic, cells, budget, variance };

    Kind kind = Kind::automatic;
    std::uint32_t cells = 0;  ///< cells: about so many, up to 2^28; of what, each kind of file says
    std::uint64_t budget = 0; ///< budget: the most accurate file of at most so many bytes
    double variance = 0.0;    ///< variance: the smallest file of at most this relative variance, > 0

    /// Goals of each kind.
    static Goal of_cells(std::uint32_t n) { return {Kind::cells, n, 0, 0.0}; }
    static Goal of_budget(std::uint64_t bytes) { return {Kind::budget, 0, bytes, 0.0}; }
    static Goal of_variance(double v) { return {Kind::variance, 0, 0, v}; }
};

/// Bytes of a file for which no goal is given.
struct DefaultBudget {
    static constexpr std::uint64_t environment = 64 << 10, local = 1 << 20, visibility = 4 << 20, brdf = 128 << 10;
    /// Of a table: 64 KiB, and 256 bytes a bin where it has more than 256 of them.
    static constexpr std::uint64_t table(std::uint64_t bins) { return bins > 256 ? 256 * bins : 64 << 10; }
};

/// Weights of red, green and blue, >= 0 and not all 0; Rec. 709 luminance.
struct ChannelWeights {
    double r = 0.2126, g = 0.7152, b = 0.0722;
};

/// Whose noise is minimised: of the weighted sum of channels (ACDF_CHANNELS_WEIGHTED), of each on its own
/// (ACDF_CHANNELS_SEPARATE, weights 1 1 1), or of the largest (ACDF_CHANNELS_LARGEST, weights 1 1 1).
struct Channels {
    AcdfChannels mode = ACDF_CHANNELS_WEIGHTED;
    ChannelWeights weights;
};

/// Which axis the fits cdf, pdf and uniform divide first. `best`: both files are made, and the more accurate one is
/// kept.
enum class Order { best, phi, z };
/// How these fits average the rows of a region into one curve: weighted by energy, or all alike (ibid.,
/// eq. 4).
enum class Conditional { energy, mean };

/// How knots are chosen. The variance fit has the least noise for its size and follows Goal; the others are those
/// of ibid., §5, and equal steps: they follow segments and epsilon.
struct FitOptions {
    AcdfFit fit = ACDF_FIT_VARIANCE;
    Order order = Order::best;
    double max_weight = 0.0; ///< variance: the largest f/p over its mean, at least 1; 0: no bound
    std::uint32_t phi_segments = 64, theta_segments = 64; ///< cdf, pdf, uniform: of a curve, 1 to ACDF_MAX_SEGMENTS
    double epsilon = 0.0;             ///< cdf, pdf: deviation at which a curve has knots enough, in [0, 1]; 0: none
    std::uint32_t gradient_knots = 0; ///< cdf, pdf: extra knots of the first curve (ibid., eq. 5), up to 2^20
    Conditional conditional = Conditional::energy;
};

/// Where a source came from: optional, UTF-8, up to 4096 bytes each; it goes into the file's metadata.
struct Source {
    std::string name;       ///< source.name
    std::string sha256;     ///< source.sha256, hex
    std::string projection; ///< source.projection; empty: the name of Pixels::projection
    std::string reading;    ///< before the options in fit.options: "--projection angular "
};

// ---- light ----

/// The grid that a map is fitted on.
enum class Domain {
    source,    ///< its own texels, of a lat-long or octahedral map; else the one of the others that loses least
    latlong,   ///< phi and theta
    octahedral ///< u and v of the equal-area octahedral square
};

/// The texels of an interpolated lookup beyond the first and last row of a lat-long map, or beyond the sides of a
/// disc. They are those of the border itself, or, as textures that repeat have it, of the opposite one.
enum class Wrap { clamp, repeat };

/// What is fitted of a map.
struct TargetOptions {
    Channels channels;
    Domain domain = Domain::source;
    /// How the renderer looks the map up. A bilinear fit serves nearest lookups, too, with a little more noise: its
    /// pdf is positive wherever a texel or its neighbour has light. A nearest fit is biased under bilinear lookups,
    /// which blend light into dark texels.
    AcdfFilter filter = ACDF_FILTER_BILINEAR;
    Wrap wrap = Wrap::clamp; ///< of a bilinear lookup
    BadTexelPolicy bad_texels = BadTexelPolicy::zero;
    bool uniform_if_black = false; ///< black becomes the faintest even light, else ErrorCode::no_energy
};

/// A map, read once and ready for any number of files: of several sizes, of both kinds. Copies share it.
class Target {
public:
    struct Data;

    /// Reads a map from memory, or row by row. ErrorCode::bad_source and no_energy where the map is wrong,
    /// invalid_argument where the options are; `target` is then empty.
    static Status from(const Pixels& pixels, const TargetOptions& options, Target& target,
                       const Control& control = {}) noexcept;
    static Status from(const Rows& rows, const TargetOptions& options, Target& target,
                       const Control& control = {}) noexcept;

    /// Whether it holds no map.
    bool empty() const noexcept { return !data_; }
    // Of a target that is not empty:
    std::uint32_t columns() const noexcept; ///< of the grid that is fitted
    std::uint32_t rows() const noexcept;
    double total() const noexcept; ///< integral over the sphere, of several channels their sum
    const BadTexels& bad_texels() const noexcept;

    /// For the library's own use.
    Target() noexcept = default;
    explicit Target(std::shared_ptr<const Data> data) noexcept : data_(std::move(data)) {}
    const std::shared_ptr<const Data>& data() const noexcept { return data_; }

private:
    std::shared_ptr<const Data> data_;
};

/// What a file is to be combined with, by multiple importance sampling. Such a file has pdf 0 where the
/// partner is enough: it is not to be used alone, and says so (requires_mis of its view).
struct Partner {
    /// ACDF_PARTNER_COSINE: cos / pi around the normal. ACDF_PARTNER_BRDF: lobes as BRDFs have them, and
    /// ACDF_PARTNER_MEAN: as if the partner were the same everywhere (Karlik et al. 2019), of environments alone.
    /// ACDF_PARTNER_TABLE: another table, of tables alone.
    AcdfPartnerKind kind = ACDF_PARTNER_NONE;
    AcdfHeuristic heuristic = ACDF_HEURISTIC_BALANCE;
    double light = 1.0, other = 1.0; ///< samples of the file and of the partner, in proportion; in [1e-3, 1e3]
};

/// A normal of a scene, of any length > 0, and how often it occurs, > 0.
struct SceneNormal {
    float normal[3] = {0.0f, 0.0f, 1.0f};
    double weight = 1.0;
};

/// How an environment is fitted and stored.
struct EnvironmentOptions {
    TargetOptions target; ///< of pixels and rows; a Target has its own
    Goal goal;            ///< cells: in all, about 4.2 bytes each; variance: up to 16 MiB. Of the variance fit only
    FitOptions fit;
    Partner mis;                      ///< of the variance fit as a tree, without max_weight or a goal of variance
    std::vector<SceneNormal> normals; ///< that the partner lights; empty: all normals
    std::string normals_text;         ///< as in LocalOptions
    AcdfCodec codec = ACDF_CODEC_NONE;
    Source source;
};

/// The file of an environment, and what is known of it.
struct Environment {
    std::vector<std::uint8_t> bytes; ///< the whole file
    EnvironmentAccuracy accuracy;
    BadTexels bad_texels;      ///< what was mended
    Order order = Order::best; ///< the axis that was split first, where that was tried or asked for
};

/// An environment map: a pdf over the sphere (acdf::EnvironmentView).
Status environment(const Target& target, const EnvironmentOptions& options, Environment& result,
                   const Control& control = {}) noexcept;
Status environment(const Pixels& pixels, const EnvironmentOptions& options, Environment& result,
                   const Control& control = {}) noexcept;
Status environment(const Rows& rows, const EnvironmentOptions& options, Environment& result,
                   const Control& control = {}) noexcept;

/// What the tree of a bin of its own is fitted to.
enum class BinTarget {
    mean,  ///< right for all normals of the bin
    centre ///< the middle one, as in ibid., §7.1: biased for others, which may see what it does not
};

/// A point of a scene where light is gathered: on a surface, or in the air.
struct VisibilityPoint {
    float position[3] = {}, normal[3] = {0.0f, 0.0f, 1.0f};
};

/// A rectangle in the scene's coordinates: a corner and two sides at right angles. Rays decide from which side
/// light comes. Where many leave the scene on either side, it comes from that which across x up points to, by the
/// right hand.
struct Portal {
    float corner[3] = {}, across[3] = {1.0f, 0.0f, 0.0f}, up[3] = {0.0f, 1.0f, 0.0f};
};

/// Which of the light reaches which position of a scene. Both callbacks are called by several threads at once, and
/// return the same for the same arguments: the file is then the same for any number of threads. A point must not
/// lie on what hides light from it, but a little above.
struct Visibility {
    /// Point `index` of an endless sequence all over the scene, any of which is about as even; false where that
    /// number has none.
    std::function<bool(std::uint64_t index, VisibilityPoint& point)> point;
    /// Whether anything lies on the ray from a point towards a direction, in the frame of directions.
    std::function<bool(const VisibilityPoint& point, const float direction[3])> occluded;
    /// From the scene's coordinates, in which a renderer gives positions, to those of points here, a row a
    /// coordinate: x' = t[0] x + t[1] y + t[2] z + t[3].
    float transform[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    /// Windows and doors that light comes through, at most 8: samples are taken through them, exactly, and by the
    /// rows of visibility cells for all that comes in another way. With them `transform` turns, mirrors, moves and
    /// scales as a whole, to the frame of directions.
    std::vector<Portal> portals;
    /// For renderers that take as many samples of the cosine, by the balance heuristic: cells have what those leave
    /// over. Valid alone, too, with more noise.
    bool beside_cosine = false;
};

/// How a local environment is fitted and stored.
struct LocalOptions {
    TargetOptions target;                ///< of pixels and rows; a Target has its own
    Goal goal;                           ///< with sharing; cells: of what bins share
    std::uint32_t subdivisions = 0;      ///< octahedral bins, 4 n^2 + 2 of them, n up to 256; 0: as suits the size
    std::uint32_t columns = 0, rows = 0; ///< instead lat-long bins, up to 1024 each, without sharing
    std::uint32_t tiles = 0;             ///< up to max_tiles; 0: as suits the size
    double max_weight = 0.0;             ///< with sharing: the largest measured weight, as FitOptions; 0: no bound
    std::vector<SceneNormal> normals;    ///< only what a scene has; empty: all normals
    double cosine_share = 0.0;           ///< of samples that are taken around the normal instead, in [0, 0.99]
    bool sharing = true;                 ///< bins share tiles; else each has a tree of its own, as in the paper
    BinTarget bin_target = BinTarget::mean; ///< without sharing
    FitOptions fit;                         ///< of a bin's tree, without sharing: cdf, pdf or uniform
    Partner mis;                            ///< of bins that share tiles, without a cosine_share
    AcdfCodec codec = ACDF_CODEC_NONE;
    Source source;
    std::string normals_text; ///< what fit.options stores of `normals`; empty: that there are some
    Visibility visibility;    ///< both callbacks: bins share tiles, the goal is a budget, and visibility cells take
                              ///< more than half of it
};

/// The file of a local environment, and what is known of it.
struct Local {
    std::vector<std::uint8_t> bytes; ///< the whole file
    LocalAccuracy accuracy;          ///< over `normals` of them: random ones, or those of the scene
    std::uint32_t normals = 0;
    BadTexels bad_texels; ///< what was mended
};

/// A local environment map: a pdf for every normal (acdf::LocalEnvironmentView).
Status local(const Target& target, const LocalOptions& options, Local& result,
             const Control& control = {}) noexcept;
Status local(const Pixels& pixels, const LocalOptions& options, Local& result,
             const Control& control = {}) noexcept;
Status local(const Rows& rows, const LocalOptions& options, Local& result, const Control& control = {}) noexcept;

// ---- reflectance ----

/// A BRDF rho(wo, wi) in sr^-1 without the cosine. wo (towards the viewer) and wi (towards the light) are unit
/// vectors above the surface, z its normal. Nothing needs to be known of peaks: the fit looks for them.
struct Brdf {
    /// Fills `rgb` with finite numbers below 1e18; negative ones count as 0, and so does what is below 1e-100 in
    /// all. Called by several threads at once. All that counts is what it returns for given arguments, which must
    /// always be the same.
    std::function<void(const double wo[3], const double wi[3], double rgb[3])> evaluate;
    bool isotropic = true; ///< rho depends on the difference of azimuths alone: views are stored for theta_o only
    bool mirrored = true;  ///< and not on its sign: half of each pdf. Neither is checked; false is always right
    /// Where `mirrored` holds but for noise, as of measurements: the mean difference of both sides over their mean,
    /// for one. Unless it is 0, accuracy is summed over both sides.
    double asymmetry = 0.0;
};

/// Numbers that the caller holds, in 1 to 6 axes of at least 1 each. Strides in bytes, one an axis, of any sign;
/// empty: packed, the last axis fastest. Numbers need not be aligned, and may not overlap.
struct Array {
    const void* data = nullptr; ///< the number at index 0 of all axes
    Number number = Number::float32;
    std::vector<std::uint32_t> shape;
    std::vector<std::ptrdiff_t> strides;
};

/// Makes a BRDF, the same in all channels, of a table of rho in sr^-1 over (theta_o, phi_o, theta_h, phi_h), h the
/// half-vector, which is copied. Value (i, j, k, l) stands at the centre of a cell; cells divide theta in [0, pi/2]
/// and phi in [0, 2 pi) equally. With a single phi_o the BRDF is isotropic and phi_h counts from phi_o. Between
/// centres linear in each angle. Negative numbers count as 0; NaN and infinite ones are ErrorCode::bad_source.
Status tabulated(const Array& table, Brdf& brdf) noexcept;

/// How a BRDF is fitted and stored.
struct BrdfOptions {
    Channels channels;
    Goal goal; ///< of the variance fit; cells: of each view, up to max_tiles
    /// Variance: views share a tree and are interpolated. Else each view has a tree, and the nearest serves.
    AcdfFit fit = ACDF_FIT_VARIANCE;
    /// Stored views, 2 to 1024 in theta_o, and 1 or 4 to 1024 in phi_o; 0: as suits the size.
    std::uint32_t theta_views = 0, phi_views = 0;
    std::uint32_t phi_segments = 10, theta_segments = 30; ///< cdf, pdf, uniform: of curves over phi_h and theta_h
    double epsilon = 0.0;                                 ///< cdf, pdf: see FitOptions
    float diffuse_share = 0.0f;                           ///< of samples that follow the cosine, in [0, 0.99]
    double max_weight = 0.0; ///< variance: the largest measured weight, at least 1; 0: what costs next to nothing
    AcdfCodec codec = ACDF_CODEC_NONE;
    Source source; ///< name and sha256
};

/// The file of a BRDF, and what is known of it.
struct BrdfFile {
    std::vector<std::uint8_t> bytes; ///< the whole file
    BrdfAccuracy accuracy;
    std::uint32_t theta_views = 0, phi_views = 0;
};

/// A BRDF: a pdf over wi for every wo (acdf::BrdfView).
Status brdf(const Brdf& brdf, const BrdfOptions& options, BrdfFile& result, const Control& control = {}) noexcept;

// ---- tables ----

/// NaN, infinite and negative numbers; `first` is the row-major index of the first, UINT64_MAX where there is none.
struct BadNumbers {
    std::uint64_t nan = 0, infinite = 0, negative = 0;
    std::uint64_t first = UINT64_MAX;

    /// All of them.
    std::uint64_t count() const { return nan + infinite + negative; }
};

/// How a table is fitted and stored.
struct TableOptions {
    std::uint32_t indexed = 0;      ///< leading axes that the caller of a sample chooses: each index is a bin
    std::vector<std::string> names; ///< one an axis, 1 to 15 bytes, all different; empty: x0, x1, ...
    std::vector<std::pair<double, double>> ranges; ///< one an axis: coordinates of its ends; empty: 0 to its length
    Goal goal;                                     ///< cells: a bin, on average
    double max_weight = 0.0;                       ///< the largest f/p over its mean, at least 1; 0: no bound
    bool bad_as_zero = false;                      ///< bad numbers count as 0, else ErrorCode::bad_source
    Partner mis;                                   ///< ACDF_PARTNER_TABLE, without max_weight or a goal of variance
    Array other;                                   ///< that table, of the same shape; each bin has its own pdf
    Source other_source;                           ///< name and sha256
    AcdfCodec codec = ACDF_CODEC_NONE;
    Source source; ///< name and sha256
};

/// The file of a table, and what is known of it.
struct Table {
    std::vector<std::uint8_t> bytes; ///< the whole file
    TableAccuracy accuracy;
    double total = 0.0; ///< integral over the sampled axes, summed over the bins
    BadNumbers bad;     ///< taken as 0
};

/// A table: a pdf over its sampled axes for every bin (acdf::TableView). Each number is the value of a function
/// that is constant on its box of the grid; numbers that float32 does not hold are scaled by a power of two.
Status table(const Array& array, const TableOptions& options, Table& result, const Control& control = {}) noexcept;

/// What a file's `fit.options` will store: with source and version it determines the bytes. Empty where memory is
/// short.
std::string option_text(const EnvironmentOptions& options) noexcept;
std::string option_text(const LocalOptions& options) noexcept;
std::string option_text(const BrdfOptions& options) noexcept;

} // namespace acdf::builder

#include <acdf/maps.h>
#include <acdf/rebuild.h>
