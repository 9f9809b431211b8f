// The pdf of fitted local environment maps: samples follow the pdf, and it covers the light.
#include "tests/inputs/local_maps.h"
#include "tests/inputs/sanitized.h"

#include "tests/extremes/targets.h"
#include "tests/lib/compress/chi_square.h"

#include <gtest/gtest.h>

#include <map>

using namespace acdf_test;

namespace {

using namespace acdf::compress;

struct MapCase {
    const char* name;
    std::function<std::optional<Target>()> target;
    std::function<NormalBins()> bins;
    LocalFileOptions options;
};

void PrintTo(const MapCase& map, std::ostream* out) { *out << map.name; } // for GoogleTest

std::function<std::optional<Target>()> synthetic(const std::string& name) {
    return [name]() -> std::optional<Target> {
        for (NamedTarget& t : synthetic_targets())
            if (t.name == name) return std::move(t.target);
        for (NamedTarget& t : extreme_targets())
            if (t.name == name) return std::move(t.target);
        throw std::logic_error(name);
    };
}
/// The same values on the octahedral square.
std::function<std::optional<Target>()> squared(const std::string& name) {
    return [name] { return std::optional(octahedral(*synthetic(name)())); };
}
std::function<std::optional<Target>()> probe(const std::string& name, int by) {
    return [=] { return probe_target(name, by); };
}
std::function<NormalBins()> corners(std::uint32_t n) {
    return [n] { return octahedral_bins(n); };
}
std::function<NormalBins()> grid(std::uint32_t columns, std::uint32_t rows) {
    return [=] { return latlong_bins(columns, rows); };
}

// A third of the bins serves no normal.
NormalBins scene_bins() {
    NormalBins bins = octahedral_bins(4);
    std::vector<SceneNormal> scene;
    std::mt19937_64 random(9);
    for (int i = 0; i < 400; ++i) {
        const Normal n = random_direction(random);
        if (n[2] > -0.2f) scene.push_back({n, 1.0});
    }
    weigh(bins, scene);
    return bins;
}

std::vector<MapCase> map_cases() {
    return {
        {"smooth_sky", synthetic("smooth_sky"), corners(4), of_size(60, 1500)},
        {"peaky_sun", synthetic("peaky_sun"), corners(5), of_size(120, 3000)},
        {"one_lit_texel", synthetic("one_lit_texel"), corners(4), of_size(30, 400)},
        {"black_lower_hemisphere", synthetic("black_lower_hemisphere"), corners(3), of_size(80, 2000, 0.25)},
        {"checkerboard", synthetic("checkerboard"), corners(2), of_size(200, 8000)},
        {"denormals", synthetic("denormals"), corners(3), of_size(50, 1000, 0.5)},
        {"huge", synthetic("huge"), corners(3), of_size(50, 1000)},
        {"one_row", synthetic("one_row"), corners(3), of_size(20, 500)},
        {"one_column", synthetic("one_column"), corners(3), of_size(20, 500)},
        {"one_texel", synthetic("one_texel"), corners(1), of_size(5, 100)},
        {"one_tile", synthetic("odd_noise"), corners(2), of_size(1, 1000)},
        {"odd_noise", synthetic("odd_noise"), corners(6), of_size(100, 3000, 0.0625)},
        {"constant", synthetic("constant"), corners(1), of_size(40, 300)},
        {"faint_texel", synthetic("faint_texel"), corners(3), of_size(30, 400)},
        {"bright_texel_in_the_dark", synthetic("bright_texel_in_the_dark"), corners(3), of_size(60, 1000)},
        {"largest_half", synthetic("largest_half"), corners(3), of_size(60, 1000)},
        {"range_of_1e12", synthetic("range_of_1e12"), corners(3), of_size(150, 4000)},
        {"sun_at_the_pole", synthetic("sun_at_the_pole"), corners(4), of_size(80, 1500)},
        {"sun_at_the_seam", synthetic("sun_at_the_seam"), corners(4), of_size(80, 1500)},
        {"sun_at_the_horizon", synthetic("sun_at_the_horizon"), corners(4), of_size(80, 1500)},
        {"only_the_nadir", synthetic("only_the_nadir"), corners(4), of_size(60, 1000)},
        {"suns", [] { return std::optional(suns_target(256, 128)); }, corners(5), of_size(150, 3000)},
        {"suns_cosine", [] { return std::optional(suns_target(128, 64)); }, corners(4), of_size(100, 2000, 0.2)},
        {"scene", [] { return std::optional(suns_target(128, 64)); }, scene_bins, of_size(100, 2000)},
        {"separate_corners", synthetic("peaky_sun"), corners(3), of_size(0, 0, 0.0, false)},
        {"separate_grid", synthetic("black_lower_hemisphere"), grid(9, 5), of_size(0, 0, 0.125, false)},
        {"separate_paper_grid", synthetic("odd_noise"), grid(25, 10), of_size(0, 0, 0.0, false)},
        {"octahedral_sky", squared("smooth_sky"), corners(4), of_size(60, 1500)},
        {"octahedral_sun", squared("peaky_sun"), corners(5), of_size(120, 3000)},
        {"octahedral_texel", squared("one_lit_texel"), corners(4), of_size(30, 400)},
        {"octahedral_checkerboard", squared("checkerboard"), corners(2), of_size(200, 8000)},
        {"octahedral_noise", squared("odd_noise"), corners(6), of_size(100, 3000, 0.0625)},
        {"octahedral_fold", squared("sun_at_the_seam"), corners(4), of_size(80, 1500)},
        {"octahedral_corner", squared("sun_at_the_pole"), corners(4), of_size(80, 1500)},
        {"octahedral_range_of_1e12", squared("range_of_1e12"), corners(3), of_size(150, 4000)},
        {"octahedral_suns", [] { return std::optional(octahedral(suns_target(128, 128))); }, corners(5),
         of_size(150, 3000)},
        {"octahedral_scene", [] { return std::optional(octahedral(suns_target(96, 96))); }, scene_bins,
         of_size(100, 2000)},
        {"octahedral_separate", squared("peaky_sun"), corners(3), of_size(0, 0, 0.0, false)},
        {"octahedral_separate_grid", squared("black_lower_hemisphere"), grid(9, 5), of_size(0, 0, 0.125, false)},
        {"city", probe("city.exr", 8), corners(6), of_size(200, 6000)},
        {"noon_grass", probe("noon_grass_1k.hdr", 8), corners(6), of_size(200, 6000)},
        {"grace", probe("grace_probe.hdr", 8), corners(6), of_size(200, 6000)},
        {"city_cosine", probe("city.exr", 4), corners(4), of_size(300, 12000, 0.2)},
    };
}

std::vector<MapCase> fine_map_cases() {
    std::vector<MapCase> all = map_cases();
    all.erase(std::remove_if(all.begin(), all.end(),
                             [](const MapCase& c) {
                                 const std::string name = c.name;
                                 return name == "one_row" || name == "one_column" || name == "one_texel";
                             }),
              all.end());
    return all;
}

class Maps : public ::testing::TestWithParam<MapCase> {
protected:
    void SetUp() override {
        static std::map<std::string, std::unique_ptr<LocalMap>> made;
        static std::map<std::string, std::size_t> numbers;
        made_as_ = numbers.try_emplace(GetParam().name, numbers.size()).first->second;
        auto& map = made[GetParam().name];
        if (!map) {
            std::optional<Target> target = GetParam().target();
            if (!target) GTEST_SKIP() << "the probe is absent; set ACDF_TEST_DATA";
            map = std::make_unique<LocalMap>(std::move(*target), GetParam().bins(), GetParam().options);
        }
        map_ = map.get();
    }

    /// Normals to try the map with: one of `stride`, and of each map other ones. Under sanitizers a quarter of
    /// them.
    std::vector<Normal> normals(std::uint64_t seed, std::size_t random_ones, std::size_t stride = 1) const {
        const std::vector<Normal> all = hard_normals(map_->bins, seed, random_ones);
        if (kSanitized) stride *= 4;
        std::vector<Normal> out;
        for (std::size_t i = made_as_ % stride; i < all.size(); i += stride) out.push_back(all[i]);
        return out;
    }

    std::size_t made_as_ = 0; ///< the number of the map
    const LocalMap* map_ = nullptr;
};

/// Those whose texels have about one cosine each.
class FineMaps : public Maps {};

TEST_P(Maps, PdfsIntegrateToOne) {
    const auto light = map_->light_view();
    const AcdfEnvironment& env = light.data().environment;
    for (const Normal& n : normals(1, 20, 4)) {
        Sum exact, floats;
        const std::vector<double> p = square_probabilities(light, n.data());
        for (const double v : p) exact.add(v);
        for (std::uint32_t r = 0; r < env.rows; ++r)
            for (std::uint32_t c = 0; c < env.columns; ++c) {
                const Normal& d = map_->centres[map_->texel(c, r)];
                floats.add(static_cast<double>(light.pdf(n.data(), d.data())) * square_area(env, r));
            }
        const bool lit = map_->view().sample(n.data(), 0.5, 0.5).pdf > 0.0f;
        EXPECT_NEAR(exact.value(), lit ? 1.0 : 0.0, 1e-9) << n[0] << ' ' << n[1] << ' ' << n[2];
        EXPECT_NEAR(floats.value(), lit ? 1.0 : 0.0, 1e-6) << n[0] << ' ' << n[1] << ' ' << n[2];
    }
}

TEST_P(Maps, PdfOfASampleIsExact) {
    const double edges[] = {0.0, 1.0, 1.0 - 0x1p-24, 0x1p-24, -1.0, 2.0, std::nan("")};
    std::mt19937_64 random(2);
    const auto view = map_->view();
    for (const Normal& n : normals(2, 100))
        for (int i = 0; i < 200; ++i) {
            const double u0 = i < 49 ? edges[i / 7] : uniform(random), u1 = i < 49 ? edges[i % 7] : uniform(random);
            const acdf::DirectionSample s = view.sample(n.data(), u0, u1);
            ASSERT_TRUE(std::isfinite(s.pdf));
            ASSERT_EQ(view.pdf(n.data(), s.direction), s.pdf) << n[0] << ' ' << n[1] << ' ' << n[2] << ", " << i;
            if (s.pdf == 0.0f) continue;
            ASSERT_NEAR(length(s.direction), 1.0, 1e-6);
        }
}

TEST_P(Maps, LengthOfNormalsDoesNotMatter) {
    std::mt19937_64 random(3);
    const auto view = map_->view();
    for (int i = 0; i < 300; ++i) {
        const Normal n = random_direction(random), d = random_direction(random);
        const double expected = static_cast<double>(view.pdf(n.data(), d.data()));
        for (const float scale : {0x1p-66f, 0x1p-10f, 4.0f, 0x1p66f}) { // exact: others turn the normal by rounding
            const Normal scaled = {n[0] * scale, n[1] * scale, n[2] * scale};
            EXPECT_NEAR(view.pdf(scaled.data(), d.data()), expected, 1e-7 * expected) << scale;
            EXPECT_NEAR(view.irradiance(scaled.data()), view.irradiance(n.data()),
                        1e-12 * view.irradiance(n.data()));
        }
    }
}

/// Samples fall into grid squares as often as the pdf says.
TEST_P(Maps, ChiSquare) {
    const std::uint32_t samples = std::uint32_t(repeated(20000));
    const std::vector<Normal> tried = normals(4, 10, 5);
    const double significance = sidak(1e-3, static_cast<int>(tried.size() * map_cases().size()));
    const auto view = map_->view();
    const double share = view.data().cosine_share;
    const Target& target = map_->target;
    std::mt19937_64 random(4);
    for (const Normal& n : tried) {
        std::vector<double> probability = square_probabilities(view, n.data());
        const AcdfLocalPoint at = view.at(n.data());
        if (!(view.sample(at, 0.5, 0.5).pdf > 0.0f)) continue;
        for (std::uint32_t r = 0; share > 0.0 && r < target.rows; ++r)
            for (std::uint32_t c = 0; c < target.columns; ++c) {
                double& p = probability[std::size_t{r} * target.columns + c];
                p = (1.0 - share) * p + share / kPi * map_->exact.of_texel(n.data(), c, r);
            }
        std::vector<std::uint32_t> observed(probability.size(), 0);
        for (std::uint32_t i = 0; i < samples; ++i) {
            const double u0 = uniform(random), u1 = uniform(random);
            const acdf::DirectionSample s = view.sample(at, u0, u1);
            std::uint32_t square[2] = {0, 0};
            ASSERT_TRUE(find_square(target, s.direction, square));
            ++observed[std::size_t{square[1]} * target.columns + square[0]];
        }
        const ChiSquare test = chi_square(observed, probability);
        EXPECT_FALSE(test.impossible) << n[0] << ' ' << n[1] << ' ' << n[2];
        EXPECT_GT(test.p_value, significance)
            << n[0] << ' ' << n[1] << ' ' << n[2] << ": " << test.statistic << " with " << test.degrees;
    }
}

/// A direction within a texel, often at its very border.
Normal within(const Target& target, std::uint32_t column, std::uint32_t row, std::mt19937_64& random) {
    const auto place = [&] {
        const double t = uniform(random);
        return random() % 4 == 0 ? (t < 0.5 ? 1e-5 : 1.0 - 1e-5) : 1e-5 + (1.0 - 2e-5) * t;
    };
    const double down = row + place();
    return direction_at_position(target, column + place(), down);
}

/// Wherever light is above the horizon, however little, it can be sampled.
TEST_P(Maps, CoverTheLight) {
    const Target& target = map_->target;
    std::vector<std::size_t> lit, bright;
    for (std::size_t i = 0; i < target.values.size(); ++i)
        if (target.values[i] > 0.0f) lit.push_back(i);
    const float most = *std::max_element(target.values.begin(), target.values.end());
    for (std::size_t i : lit)
        if (target.values[i] > 0.1f * most) bright.push_back(i);
    const std::vector<Normal> special = hard_normals(map_->bins, 5, 0);
    std::mt19937_64 random(5);
    const auto view = map_->light_view();
    int pairs = 0, near_horizon = 0;
    while (pairs < repeated(100000)) {
        const auto& from = random() % 4 == 0 ? bright : lit;
        const std::size_t texel = from[random() % from.size()];
        const Normal d =
            within(target, std::uint32_t(texel % target.columns), std::uint32_t(texel / target.columns), random);
        if (!(map_->radiance(d.data()) > 0.0f)) continue; // carried over a border
        Normal n = random_direction(random);
        if (random() % 8 == 0) n = special[random() % special.size()];
        if (random() % 2 == 0) { // turned so that the direction is just above its horizon
            const double down = dot(n.data(), d.data()) - std::pow(10.0, -8.0 * uniform(random));
            for (std::size_t k = 0; k < 3; ++k) n[k] = static_cast<float>(double{n[k]} - down * double{d[k]});
        }
        const double cosine = dot(n.data(), d.data()) / length(n.data());
        if (!(cosine > 1e-9)) continue;
        near_horizon += cosine < 1e-3;
        ++pairs;
        ASSERT_GT(view.pdf(n.data(), d.data()), 0.0f)
            << "normal " << n[0] << ' ' << n[1] << ' ' << n[2] << ", cosine " << cosine << ", texel "
            << texel % target.columns << ' ' << texel / target.columns;
    }
    EXPECT_GT(near_horizon, pairs / 20);
}

/// The mean of f/p over samples is the irradiance: over all maps, of more than ten million of them. The standard
/// error is that of the pdf where that is larger than of the samples, which may have missed what is rare and
/// large.
TEST_P(FineMaps, EstimatesAreUnbiased) {
    const int normals = repeated(60), samples = 4500;
    const auto view = map_->view();
    std::mt19937_64 random(6);
    const std::vector<Normal> hard = hard_normals(map_->bins, 6, 60);
    for (int k = 0; k < normals; ++k) {
        const Normal& n = hard[hard.size() - 1 - std::size_t(k) % hard.size()];
        const double exact = map_->irradiance(n);
        const AcdfLocalPoint at = view.at(n.data());
        double mean = 0.0, square = 0.0;
        for (int i = 0; i < samples; ++i) {
            const double u0 = uniform(random), u1 = uniform(random);
            const acdf::DirectionSample s = view.sample(at, u0, u1);
            const double cosine = s.pdf > 0.0f ? dot(n.data(), s.direction) / length(n.data()) : 0.0;
            const double f = cosine > 0.0 ? map_->radiance(s.direction) * cosine / s.pdf : 0.0;
            mean += f / samples;
            square += f * f / samples;
        }
        const double moment = std::max(square - mean * mean, second_moment(*map_, n.data()) - exact * exact);
        const double error = std::sqrt(std::max(0.0, moment) / samples);
        EXPECT_LE(std::fabs(mean - exact), 4.5 * error + 1e-6 * exact) // any of all 2400 with a chance of 1 %
            << n[0] << ' ' << n[1] << ' ' << n[2] << ": " << mean << " for " << exact;
    }
}

TEST_P(FineMaps, IrradianceIsAboutRight) {
    const auto view = map_->view();
    std::mt19937_64 random(7);
    for (int i = 0; i < 40; ++i) {
        const Normal n = random_direction(random);
        const double told = view.irradiance(n.data()), exact = map_->irradiance(n);
        if (told == 0.0) {
            EXPECT_EQ(exact, 0.0) << "light that a normal sees is never forgotten";
            EXPECT_EQ(view.sample(n.data(), uniform(random), uniform(random)).pdf, 0.0f);
        } else if (!view.stored(n.data())) {
            EXPECT_EQ(told, view.environment().total());
        } else if (GetParam().options.sharing) {
            // Weights are root mean squares, which are no less than means, and so is what is interpolated.
            EXPECT_GE(told, 0.98 * exact);
        } else {
            EXPECT_NEAR(told, exact, 0.5 * map_->target.total); // of the bin's mean
        }
    }
}

TEST(LocalMap, IrradianceIsGoodToAFewPerCentUnderASmoothSky) {
    const LocalMap map(sphere_target(256, 128, smooth_sky), octahedral_bins(8), of_size(600, 20000));
    std::mt19937_64 random(8);
    for (int i = 0; i < 60; ++i) {
        const Normal n = random_direction(random);
        const double exact = map.irradiance(n);
        EXPECT_NEAR(map.view().irradiance(n.data()) / exact, 1.0, 0.04) << n[0] << ' ' << n[1] << ' ' << n[2];
    }
}

/// The integral of light times max(0, n . omega) is convex in n: what is mixed on a face of the octahedron is no
/// less than that of the normal, and where a sun is near the horizon of some bins alone it is much more. A bin
/// takes root mean squares of tiles, which are a few per cent above means but for tiles that its horizon crosses:
/// of these, by no more than their light times the largest cosine.
TEST(LocalMap, IrradianceIsThatOfTheBinsMixed) {
    constexpr double kTile = 0.05; // radians across tiles of suns
    const LocalMap map(suns_target(256, 128), octahedral_bins(8), of_size(600, 20000));
    struct Bin {
        double irradiance, at_horizon = 0.0;
    };
    const auto bin_of = [&](const std::array<double, 3>& normal) {
        const Normal n = {float(normal[0]), float(normal[1]), float(normal[2])};
        Bin out{map.irradiance(n)};
        for (std::size_t i = 0; i < map.centres.size(); ++i)
            if (std::abs(dot(n.data(), map.centres[i].data())) < kTile)
                out.at_horizon += double{map.target.values[i]} *
                                  square_area(map.view().data().environment, std::uint32_t(i) / map.target.columns);
        return out;
    };
    for (const Normal& n : hard_normals(map.bins, 8, 60)) {
        AcdfNormalBins around;
        ASSERT_TRUE(map.bins.find(n.data(), around));
        // Weights are those of a place on the face, as far from the centre as so many normals.
        const double far = 8.0 * length(n.data()) / double(std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]));
        double mixed = 0.0, at_horizon = 0.0;
        for (int i = 0; i < around.count; ++i) {
            const Bin bin = bin_of(map.bins.normals[around.bin[i]]);
            mixed += around.weight[i] / far * bin.irradiance;
            at_horizon += around.weight[i] / far * bin.at_horizon;
        }
        const double told = map.view().irradiance(n.data());
        EXPECT_GE(told, 0.98 * mixed) << n[0] << ' ' << n[1] << ' ' << n[2];
        EXPECT_LE(told, 1.04 * mixed + kTile * at_horizon) << n[0] << ' ' << n[1] << ' ' << n[2];
        EXPECT_GE(mixed, (1.0 - 1e-6) * map.irradiance(n)) << n[0] << ' ' << n[1] << ' ' << n[2];
    }
}

/// The cell of a direction, and where in it that lies.
struct Place {
    AcdfRange range[2] = {};
    double fraction[2] = {};

    Place(const AcdfLocal& local, const AcdfLocalPoint& point, const float direction[3]) {
        const AcdfGrid grid = acdf_environment_grid(&local.environment);
        std::uint32_t square[2];
        double position[2];
        acdf_sphere_ranges(grid.columns, grid.rows, range);
        if (!acdf_grid_square(&grid, direction, square, position)) return;
        acdf_local_find_cell(&local, &point, square, range);
        acdf_grid_fractions(&grid, direction, position, range, fraction);
    }
    bool is_in_cell_of(const Place& other) const {
        return range[0].low == other.range[0].low && range[1].low == other.range[1].low &&
               range[0].high == other.range[0].high && range[1].high == other.range[1].high;
    }
};

/// Within a cell more of a random number leads to more of its axis.
TEST_P(Maps, StrataStayStrata) {
    constexpr int steps = 400;
    const auto view = map_->light_view();
    std::mt19937_64 random(8);
    int compared = 0;
    for (int k = 0; k < 40; ++k) {
        const AcdfLocalPoint at = view.at(random_direction(random).data());
        if (at.what == ACDF_LOCAL_NOTHING) continue;
        const double other = uniform(random);
        const int axis = k % 2;
        std::optional<Place> before;
        for (int i = 0; i < steps; ++i) {
            double u[2] = {other, other};
            u[axis] = (i + 0.5) / steps;
            const Place place(view.data(), at, view.sample(at, u[0], u[1]).direction);
            if (before && place.is_in_cell_of(*before)) {
                EXPECT_GT(place.fraction[axis], before->fraction[axis] - 1e-3); // of a float's rounding
                ++compared;
            }
            before = place;
        }
    }
    EXPECT_GT(compared, 100);
}

INSTANTIATE_TEST_SUITE_P(All, Maps, ::testing::ValuesIn(map_cases()),
                         [](const auto& info) { return std::string(info.param.name); });
INSTANTIATE_TEST_SUITE_P(All, FineMaps, ::testing::ValuesIn(fine_map_cases()),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
