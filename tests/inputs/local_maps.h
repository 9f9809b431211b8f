// Local environment maps for tests: fitted, stored and loaded again; and what is exact about them.
#pragma once

#include "tests/inputs/irradiance.h"
#include "tests/inputs/paths.h"
#include "tests/inputs/synthetic.h"

#include "compress/local/fit_separate.h"
#include "compress/local/halved/fit.h"
#include "compress/sum.h"
#include "input/probe/probe.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace acdf_test {

// ---- files ----------------------------------------------------------------------------------------------

/// Tiles whose probabilities rows hold, and cells in all of them, at most.
struct LocalMapSize {
    std::uint32_t tiles = 900;
    std::uint64_t cells = 32768;
};

struct LocalFileOptions {
    LocalMapSize size;
    bool sharing = true;
    double cosine_share = 0.0;
    AcdfCodec codec = ACDF_CODEC_NONE;
};

inline LocalFileOptions of_size(std::uint32_t tiles, std::uint64_t cells, double cosine_share = 0.0,
                                bool sharing = true) {
    LocalFileOptions options;
    options.size = {tiles, cells};
    options.cosine_share = cosine_share;
    options.sharing = sharing;
    return options;
}

inline acdf::compress::Description local_description(const acdf::compress::Target& target,
                                                     const acdf::compress::NormalBins& bins) {
    acdf::compress::Description d =
        acdf::compress::environment_description(target.columns, target.rows, target.parameterization);
    d.kind = ACDF_KIND_LOCAL;
    d.total = target.total;
    if (bins.subdivisions > 0) {
        const auto count = static_cast<std::uint32_t>(bins.normals.size());
        d.axes.push_back({"normal", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, count, 0.0, double(count)});
    } else {
        d.axes.push_back({"normal theta", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, bins.rows, 0.0, kPi});
        d.axes.push_back({"normal phi", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, bins.columns, kPi, -kPi});
    }
    return d;
}

inline acdf::compress::LocalHalvings local_halvings(const acdf::compress::Target& target,
                                                    const acdf::compress::NormalBins& bins,
                                                    const LocalMapSize& of) {
    acdf::compress::LocalHalvingsSize size;
    size.top = of.tiles - 1;
    size.halvings = std::max<std::uint64_t>(of.cells, of.tiles) - 1;
    size.bytes = std::uint64_t{1} << 32;
    return acdf::compress::LocalHalvingsFitter(target, bins, {}).fit(bins, size, {});
}

inline std::vector<std::uint8_t> local_bytes(const acdf::compress::Target& target,
                                             const acdf::compress::NormalBins& bins,
                                             const LocalFileOptions& options) {
    using namespace acdf::compress;
    Description description = local_description(target, bins);
    const auto cosine = static_cast<float>(options.cosine_share);
    if (options.sharing) {
        const LocalHalvings fit = local_halvings(target, bins, options.size);
        description.shares = fit.shares;
        description.chunks = {rows_chunk(fit), local_chunk(cosine)};
        return store(fit.halvings, fit.roots, description, options.codec);
    }
    FitOptions each;
    each.fit = ACDF_FIT_CDF;
    each.order = Order::z;
    each.column_segments = each.row_segments = 12;
    SeparateFit fit = fit_local_separate(target, bins, BinTarget::mean, each);
    description.shares = std::move(fit.shares);
    description.chunks = {local_chunk(cosine)};
    return store(fit.tree, description, options.codec);
}

/// The grid square of a direction.
inline bool find_square(const acdf::compress::Target& target, const float direction[3], std::uint32_t square[2]) {
    const AcdfGrid grid{target.columns, target.rows, static_cast<std::uint32_t>(target.parameterization)};
    double position[2];
    return acdf_grid_square(&grid, direction, square, position) != 0;
}

/// The direction at a position in texels; a row's middle is that of its angles.
inline Normal direction_at_position(const acdf::compress::Target& target, double column, double row) {
    Normal out;
    if (target.parameterization == ACDF_PARAM_OCTAHEDRAL) {
        double d[3];
        acdf_octahedral_direction(column / target.columns, row / target.rows, d);
        for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<float>(d[k]);
    } else {
        direction_of(kPi - 2.0 * kPi * column / target.columns, std::cos(kPi * row / target.rows), out.data());
    }
    return out;
}

/// A file in memory, and what it was made from.
struct LocalMap {
    acdf::compress::Target target;
    acdf::compress::NormalBins bins;
    std::vector<std::uint8_t> bytes;
    acdf::File file;
    ExactIrradiance exact;
    std::vector<Normal> centres;  ///< of texels, row-major
    std::vector<Normal> quarters; ///< of each texel's four

    LocalMap(acdf::compress::Target t, acdf::compress::NormalBins b, const LocalFileOptions& options)
        : target(std::move(t)), bins(std::move(b)), bytes(local_bytes(target, bins, options)), exact(target) {
        const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
        if (!status.ok()) throw std::runtime_error(status.message);
        for (std::uint32_t r = 0; r < target.rows; ++r)
            for (std::uint32_t c = 0; c < target.columns; ++c) {
                centres.push_back(direction_at_position(target, c + 0.5, r + 0.5));
                for (int k = 0; k < 4; ++k)
                    quarters.push_back(
                        direction_at_position(target, c + 0.25 + 0.5 * (k % 2), r + 0.25 + 0.5 * (k / 2)));
            }
    }
    LocalMap(const LocalMap&) = delete;
    LocalMap& operator=(const LocalMap&) = delete;
    double irradiance(const Normal& normal) const { return exact(normal.data()); }
    std::size_t texel(std::uint32_t column, std::uint32_t row) const {
        return std::size_t{row} * target.columns + column;
    }
    acdf::LocalEnvironmentView view() const { return file.local(); }
    /// The same without its cosine share: what follows the light.
    acdf::LocalEnvironmentView light_view() const {
        AcdfLocal data = view().data();
        data.cosine_share = 0.0;
        return acdf::LocalEnvironmentView(data);
    }
    float radiance(std::uint32_t column, std::uint32_t row) const { return target.row(row)[column]; }
    float radiance(const float direction[3]) const {
        std::uint32_t square[2] = {0, 0};
        return find_square(target, direction, square) ? radiance(square[0], square[1]) : 0.0f;
    }
};

// ---- exact sums -----------------------------------------------------------------------------------------

inline double square_area(const AcdfEnvironment& env, std::uint32_t row) {
    const AcdfGrid grid = acdf_environment_grid(&env);
    const AcdfRange square[2] = {{0, 1}, {row, row + 1}};
    return acdf_grid_solid_angle(&grid, square);
}

/// Probability of each grid square, row-major, in the part that follows the light. Needs curves without tilt.
inline std::vector<double> square_probabilities(const acdf::LocalEnvironmentView& view, const float normal[3]) {
    const AcdfLocal& local = view.data();
    const AcdfEnvironment& env = local.environment;
    AcdfLocalPoint source;
    acdf_local_at(&local, normal, &source);
    std::vector<double> out(std::size_t{env.columns} * env.rows, 0.0);
    if (source.what == ACDF_LOCAL_NOTHING) return out;
    for (std::uint32_t r = 0; r < env.rows; ++r)
        for (std::uint32_t c = 0; c < env.columns; ++c) {
            const std::uint32_t square[2] = {c, r};
            AcdfRange range[2];
            const double p = acdf_local_find_cell(&local, &source, square, range);
            const AcdfGrid grid = acdf_environment_grid(&env);
            out[std::size_t{r} * env.columns + c] = p * square_area(env, r) / acdf_grid_solid_angle(&grid, range);
        }
    return out;
}

/// E[(f/p)^2] of one sample for f = L max(0, n . omega), about: of 2 x 2 directions a texel. Of a texel of which a
/// horizon leaves less than these, at most: by its largest cosine.
inline double second_moment(const LocalMap& map, const float normal[3]) {
    const auto view = map.view();
    const AcdfLocalPoint at = view.at(normal);
    const double size = length(normal);
    const auto cosine_of = [&](const Normal& d) { return dot(normal, d.data()) / size; };
    acdf::compress::Sum sum;
    for (std::uint32_t r = 0; r < map.target.rows; ++r)
        for (std::uint32_t c = 0; c < map.target.columns; ++c) {
            const auto light = static_cast<double>(map.radiance(c, r));
            if (!(light > 0.0)) continue;
            bool any = false;
            for (int k = 0; k < 4; ++k) {
                const Normal& d = map.quarters[4 * map.texel(c, r) + std::size_t(k)];
                const double cosine = cosine_of(d), f = light * cosine;
                if (!(cosine > 0.0)) continue;
                any = true;
                sum.add(0.25 * square_area(view.data().environment, r) * f * f /
                        static_cast<double>(view.pdf(at, d.data())));
            }
            const double sliver = any ? 0.0 : map.exact.of_texel(normal, c, r);
            if (!(sliver > 0.0)) continue;
            double most = 0.0;
            for (int k = 0; k < 4; ++k)
                most = std::max(most, cosine_of(direction_at_position(map.target, c + k % 2, r + k / 2)));
            sum.add(light * light * most * sliver /
                    static_cast<double>(view.pdf(at, map.centres[map.texel(c, r)].data())));
        }
    return sum.value();
}

// ---- normals --------------------------------------------------------------------------------------------

/// Random ones, and those where something changes: axes, corners, middles of edges and of faces of the bins' own
/// octahedron, seams and poles of their lat-long grid, and next to all of these.
inline std::vector<Normal> hard_normals(const acdf::compress::NormalBins& bins, std::uint64_t seed,
                                        std::size_t random_ones) {
    std::mt19937_64 random(seed);
    std::vector<Normal> out;
    for (float s : {1.0f, -1.0f}) {
        out.push_back({s, 0, 0});
        out.push_back({0, s, 0});
        out.push_back({0, 0, s});
        out.push_back({s, s, s});
        out.push_back({s, -s, 0});
        out.push_back({-1, s * 0.0f, 0}); // phi = +pi and -pi
        out.push_back({-1, s * 1e-7f, 0.3f});
        out.push_back({s * 1e-20f, 0, 1});
    }
    const auto n = static_cast<int>(bins.subdivisions);
    for (int i = 0; i < 12 && n > 0; ++i) {
        const auto step = [&](int most) { return static_cast<int>(random() % (std::uint64_t(most) + 1)); };
        const int x = step(n), y = step(n - x), z = n - x - y;
        const float sx = random() % 2 ? 1.0f : -1.0f, sy = random() % 2 ? 1.0f : -1.0f;
        out.push_back({sx * static_cast<float>(x), sy * static_cast<float>(y), static_cast<float>(z)}); // corner
        if (x == 0) continue;
        out.push_back({sx * (static_cast<float>(x) - 0.5f), sy * (static_cast<float>(y) + 0.5f),
                       static_cast<float>(z)}); // the middle of an edge
        out.push_back({sx * (static_cast<float>(x) - 2.0f / 3), sy * (static_cast<float>(y) + 1.0f / 3),
                       static_cast<float>(z) + 1.0f / 3}); // of a face
    }
    for (std::uint32_t i = 0; i < 12 && n == 0; ++i) {
        Normal at;
        const double phi = kPi - 2.0 * kPi * double(i % bins.columns) / bins.columns;
        direction_of(phi, std::cos(kPi * double(i % (bins.rows + 1)) / bins.rows), at.data());
        out.push_back(at);
    }
    const std::size_t count = out.size();
    for (std::size_t i = 0; i < count; ++i) {
        Normal near = out[i];
        for (float& v : near) v += static_cast<float>(1e-6 * (uniform(random) - 0.5));
        out.push_back(near);
    }
    for (std::size_t i = 0; i < random_ones; ++i) out.push_back(random_direction(random));
    return out;
}

// ---- maps -----------------------------------------------------------------------------------------------

/// Lights of a few texels, of very different strength, over a dim sky.
inline acdf::compress::Target suns_target(std::uint32_t columns, std::uint32_t rows) {
    return texel_target(columns, rows, [=](std::uint32_t c, std::uint32_t r) {
        const double sky = smooth_sky(centre_phi(c, columns), centre_z(r, rows));
        const auto near = [&](double column, double row) {
            return std::fabs(c + 0.5 - column * columns) < 2.0 && std::fabs(r + 0.5 - row * rows) < 1.5;
        };
        return near(0.3, 0.3) ? 2e5 * sky : near(0.8, 0.51) ? 3e3 * sky : near(0.55, 0.04) ? 1e4 * sky : sky;
    });
}

/// A real probe, its texels averaged `by` x `by`; nothing where it is absent.
inline std::optional<acdf::compress::Target> probe_target(const std::string& name, int by) {
    const std::string path = std::string(acdf_test::kTestData) + "/probes/" + name;
    if (!std::filesystem::exists(path)) return std::nullopt;
    acdf::input::ProbeOptions options;
    if (name == "grace_probe.hdr") options.projection = acdf::input::Projection::angular;
    const acdf::input::Probe probe = acdf::input::read_probe(path, options);
    const int columns = probe.width / by, rows = probe.height / by;
    std::vector<float> rgb(std::size_t(3) * std::size_t(columns) * std::size_t(rows));
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c)
            for (int k = 0; k < 3; ++k) {
                double sum = 0.0;
                for (int y = r * by; y < (r + 1) * by; ++y)
                    for (int x = c * by; x < (c + 1) * by; ++x)
                        sum += static_cast<double>(
                            std::max(0.0f, probe.rgb[std::size_t(3 * (y * probe.width + x) + k)]));
                rgb[std::size_t(3 * (r * columns + c) + k)] = static_cast<float>(sum / (by * by));
            }
    return acdf::compress::environment_target(rgb.data(), std::uint32_t(columns), std::uint32_t(rows), {});
}

} // namespace acdf_test
