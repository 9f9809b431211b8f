// The symbols of acdf/arrays/arrays.h give what the inline functions give, and nothing for files of other kinds.
#include "tests/lib/curves/open.h"

#include <acdf/acdf.h>
#include <acdf/arrays/arrays.h>
#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace arrays_test {
namespace {

using Handle = std::unique_ptr<AcdfFile, decltype(&acdf_close)>;

std::string golden(const char* name) { return std::string(ACDF_TEST_DIR "/golden/v1.0/") + name + ".acdf"; }

constexpr std::size_t kCount = 1000, kEach = 7;

/// The same file through both interfaces, random numbers, and directions all over the sphere.
struct Both {
    explicit Both(const std::string& path) : handle(acdf_test::open_in_c(path.c_str()), acdf_close), u(2 * kCount) {
        EXPECT_TRUE(handle) << path;
        EXPECT_TRUE(acdf::File::open(path.c_str(), file, acdf::with_curves()).ok());
        for (std::size_t i = 0; i < kCount; ++i) {
            u[2 * i] = (static_cast<double>(i) + 0.5) / kCount;
            u[2 * i + 1] = std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0);
        }
    }
    /// Unit vectors; `least` is the smallest z.
    static std::vector<float> directions(std::size_t count, double least) {
        std::vector<float> out;
        for (std::size_t i = 0; i < count; ++i) {
            const double z = least + (1.0 - least) * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
            const double phi = 2.399963 * static_cast<double>(i), r = std::sqrt(1.0 - z * z);
            for (double x : {r * std::cos(phi), r * std::sin(phi), z}) out.push_back(static_cast<float>(x));
        }
        return out;
    }

    Handle handle;
    acdf::File file;
    std::vector<double> u;
    std::vector<float> w = std::vector<float>(3 * kCount, -7.0f), p = std::vector<float>(kCount, -7.0f);
};

void expect_same(const acdf::DirectionSample& sample, const float* direction, float pdf, std::size_t i) {
    EXPECT_EQ(std::memcmp(sample.direction, direction, sizeof sample.direction), 0) << i;
    EXPECT_EQ(sample.pdf, pdf) << i;
}

void expect_environment_arrays(const char* name) {
    SCOPED_TRACE(name);
    Both both(golden(name));
    const acdf::EnvironmentView sky = both.file.environment();
    const AcdfFile* file = both.handle.get();
    ASSERT_EQ(acdf_sample_environment_array(file, both.u.data(), kCount, both.w.data(), both.p.data()), 1);
    for (std::size_t i = 0; i < kCount; ++i) {
        float one[3];
        expect_same(sky.sample(both.u[2 * i], both.u[2 * i + 1]), &both.w[3 * i], both.p[i], i);
        EXPECT_EQ(acdf_sample_environment(file, both.u[2 * i], both.u[2 * i + 1], one), both.p[i]);
        EXPECT_EQ(std::memcmp(one, &both.w[3 * i], sizeof one), 0);
    }
    std::vector<float> asked = Both::directions(kCount, -1.0);
    asked[0] = NAN;
    std::vector<double> u(2 * kCount);
    ASSERT_EQ(acdf_pdf_environment_array(file, asked.data(), kCount, both.p.data()), 1);
    ASSERT_EQ(acdf_invert_environment_array(file, asked.data(), kCount, u.data()), 1);
    EXPECT_EQ(both.p[0], 0.0f);
    EXPECT_TRUE(std::isnan(u[0]) && std::isnan(u[1]));
    for (std::size_t i = 0; i < kCount; ++i) {
        double expected[2];
        EXPECT_EQ(sky.pdf(&asked[3 * i]), both.p[i]) << i;
        EXPECT_EQ(acdf_pdf_environment(file, &asked[3 * i]), both.p[i]) << i;
        if (sky.invert(&asked[3 * i], expected)) {
            EXPECT_EQ(std::memcmp(expected, &u[2 * i], sizeof expected), 0);
        }
    }
}

TEST(Arrays, environments) {
    for (const char* name : {"halvings", "halvings_octahedral", "zlib"}) expect_environment_arrays(name);
}

// Several samples a normal, and one.
void expect_local_arrays(const char* name, std::size_t each) {
    SCOPED_TRACE(name);
    Both both(golden(name));
    const acdf::LocalEnvironmentView sky = both.file.local();
    const AcdfFile* file = both.handle.get();
    const std::vector<float> normals = Both::directions(kCount / each + 1, -1.0);
    ASSERT_EQ(
        acdf_sample_local_array(file, normals.data(), each, both.u.data(), kCount, both.w.data(), both.p.data()),
        1);
    std::vector<float> again(kCount);
    ASSERT_EQ(acdf_pdf_local_array(file, normals.data(), each, both.w.data(), kCount, again.data()), 1);
    std::vector<double> lit(kCount / each);
    ASSERT_EQ(acdf_irradiance_local_array(file, normals.data(), lit.size(), lit.data()), 1);
    for (std::size_t i = 0; i < kCount; ++i) {
        const float* normal = &normals[3 * (i / each)];
        float one[3] = {0.0f, 0.0f, 0.0f};
        expect_same(sky.sample(normal, both.u[2 * i], both.u[2 * i + 1]), &both.w[3 * i], both.p[i], i);
        EXPECT_EQ(acdf_sample_local(file, normal, both.u[2 * i], both.u[2 * i + 1], one), both.p[i]);
        EXPECT_EQ(std::memcmp(one, &both.w[3 * i], sizeof one), 0);
        EXPECT_EQ(again[i], sky.pdf(normal, &both.w[3 * i]));
        EXPECT_EQ(again[i], acdf_pdf_local(file, normal, &both.w[3 * i]));
        if (i / each < lit.size()) {
            EXPECT_EQ(lit[i / each], sky.irradiance(normal));
        }
    }
}

TEST(Arrays, localEnvironmentsServeSeveralSamplesANormal) {
    for (const char* name : {"local", "local_grid"}) expect_local_arrays(name, kEach);
}
TEST(Arrays, localEnvironmentsServeANormalASample) {
    for (const char* name : {"local", "local_grid"}) expect_local_arrays(name, 1);
}

TEST(Arrays, brdfs) {
    for (const char* name : {"brdf", "brdf_anisotropic", "brdf_floor", "brdf_mirrored", "brdf_separate"}) {
        Both both(golden(name));
        const acdf::BrdfView brdf = both.file.brdf();
        const AcdfFile* file = both.handle.get();
        for (std::size_t each : {std::size_t{1}, kEach, kCount}) {
            const std::vector<float> views = Both::directions(kCount, 0.0);
            std::vector<float> densities(kCount);
            std::vector<double> u(2 * kCount), albedos(kCount);
            acdf_sample_brdf_array(file, views.data(), each, both.u.data(), kCount, both.w.data(), both.p.data());
            acdf_pdf_brdf_array(file, views.data(), each, both.w.data(), kCount, densities.data());
            acdf_invert_brdf_array(file, views.data(), each, both.w.data(), kCount, u.data());
            acdf_albedo_brdf_array(file, views.data(), kCount, albedos.data());
            for (std::size_t i = 0; i < kCount; ++i) {
                const float* wo = &views[3 * (i / each)];
                double expected[2];
                expect_same(brdf.sample(wo, both.u[2 * i], both.u[2 * i + 1]), &both.w[3 * i], both.p[i], i);
                EXPECT_EQ(densities[i], brdf.pdf(wo, &both.w[3 * i]));
                EXPECT_EQ(acdf_pdf_brdf(file, wo, &both.w[3 * i]), densities[i]);
                EXPECT_EQ(brdf.invert(wo, &both.w[3 * i], expected), !std::isnan(u[2 * i]));
                if (!std::isnan(u[2 * i])) {
                    EXPECT_EQ(expected[0], u[2 * i]);
                }
                EXPECT_EQ(albedos[i], brdf.albedo(&views[3 * i]));
            }
        }
    }
}

TEST(Arrays, tables) {
    Both both(std::string(ACDF_TEST_DIR "/../format/vectors/table.acdf"));
    const acdf::TableView table = both.file.table();
    const AcdfFile* file = both.handle.get();
    const std::uint32_t sampled = acdf_table_sampled_axes(file), indexed = acdf_table_indexed_axes(file);
    ASSERT_EQ(sampled, table.sampled_count());
    ASSERT_EQ(indexed, table.indexed_count());
    std::vector<double> random(sampled * kCount);
    for (std::size_t i = 0; i < random.size(); ++i)
        random[i] = std::fmod(0.6180339887498949 * static_cast<double>(i), 1.0);
    std::vector<std::uint32_t> index(std::size_t{indexed} * kCount, 0);
    for (std::size_t i = 0; i < index.size(); ++i) index[i] = i % 3 == 1 ? 1 : i == 9 ? 99 : 0;
    std::vector<double> x(sampled * kCount), p(kCount), again(kCount), u(sampled * kCount);
    ASSERT_EQ(acdf_sample_table_array(file, index.data(), kEach, random.data(), kCount, x.data(), p.data()), 1);
    ASSERT_EQ(acdf_pdf_table_array(file, index.data(), kEach, x.data(), kCount, again.data()), 1);
    ASSERT_EQ(acdf_invert_table_array(file, index.data(), kEach, x.data(), kCount, u.data()), 1);
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
        const std::uint32_t* at = index.data() + std::size_t{indexed} * (i / kEach);
        double one[ACDF_MAX_AXES];
        const double pdf = table.sample(at, &random[sampled * i], one);
        EXPECT_EQ(pdf, p[i]);
        EXPECT_EQ(acdf_sample_table(file, at, &random[sampled * i], one), pdf);
        if (pdf > 0.0) {
            ++drawn;
            EXPECT_EQ(std::memcmp(one, &x[sampled * i], 8 * sampled), 0);
            EXPECT_EQ(again[i], pdf);
            EXPECT_EQ(acdf_pdf_table(file, at, one), pdf);
            EXPECT_NEAR(u[sampled * i], random[sampled * i], 1e-6);
        } else {
            EXPECT_TRUE(std::isnan(x[sampled * i]) && std::isnan(u[sampled * i]));
        }
    }
    EXPECT_GT(drawn, kCount / 2);
}

TEST(Arrays, otherKindsAreRefused) {
    const Both sky(golden("zlib")), brdf(golden("brdf"));
    float w[3] = {0.0f, 0.0f, 1.0f}, p = -7.0f;
    double u[2] = {0.5, 0.5}, x[2] = {-7.0, -7.0};
    const AcdfFile *e = sky.handle.get(), *b = brdf.handle.get();
    EXPECT_EQ(acdf_sample_environment_array(b, u, 1, w, &p), 0);
    EXPECT_EQ(acdf_pdf_environment_array(b, w, 1, &p), 0);
    EXPECT_EQ(acdf_invert_environment_array(b, w, 1, x), 0);
    EXPECT_EQ(acdf_sample_local_array(e, w, 1, u, 1, w, &p), 0);
    EXPECT_EQ(acdf_pdf_local_array(e, w, 1, w, 1, &p), 0);
    EXPECT_EQ(acdf_irradiance_local_array(e, w, 1, x), 0);
    EXPECT_EQ(acdf_sample_brdf_array(e, w, 1, u, 1, w, &p), 0);
    EXPECT_EQ(acdf_pdf_brdf_array(e, w, 1, w, 1, &p), 0);
    EXPECT_EQ(acdf_invert_brdf_array(e, w, 1, w, 1, x), 0);
    EXPECT_EQ(acdf_albedo_brdf_array(e, w, 1, x), 0);
    EXPECT_EQ(acdf_sample_table_array(e, nullptr, 1, u, 1, x, x), 0);
    EXPECT_EQ(acdf_pdf_table_array(e, nullptr, 1, u, 1, x), 0);
    EXPECT_EQ(acdf_invert_table_array(e, nullptr, 1, u, 1, x), 0);
    EXPECT_EQ(p, -7.0f);
    EXPECT_EQ(x[0], -7.0);
    EXPECT_EQ(acdf_sample_environment(b, 0.5, 0.5, w), 0.0f);
    EXPECT_EQ(acdf_pdf_environment(b, w), 0.0f);
    EXPECT_EQ(acdf_sample_local(e, w, 0.5, 0.5, w), 0.0f);
    EXPECT_EQ(acdf_pdf_local(e, w, w), 0.0f);
    EXPECT_EQ(acdf_sample_brdf(e, w, 0.5, 0.5, w), 0.0f);
    EXPECT_EQ(acdf_pdf_brdf(e, w, w), 0.0f);
    EXPECT_EQ(acdf_sample_table(e, nullptr, u, x), 0.0);
    EXPECT_EQ(acdf_pdf_table(e, nullptr, u), 0.0);
    EXPECT_EQ(acdf_table_sampled_axes(e), 0u);
}

TEST(Arrays, noItemsAConditionAreRefused) {
    const Both light(golden("local")), brdf(golden("brdf")),
        table(std::string(ACDF_TEST_DIR "/../format/vectors/table.acdf"));
    const std::vector<float> up = {0.0f, 0.0f, 1.0f};
    std::vector<float> w = Both::directions(4, 0.1), p(4, -7.0f);
    std::vector<double> u(24, 0.5), x(24, -7.0);
    const std::uint32_t index[ACDF_MAX_AXES] = {};
    const AcdfFile *l = light.handle.get(), *b = brdf.handle.get(), *t = table.handle.get();
    const std::vector<float> as_it_was = w;
    EXPECT_EQ(acdf_sample_local_array(l, up.data(), 0, u.data(), 4, w.data(), p.data()), 0);
    EXPECT_EQ(acdf_pdf_local_array(l, up.data(), 0, w.data(), 4, p.data()), 0);
    EXPECT_EQ(acdf_sample_brdf_array(b, up.data(), 0, u.data(), 4, w.data(), p.data()), 0);
    EXPECT_EQ(acdf_pdf_brdf_array(b, up.data(), 0, w.data(), 4, p.data()), 0);
    EXPECT_EQ(acdf_invert_brdf_array(b, up.data(), 0, w.data(), 4, x.data()), 0);
    EXPECT_EQ(acdf_sample_table_array(t, index, 0, u.data(), 4, x.data(), x.data() + 20), 0);
    EXPECT_EQ(acdf_pdf_table_array(t, index, 0, u.data(), 4, x.data()), 0);
    EXPECT_EQ(acdf_invert_table_array(t, index, 0, u.data(), 4, x.data()), 0);
    EXPECT_EQ(w, as_it_was);
    EXPECT_EQ(p, std::vector<float>(4, -7.0f));
    EXPECT_EQ(x, std::vector<double>(24, -7.0));
}

TEST(Arrays, anIndexThatIsMissingIsRefused) {
    const Both table(std::string(ACDF_TEST_DIR "/../format/vectors/table.acdf"));
    const AcdfFile* const t = table.handle.get();
    ASSERT_GT(acdf_table_indexed_axes(t), 0u);
    double u[ACDF_MAX_AXES] = {0.5, 0.5, 0.5}, x[ACDF_MAX_AXES] = {-7.0}, p = -7.0;
    EXPECT_EQ(acdf_sample_table(t, nullptr, u, x), 0.0);
    EXPECT_EQ(acdf_pdf_table(t, nullptr, u), 0.0);
    EXPECT_EQ(acdf_sample_table_array(t, nullptr, 1, u, 1, x, &p), 0);
    EXPECT_EQ(acdf_pdf_table_array(t, nullptr, 1, u, 1, &p), 0);
    EXPECT_EQ(acdf_invert_table_array(t, nullptr, 1, u, 1, x), 0);
    EXPECT_EQ(x[0], -7.0);
    EXPECT_EQ(p, -7.0);
}

} // namespace
} // namespace arrays_test
