// docs/examples/pbrt: what pbrt would sample, in its own frame, with its own calls.
#include "infinite_light.h"
#include "tests/inputs/folder.h"

#include <acdf/builder.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace pbrt;
namespace builder = acdf::builder;

constexpr int side = 32;

/// An octahedral sky, brighter upwards, with a lamp.
std::vector<float> sky() {
    std::vector<float> rgb(3 * side * side);
    for (int i = 0; i < side * side; ++i)
        for (int c = 0; c < 3; ++c)
            rgb[static_cast<std::size_t>(3 * i + c)] =
                0.2f + (i % side > 12 && i / side > 14) + (i == 300 ? 300.0f : 0.0f);
    return rgb;
}

builder::Pixels octahedral(const std::vector<float>& rgb) {
    builder::Pixels pixels;
    pixels.data = rgb.data();
    pixels.width = pixels.height = side;
    pixels.projection = builder::Projection::octahedral;
    return pixels;
}

class PbrtLight : public testing::Test {
protected:
    std::string environment_file(AcdfPartnerKind partner) const {
        const std::vector<float> rgb = sky();
        builder::EnvironmentOptions options;
        options.mis.kind = partner;
        builder::Environment made;
        EXPECT_TRUE(builder::environment(octahedral(rgb), options, made).ok());
        return written(made.bytes, "environment.acdf");
    }

    std::string local_file(AcdfPartnerKind partner) const {
        const std::vector<float> rgb = sky();
        builder::LocalOptions options;
        options.goal = builder::Goal::of_budget(64 << 10);
        options.mis.kind = partner;
        builder::Local made;
        EXPECT_TRUE(builder::local(octahedral(rgb), options, made).ok());
        return written(made.bytes, "local.acdf");
    }

private:
    std::string written(const std::vector<std::uint8_t>& bytes, const char* name) const {
        acdf::test::write_text(folder_ / name, std::string(bytes.begin(), bytes.end()));
        return folder_ / name;
    }

    const acdf::test::Folder folder_;
};

const SurfaceInteraction vertex = {{0.2f, 0.1f, 0.5f}, {0.6f, 0.0f, -0.8f}, {-0.6f, 0.0f, 0.8f}};

/// The pdf of each sample is that of its direction; returns the mean of 1/pdf, the solid angle that samples reach.
double expect_agreement(const ImageInfiniteLight& light, const LightSampleContext& context, bool incomplete) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform;
    const int count = 40000;
    double solid_angle = 0.0;
    for (int i = 0; i < count; ++i) {
        const float u0 = uniform(random), u1 = uniform(random);
        const std::optional<LightSample> s = light.SampleLi(context, {u0, u1}, incomplete);
        if (!s) continue;
        EXPECT_NEAR(light.PDF_Li(context, s->w, incomplete) / s->pdf, 1.0, 1e-5) << i;
        solid_angle += 1.0 / static_cast<double>(s->pdf) / count;
    }
    return solid_angle;
}

TEST_F(PbrtLight, SamplesAnEnvironmentAndBuildsNoTables) {
    const ImageInfiniteLight light = create_infinite({environment_file(ACDF_PARTNER_NONE)}, {});
    EXPECT_FALSE(light.has_tables);
    EXPECT_NEAR(expect_agreement(light, vertex, false), 4 * M_PI, 0.5);
    const std::optional<LightSample> ray = light.SampleLe({0.3f, 0.6f});
    ASSERT_TRUE(ray);
    Float pdf = 0;
    light.PDF_Le(ray->w, &pdf);
    EXPECT_NEAR(pdf / ray->pdf, 1.0, 1e-5);
}

TEST_F(PbrtLight, SamplesTheSideOfALocalFileThatTheViewerSees) {
    const std::string path = local_file(ACDF_PARTNER_NONE);
    const Transform transform = {{0.5f, 2.0f, -1.0f}};
    const ImageInfiniteLight light(transform, path);
    const Contexts contexts = contexts_of(vertex, {Reflection});
    for (const LightSampleContext& context : contexts.of) {
        EXPECT_EQ(context.ns.x, -0.6f); // turned to the viewer
        expect_agreement(light, context, true);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> uniform;
        int above = 0;
        for (int i = 0; i < 1000; ++i) {
            const float u0 = uniform(random), u1 = uniform(random);
            const std::optional<LightSample> s = light.SampleLi(context, {u0, u1}, true);
            above += s && s->w.x * context.ns.x + s->w.y * context.ns.y + s->w.z * context.ns.z > 0;
        }
        EXPECT_GT(above, 900);
    }
    const LightSampleContext both = contexts_of(vertex, {BxDFFlags(Reflection | Transmission)}).of[0];
    EXPECT_EQ(both.ns.x, 0.0f);
    EXPECT_NEAR(expect_agreement(light, both, true), 4 * M_PI, 0.5); // the whole environment
}

TEST_F(PbrtLight, LetsNoIntegratorUseAFileForMisAlone) {
    const ImageInfiniteLight light = create_infinite({environment_file(ACDF_PARTNER_MEAN)}, {});
    expect_agreement(light, vertex, true);
    EXPECT_THROW((void)light.SampleLi(vertex, {0.5f, 0.5f}, false), std::runtime_error);
    EXPECT_THROW((void)light.SampleLe({0.5f, 0.5f}), std::runtime_error);
    // A local file has its whole environment for them.
    const ImageInfiniteLight local({}, local_file(ACDF_PARTNER_COSINE));
    expect_agreement(local, vertex, true);
    EXPECT_NEAR(expect_agreement(local, vertex, false), 4 * M_PI, 0.5);
}

TEST_F(PbrtLight, RefusesWhatIsNoLight) {
    EXPECT_THROW(create_infinite({"no_such_file.acdf"}, {}), std::runtime_error);
    EXPECT_TRUE(create_infinite({""}, {}).has_tables); // none is named: pbrt's own
}

} // namespace
