// The reader inlined into callers that round doubles to floats on the spot: views, normals and pdfs are those
// of the floats. gcc 12 forgets such a rounding where nothing holds it (acdf_as_given).
#include <acdf/brdf.h>
#include <acdf/curves/curves.h>
#include <acdf/local.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>

#if defined(__GNUC__) && !defined(__clang__)
#define ACDF_TEST_INLINED __attribute__((noinline, flatten))
#else
#define ACDF_TEST_INLINED
#endif

namespace {

constexpr int kDirections = 20000;

struct Direction {
    double exact[3];
    float given[3];
};

Direction random_direction_of(std::mt19937_64& random) {
    const auto number = [&] { return double(random() >> 11) * 0x1p-53; };
    const double z = 2.0 * number() - 1.0, r = std::sqrt(1.0 - z * z), phi = 6.28 * number();
    Direction out = {{r * std::cos(phi), r * std::sin(phi), z}, {}};
    for (int k = 0; k < 3; ++k) {
        volatile float given = static_cast<float>(out.exact[k]);
        out.given[k] = given;
    }
    return out;
}

ACDF_TEST_INLINED int view_on_the_spot(const AcdfBrdf& brdf, const double wo[3], AcdfBrdfView& out) {
    const float given[3] = {float(wo[0]), float(wo[1]), float(wo[2])};
    return acdf_brdf_view(&brdf, given, &out);
}
ACDF_TEST_INLINED float pdf_on_the_spot(const AcdfBrdf& brdf, const double wo[3], const double wi[3]) {
    const float view[3] = {float(wo[0]), float(wo[1]), float(wo[2])};
    const float given[3] = {float(wi[0]), float(wi[1]), float(wi[2])};
    return acdf_brdf_pdf(&brdf, view, given);
}
ACDF_TEST_INLINED void point_on_the_spot(const AcdfLocal& local, const double normal[3], AcdfLocalPoint& out) {
    const float given[3] = {float(normal[0]), float(normal[1]), float(normal[2])};
    acdf_local_at(&local, given, &out);
}
ACDF_TEST_INLINED float pdf_on_the_spot(const AcdfLocal& local, const double normal[3], const double wi[3]) {
    const float surface[3] = {float(normal[0]), float(normal[1]), float(normal[2])};
    const float given[3] = {float(wi[0]), float(wi[1]), float(wi[2])};
    return acdf_local_pdf(&local, surface, given);
}
ACDF_TEST_INLINED float pdf_on_the_spot(const AcdfEnvironment& environment, const double wi[3]) {
    const float given[3] = {float(wi[0]), float(wi[1]), float(wi[2])};
    return acdf_environment_pdf(&environment, given);
}

acdf::File golden_file(const std::string& name) {
    acdf::File file;
    const std::string path = ACDF_TEST_DIR "/golden/v1.0/" + name + ".acdf";
    EXPECT_TRUE(acdf::File::open(path.c_str(), file, acdf::with_curves()).ok()) << path;
    return file;
}

class InlinedBrdf : public testing::TestWithParam<const char*> {};

TEST_P(InlinedBrdf, RoundsAsItsCallerDid) {
    const acdf::File file = golden_file(GetParam());
    const AcdfBrdf brdf = file.brdf().data();
    std::mt19937_64 random(1);
    for (int i = 0; i < kDirections; ++i) {
        const Direction wo = random_direction_of(random), wi = random_direction_of(random);
        AcdfBrdfView near, far;
        ASSERT_EQ(view_on_the_spot(brdf, wo.exact, near), acdf_brdf_view(&brdf, wo.given, &far));
        ASSERT_EQ(std::memcmp(near.wo, far.wo, sizeof near.wo), 0) << i;
        ASSERT_EQ(pdf_on_the_spot(brdf, wo.exact, wi.exact), file.brdf().pdf(wo.given, wi.given)) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Golden, InlinedBrdf, testing::Values("brdf", "brdf_mirrored", "brdf_anisotropic"));

class InlinedLocal : public testing::TestWithParam<const char*> {};

TEST_P(InlinedLocal, RoundsAsItsCallerDid) {
    const acdf::File file = golden_file(GetParam());
    const AcdfLocal local = file.local().data();
    std::mt19937_64 random(2);
    for (int i = 0; i < kDirections; ++i) {
        const Direction normal = random_direction_of(random), wi = random_direction_of(random);
        AcdfLocalPoint near, far;
        point_on_the_spot(local, normal.exact, near);
        acdf_local_at(&local, normal.given, &far);
        ASSERT_EQ(std::memcmp(near.surface, far.surface, sizeof near.surface), 0) << i;
        ASSERT_EQ(near.length, far.length) << i;
        ASSERT_EQ(near.sum, far.sum) << i;
        ASSERT_EQ(pdf_on_the_spot(local, normal.exact, wi.exact), file.local().pdf(normal.given, wi.given)) << i;
        ASSERT_EQ(pdf_on_the_spot(local.environment, wi.exact), file.local().environment().pdf(wi.given)) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Golden, InlinedLocal, testing::Values("local", "local_grid"));

} // namespace
