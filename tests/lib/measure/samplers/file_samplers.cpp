// Files and tables of BRDFs as samplers of light at points: the same pdfs, in the frame of the world.
#include "tests/inputs/brdf_files.h"
#include "tests/inputs/local_maps.h"
#include "tests/lib/measure/samplers/light_sampler_checks.h"

#include "compress/halvings/fit.h"
#include "measure/samplers/brdf_table.h"
#include "measure/samplers/light_samplers.h"
#include "measure/surface_frame.h"

#include <acdf/curves/curves.h>

namespace {

using namespace acdf::measure;
using namespace acdf_test;
using acdf::compress::Target;

std::vector<ShadingPoint> some_points() {
    std::mt19937_64 random(61);
    std::vector<ShadingPoint> out;
    for (int i = 0; i < 4; ++i) {
        const Normal n = i == 0 ? Normal{0.0f, 0.0f, -1.0f} : random_direction(random);
        Normal wo = random_direction(random);
        if (dot(n.data(), wo.data()) < 0.0)
            for (float& x : wo) x = -x;
        out.push_back(shading_point(n.data(), wo.data()));
    }
    return out;
}

/// By the same formula as the reader's callers would use it.
void to_local(const ShadingPoint& point, const float w[3], float out[3]) {
    double axis[3][3];
    for (int k = 0; k < 3; ++k) axis[2][k] = point.n[k];
    surface_frame(axis[2], axis[0], axis[1]);
    for (int i = 0; i < 3; ++i)
        out[i] = static_cast<float>(axis[i][0] * w[0] + axis[i][1] * w[1] + axis[i][2] * w[2]);
}

/// The share of samples that are taken at all.
double sampled(const LightSampler& sampler, const ShadingPoint& at) {
    const auto point = sampler.point_sampler();
    point->move_to(at);
    std::mt19937_64 random(71);
    int count = 0;
    for (int i = 0; i < 20000; ++i) {
        const double u0 = uniform(random), u1 = uniform(random);
        count += point->sample(u0, u1).pdf > 0.0f;
    }
    return count / 20000.0;
}

TEST(FileSamplers, EnvironmentAndLocalFilesSampleByTheirPdf) {
    const Target t = noise_target(64, 32, 9, 1.0);
    LocalFileOptions options;
    options.size = {40, 1500};
    const LocalMap map(t, acdf::compress::octahedral_bins(3), options);
    acdf::compress::HalvingsOptions fit;
    fit.goal.cells = 1500;
    acdf::compress::Description description = acdf::compress::environment_description(t.columns, t.rows);
    description.total = t.total;
    const std::vector<std::uint8_t> bytes =
        acdf::compress::store(acdf::compress::fit_halvings(t, fit), description);
    acdf::File environment;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), environment, acdf::with_curves()).ok());

    const LightSamplerPtr everywhere = file_sampler(environment), local = file_sampler(map.file);
    EXPECT_EQ(everywhere->bytes(), bytes.size() + environment.table_bytes());
    EXPECT_GT(map.file.table_bytes(), 0u);
    EXPECT_EQ(local->bytes(), map.bytes.size() + map.file.table_bytes());
    // Inflated chunks are in memory, too.
    const std::vector<std::uint8_t> packed =
        acdf::compress::store(acdf::compress::fit_halvings(t, fit), description, ACDF_CODEC_ZLIB);
    acdf::File inflated;
    ASSERT_TRUE(acdf::File::from_memory(packed.data(), packed.size(), inflated, acdf::with_curves()).ok());
    EXPECT_LT(packed.size(), bytes.size());
    EXPECT_GT(memory_of(inflated), packed.size() + inflated.table_bytes() + bytes.size() / 2);
    for (const ShadingPoint& point : some_points()) {
        SamplerCheck check;
        check.disagreeing = 1e-4;
        expect_samples_as_its_pdf(*everywhere, point, {t.columns, t.rows}, "environment", check);
        expect_samples_as_its_pdf(*local, point, {t.columns, t.rows}, "local", check);
        const auto own = local->point_sampler();
        own->move_to(point);
        const float w[3] = {0.6f, 0.0f, 0.8f};
        EXPECT_EQ(own->pdf(w), map.view().pdf(point.n, w));
        EXPECT_EQ(own->sample(0.3, 0.6).pdf, map.view().sample(point.n, 0.3, 0.6).pdf);
    }
}

TEST(FileSamplers, BrdfFilesSampleByTheirPdfInTheWorld) {
    const auto made = make_brdf(std::make_unique<LobeBrdf>(0.4, 0.4), budget(4096));
    const LightSamplerPtr sampler = file_sampler(made->file);
    std::mt19937_64 random(81);
    for (const ShadingPoint& point : some_points()) {
        SamplerCheck check;
        check.tolerance = 0.01; // cells of half-vectors cross bins
        check.disagreeing = 2e-3;
        check.significance = 1e-4;
        expect_samples_as_its_pdf(*sampler, point, {16, 8, 40}, "brdf", check);
        const auto own = sampler->point_sampler();
        own->move_to(point);
        float wo[3], wi[3];
        to_local(point, point.wo, wo);
        for (int i = 0; i < 200; ++i) {
            const Normal w = random_direction(random);
            to_local(point, w.data(), wi);
            const float expected = made->view().pdf(wo, wi);
            EXPECT_NEAR(own->pdf(w.data()), expected, 1e-4 * expected);
        }
        ShadingPoint below = point;
        for (float& x : below.wo) x = -x;
        own->move_to(below);
        EXPECT_EQ(own->sample(0.5, 0.5).pdf, 0.0f);
        EXPECT_EQ(own->pdf(point.n), 0.0f);
    }
}

TEST(FileSamplers, TabulatedBrdfsSampleByTheirPdfInTheWorld) {
    const LobeBrdf brdf(0.4, 0.4);
    const acdf::compress::Reflected reflected = [&](const double wo[3], const double wi[3]) {
        double rgb[3];
        brdf.evaluate(wo, wi, rgb);
        return rgb[0] * std::max(0.0, wi[2]);
    };
    const TabulatedBrdf table(reflected, true, BrdfTableKind::mean, {8, 4, 32, 16});
    const LightSamplerPtr sampler = tabulated_brdf_sampler(table);
    EXPECT_EQ(sampler->bytes(), table.bytes());
    for (const ShadingPoint& point : some_points()) {
        SamplerCheck check;
        check.tolerance = 0.02;
        check.disagreeing = 1e-3;
        check.significance = 1e-4;
        expect_samples_as_its_pdf(*sampler, point, {16, 8, 40}, "table", check, sampled(*sampler, point));
    }
}

} // namespace
