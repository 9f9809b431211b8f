// The trade of size against noise and time on a user's own probe or BRDF: every fit at several sizes, beside what
// renderers use without acdf.
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

enum class SweepKind { environment, local, visibility, brdf };

/// As users say it: "env", "local", "visibility", "brdf".
const char* to_string(SweepKind kind);
/// All fits of a kind, in the order of the report; the first is the default of its subcommand.
const std::vector<std::string>& fits_of(SweepKind kind);
/// All but a tree for each normal, which takes minutes.
std::vector<std::string> default_fits(SweepKind kind);

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// 4 KiB to 1 MB; local files from 16 KiB to 4 MB, visibility 1 and 4 MB, files of BRDFs up to 256 KiB.
std::vector<std::uint64_t> default_budgets(SweepKind kind);

/// Times of one sampler in rounds that it shared with all others, so that ratios within a round mean something.
struct SweepTimes {
    std::vector<double> sample; ///< ns a sample, one a round; empty: not timed
    std::vector<double> pdf;    ///< ns a pdf; empty: not timed, or the sampler has none
};

/// How a renderer uses the light's samples on a diffuse surface: without occluders, or behind those of the demo
/// scene; alone, or with an MIS partner of as many samples of the surface (balance heuristic).
enum Situation : std::size_t { open_alone, open_partner, hidden_alone, hidden_partner, kSituations };

/// Relative variance of one sample over points of a surface, exact. Infinite: biased.
struct Lit {
    double mean = kUnknown, median = kUnknown, worst = kUnknown;
    /// Of scrambled Sobol' points: the variance of a pixel times its samples, mean over points, by taking them.
    double sobol = kUnknown;
};

/// One file, or one baseline. kUnknown where something does not apply.
struct SweepRow {
    std::string system;  ///< "acdf", or a baseline's name for programs: "full_cdf"
    std::string fit;     ///< of acdf
    std::string label;   ///< for people
    std::string options; ///< of acdf: what makes the file, in the words of the command line
    std::uint64_t bytes =
        0; ///< in memory: of a file with the tables made at load, of a baseline what sampling reads
    std::uint64_t file_bytes = 0; ///< of acdf: of the file alone
    std::uint64_t cells = 0;      ///< of acdf
    /// Of one sample over the squared mean, exact. Infinite: biased, as the pdf is 0 where there is light.
    /// Environment: of the light itself; local and BRDF: of what a surface reflects, mean over normals or views.
    double relative_variance = kUnknown;
    double worst = kUnknown;          ///< the same for the worst normal or view
    double median = kUnknown;         ///< local and BRDF: over normals or views
    double sobol = kUnknown;          ///< local and BRDF: of scrambled Sobol' points, as in Lit
    std::array<Lit, kSituations> lit; ///< environment: of a diffuse surface
    double max_weight = kUnknown;     ///< largest f/p over its mean
    double rms = kUnknown;            ///< of the pdf's error, sr^-1
    double build_seconds = kUnknown;
    SweepTimes times;

    bool ours() const { return system == "acdf"; }
    /// What counts at equal time: with a surface, where that is known.
    double shaded() const {
        const double mean = lit[open_alone].mean;
        return mean == mean ? mean : relative_variance;
    }
};

/// A pdf in false colour, with the borders of cells.
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
    SweepKind kind = SweepKind::environment;
    std::string source;      ///< as the user named it
    std::string description; ///< for people: "1024 x 512, lat-long"
    std::string command;     ///< "acdf env 'my probe.exr' --channel rgb", to which a row's options and -o are added
    std::string output;      ///< a name for the recommended file
    VisibleNoise visible;
    std::vector<SweepRow> rows;
    std::size_t reference = 0;      ///< row with which times are compared
    std::uint32_t conditions = 0;   ///< normals or views that means are over
    std::vector<std::string> notes; ///< what a reader of the figures should know
    std::vector<SweepPicture> pictures;
    PdfRange range;                       ///< of their colours
    std::vector<std::uint8_t> colour_bar; ///< PNG, low to high
    bool timed = true;
    SampleCosts costs;
    measure::Numbers numbers = measure::Numbers::independent; ///< by which the advice goes
};

struct SweepOptions {
    std::vector<std::uint64_t> budgets; ///< empty: default_budgets
    std::vector<std::string> fits;      ///< empty: default_fits
    VisibleNoise visible;
    builder::TargetOptions target;
    /// The map's own texels (of nearest lookup), where the filter blends them: what estimates find. Empty: they
    /// find what is fitted, texel by texel.
    builder::Target texels;
    bool timing = true;
    bool pictures = true;
    std::uint32_t normals = 64; ///< environment and local; visibility: points
    std::uint32_t views = 64;   ///< BRDF: of baselines; files are measured over the builder's own
    std::uint32_t points = 48;  ///< environment: of the demo scene, where light is hidden; about
    std::uint32_t seeds = 16;   ///< estimates with Sobol' points at each normal, view or point
    std::uint32_t rounds = 31;  ///< of timing
    double shadow_ray_ns = 500.0;
    measure::Numbers numbers = measure::Numbers::independent;
};

/// A probe's rows, baselines included, and pictures. Source, command and output are the caller's to fill in. Goals
/// that are out of reach are noted and left out. Throws Failure where none is left.
Sweep sweep_environment(const builder::Target& target, const builder::Source& source, const SweepOptions& options,
                        const build::Progress& progress = {});
/// The same for local files, which are given the normal.
Sweep sweep_local(const builder::Target& target, const builder::Source& source, const SweepOptions& options,
                  const build::Progress& progress = {});
/// What a file with visibility cells is made for and measured on.
struct SweptMesh {
    std::shared_ptr<const input::MeshSurface> surface;
    bool turned = false; ///< from y up
    builder::Visibility visibility;
    std::vector<builder::SceneNormal> normals; ///< of both sides
    std::string text;                          ///< stored in the files as their scene
    std::string options;                       ///< in the words of the command line
};
/// Files with visibility cells beside those of normals alone, on a mesh with what it hides: at options.normals
/// points all over it. There are no pictures.
Sweep sweep_visibility(const builder::Target& target, const builder::Source& source, const SweptMesh& mesh,
                       const SweepOptions& options, const build::Progress& progress = {});
/// The same of a BRDF.
Sweep sweep_brdf(const input::Brdf& brdf, const SweepOptions& options, const build::Progress& progress = {});

} // namespace acdf::tools
