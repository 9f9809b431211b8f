// Several maps in one file where their numbers end: brightness, coordinates, sizes, suns that are all the light.
#include <acdf/builder.h>
#include <acdf/indexed/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

namespace builder = acdf::builder;

struct ExtremeMaps {
    const char* what;
    std::uint32_t width, height;
    std::vector<float> light; ///< of each map, of one of its texels
    float rest;               ///< of all others
    std::vector<double> coordinates;
};

/// Samples have finite pdfs, which are told again, at the maps, between and beyond.
void expect_right(const acdf::IndexedEnvironment& maps, const std::vector<double>& coordinates, const char* what) {
    std::vector<double> places = coordinates;
    for (std::size_t i = 1; i < coordinates.size(); ++i)
        for (const double part : {0.25, 0.5, 0.875})
            places.push_back((1.0 - part) * coordinates[i - 1] + part * coordinates[i]);
    places.insert(places.end(),
                  {-std::numeric_limits<double>::infinity(), std::nan(""), std::numeric_limits<double>::max()});
    for (const double place : places) {
        const acdf::MixedEnvironment sky = maps.at(place);
        EXPECT_GT(sky.total(), 0.0) << what << ' ' << place;
        for (int i = 0; i < 64; ++i) {
            const acdf::DirectionSample s = sky.sample(i / 63.0, std::fmod(0.618 * i, 1.0));
            ASSERT_TRUE(s.pdf > 0.0f && std::isfinite(s.pdf)) << what << ' ' << place << ' ' << i;
            ASSERT_EQ(sky.pdf(s.direction), s.pdf) << what << ' ' << place << ' ' << i;
        }
    }
}

TEST(ExtremeMapsTest, AreMadeAndSampled) {
    const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
    const ExtremeMaps all[] = {
        {"one texel", 1, 1, {1.0f, 2.0f}, 1.0f, {0.0, 1.0}},
        {"two texels", 2, 1, {1.0f, 2.0f, 3.0f}, 1.0f, {0.0, 1.0, 2.0}},
        {"one row", 4096, 1, {100.0f, 5.0f}, 1.0f, {0.0, 1.0}},
        {"one column", 1, 512, {100.0f, 5.0f}, 1.0f, {0.0, 1.0}},
        {"faint beside bright", 32, 16, {1e-30f, 1e30f, 1.0f}, 1e-34f, {0.0, 1.0, 2.0}},
        {"all light in a texel", 32, 16, {1e6f, 1e6f}, 0.0f, {0.0, 1.0}},
        {"far coordinates", 32, 16, {50.0f, 60.0f, 70.0f}, 1.0f, {-most, 0.0, most}},
        {"the whole line", 32, 16, {50.0f, 60.0f}, 1.0f, {-most, most}},
        {"near coordinates", 32, 16, {50.0f, 60.0f, 70.0f}, 1.0f, {0.0, least, 2.0 * least}},
    };
    for (const ExtremeMaps& extreme : all) {
        std::vector<std::vector<float>> rgb;
        std::vector<builder::Pixels> maps;
        for (std::size_t i = 0; i < extreme.light.size(); ++i) {
            rgb.emplace_back(std::size_t{3} * extreme.width * extreme.height, extreme.rest);
            const std::size_t lit = 3 * ((rgb[i].size() / 3) * (2 * i + 1) / (2 * extreme.light.size()));
            for (std::size_t k = 0; k < 3; ++k) rgb[i][lit + k] = extreme.light[i];
        }
        for (const std::vector<float>& map : rgb) {
            maps.emplace_back();
            maps.back().data = map.data();
            maps.back().width = extreme.width, maps.back().height = extreme.height;
        }
        builder::IndexedOptions options;
        options.axes = {{"at", extreme.coordinates}};
        options.goal = builder::Goal::of_budget(16 << 10);
        for (const AcdfFilter filter : {ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR}) {
            options.target.filter = filter;
            builder::IndexedFile made;
            const builder::Status status = builder::indexed(maps, options, made);
            ASSERT_TRUE(status.ok()) << extreme.what << ": " << status.message;
            acdf::File file;
            const acdf::Status loaded = acdf::File::from_memory(made.bytes.data(), made.bytes.size(), file);
            ASSERT_TRUE(loaded.ok()) << extreme.what << ": " << loaded.message;
            acdf::IndexedEnvironment stored;
            ASSERT_TRUE(acdf::IndexedEnvironment::open(file, stored).ok()) << extreme.what;
            expect_right(stored, extreme.coordinates, extreme.what);
            for (const builder::MapAccuracy& accuracy : made.accuracy)
                EXPECT_EQ(accuracy.support_violations, 0u) << extreme.what;
        }
    }
}

} // namespace
