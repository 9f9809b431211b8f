// The trade of size against noise and time on a user's own probe or BRDF: each kind of file at several sizes,
// beside what renderers use without acdf.
#pragma once

#include "input/brdf/brdf.h"
#include "input/mesh/surface.h"
#include "measure/random.h"
#include "tools/cli/progress.h"
#include "tools/plot/range.h"

#include <acdf/builder.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace acdf::tools {

enum class SweepKind { probe, brdf };

/// As users say it: "probe", "brdf".
const char* to_string(SweepKind kind);

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Times of one sampler in rounds that it shared with all others, so that ratios within a round mean something.
struct SweepTimes {
    std::vector<double> sample; ///< ns a sample, one a round; empty: not timed
    std::vector<double> pdf;    ///< ns a pdf, one a round; empty: not timed
};

/// Where a path tracer estimates direct light: on a diffuse surface or one with a glossy lobe, with nothing hidden
/// or with half of the sky hidden (of a mesh: what it hides).
enum Case : std::size_t { diffuse_open, diffuse_hidden, glossy_open, glossy_hidden, kCases };
/// By samples of the light alone, or by one of the light and one of the BSDF, weighed by MIS.
enum Estimator : std::size_t { light_alone, with_mis, kEstimators };

/// What a renderer hands to a light beside random numbers, and what a sampler needs; each includes those before it.
enum class Given { nothing, normal, position };

/// The relative variance of one sample (each of a pair is one) in a picture: its mean over points, over the square
/// of what points reflect on average. Infinite: biased.
struct Noise {
    double exact = kUnknown; ///< of independent numbers, by summation
    double sobol = kUnknown; ///< of scrambled Sobol' points: that of a pixel times its samples, by sampling them
};

/// One file, or one baseline. kUnknown where something does not apply.
struct SweepRow {
    std::string system;  ///< "acdf", or a baseline's name for programs: "full_cdf"
    std::string file;    ///< of acdf: its name in SweepOptions::files
    std::string label;   ///< for people
    std::string command; ///< of acdf: the subcommand that makes the file
    std::string options; ///< of acdf: in the words of the command line
    Given needs = Given::nothing;
    bool needs_mis = false; ///< is biased without BSDF samples
    std::uint64_t bytes =
        0; ///< in memory: of a file with the tables made at load, of a baseline what sampling reads
    std::uint64_t file_bytes = 0; ///< of acdf: of the file alone
    std::uint64_t cells = 0;      ///< of acdf
    /// Of one sample over the squared mean, exact. Infinite: biased, light without pdf. Probe: of the light itself,
    /// with a normal that of a diffuse surface, mean over normals; unknown of files for MIS. BRDF: of what is
    /// reflected, mean over views.
    double relative_variance = kUnknown;
    double worst = kUnknown;                                    ///< the same for the worst view or normal
    double median = kUnknown;                                   ///< over views or normals
    double sobol = kUnknown;                                    ///< BRDF: as in Noise
    std::array<std::array<Noise, kCases>, kEstimators> noise{}; ///< probe
    double max_weight = kUnknown;                               ///< largest f/p over its mean
    double rms = kUnknown;                                      ///< of the pdf's error, sr^-1
    double build_seconds = kUnknown;
    SweepTimes times;

    bool ours() const { return system == "acdf"; }
};

/// A pdf in false colour, knots overlaid.
struct SweepPicture {
    std::string title, description;
    int width = 0, height = 0;
    std::vector<std::uint8_t> png;
};

/// When noise is too small to see: its standard deviation in a pixel, of `spp` samples, over the pixel's value.
struct VisibleNoise {
    std::uint32_t spp = 64;
    double threshold = 0.01;

    double largest_variance() const { return threshold * threshold * spp; }
};

/// What counts at equal time beside the sampling of light's samples.
struct SampleCosts {
    double shadow_ray_ns = 500.0; ///< what else a sample costs: a ray, a BRDF
    double cosine_ns = 0.0;       ///< to sample one of the surface's samples and to evaluate its pdf
};

struct Sweep {
    SweepKind kind = SweepKind::probe;
    std::string source;      ///< as the user named it
    std::string description; ///< for people: "1024 x 512, lat-long"
    std::string input;       ///< "'my probe.exr' --channel red": between a row's command and its options
    std::string output;      ///< "my probe": what names of files begin with
    VisibleNoise visible;
    std::vector<SweepRow> rows;
    std::size_t reference = 0;    ///< row with which times are compared
    std::uint32_t conditions = 0; ///< points or views that means are over
    bool on_mesh = false;         ///< probe: points are of a mesh, and only cases with what it hides count
    AcdfHeuristic heuristic = ACDF_HEURISTIC_BALANCE;
    std::vector<std::string> notes; ///< what a reader of the figures should know
    std::vector<SweepPicture> pictures;
    PdfRange range;                       ///< of their colours
    std::vector<std::uint8_t> colour_bar; ///< PNG, low to high
    bool timed = true;
    SampleCosts costs;
    measure::Numbers numbers = measure::Numbers::independent; ///< by which the advice goes
};

struct SweepOptions {
    std::vector<std::uint64_t> budgets; ///< empty: those of each kind of file
    std::vector<std::string> files;     ///< empty: those of default_files
    VisibleNoise visible;
    AcdfHeuristic heuristic = ACDF_HEURISTIC_BALANCE; ///< of the renderer's MIS
    builder::TargetOptions target;
    /// The map's own texels (of nearest lookup), where the filter blends them: what estimates find. Empty: they
    /// find what is fitted, texel by texel.
    builder::Target texels;
    bool timing = true;
    bool pictures = true;
    std::uint32_t points = 32; ///< probe: random normals, or points of a mesh
    std::uint32_t views = 64;  ///< BRDF: of baselines; files are measured over the builder's own
    std::uint32_t seeds = 16;  ///< estimates with Sobol' points at each point or view
    std::uint32_t rounds = 31; ///< of timing
    double shadow_ray_ns = 500.0;
    measure::Numbers numbers = measure::Numbers::independent;
};

/// What files with visibility cells are made for, and all files are measured on.
struct SweptMesh {
    std::shared_ptr<const input::MeshSurface> surface;
    bool turned = false; ///< from y up
    builder::Visibility visibility;
    std::vector<builder::SceneNormal> normals; ///< of both sides
    std::string text;                          ///< that files store
    std::string options;                       ///< in the words of the command line
};

/// A probe's rows, baselines included, and pictures. Source, input and output are the caller's to fill in. Goals
/// that are out of reach are noted and left out. Throws std::invalid_argument where none is left. `mesh` may be
/// null.
Sweep sweep_probe(const builder::Target& target, const builder::Source& source, const SweptMesh* mesh,
                  const SweepOptions& options, const build::Progress& progress = {});
/// Kinds of files of a BRDF, as SweepOptions::files names them.
const std::vector<std::string>& brdf_files();
/// The same of a BRDF.
Sweep sweep_brdf(const input::Brdf& brdf, const SweepOptions& options, const build::Progress& progress = {});

} // namespace acdf::tools
