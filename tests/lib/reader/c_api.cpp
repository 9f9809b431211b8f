// The C interface gives what the C++ one gives, and says no where there is nothing.
#include "tests/lib/curves/open.h"
#include "tests/tools/run.h"

#include <acdf/acdf.h>
#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstring>
#include <memory>

using namespace acdf::test;

namespace {

using Handle = std::unique_ptr<AcdfFile, decltype(&acdf_close)>;

std::string to_string(AcdfText text) { return text.data ? std::string(text.data, text.size) : "(none)"; }

TEST(CApi, SamplesAsTheCppInterface) {
    const auto bytes = small_environment();
    AcdfError error;
    const Handle handle(acdf_test::from_memory_in_c(bytes.data(), bytes.size(), &error), acdf_close);
    ASSERT_TRUE(handle) << error.message;
    EXPECT_EQ(error.code, ACDF_OK);
    EXPECT_STREQ(error.message, "");
    acdf::File file;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
    AcdfEnvironment sky;
    ASSERT_EQ(acdf_environment(handle.get(), &sky), 1);
    EXPECT_EQ(sky.total, file.environment().total());
    for (int i = 0; i < 100; ++i) {
        const double u0 = (i % 10 + 0.5) / 10, u1 = (i / 10 + 0.5) / 10;
        const AcdfDirectionSample a = acdf_environment_sample(&sky, u0, u1), b = file.environment().sample(u0, u1);
        EXPECT_EQ(std::memcmp(&a, &b, sizeof(a)), 0) << i;
        EXPECT_EQ(acdf_environment_pdf(&sky, a.direction), file.environment().pdf(a.direction));
    }
}

TEST(CApi, ReturnsWhatIsInside) {
    const auto bytes = small_environment();
    const Handle handle(acdf_test::from_memory_in_c(bytes.data(), bytes.size()), acdf_close);
    const AcdfFile* file = handle.get();
    ASSERT_TRUE(file);
    EXPECT_EQ(acdf_kind(file), ACDF_KIND_ENVIRONMENT);
    EXPECT_EQ(acdf_size(file), bytes.size());
    EXPECT_EQ(acdf_header(file)->file_length, bytes.size());
    EXPECT_EQ(acdf_description(file)->total, 2.5);
    ASSERT_EQ(acdf_description(file)->axis_count, 2u);
    EXPECT_EQ(acdf_axis(file, 0)->resolution, 8u);
    EXPECT_EQ(acdf_axis(file, 1)->resolution, 4u);
    EXPECT_EQ(acdf_axis(file, 2), nullptr);
    EXPECT_EQ(acdf_bin(file, 0)->share, 1.0f);
    EXPECT_EQ(acdf_bin(file, 1), nullptr);
    EXPECT_EQ(acdf_metadata_count(file), 4u);
    EXPECT_EQ(to_string(acdf_metadata_value(file, "source.name")), "sky.exr");
    EXPECT_EQ(to_string(acdf_metadata_value(file, "no.such.key")), "(none)");
    std::string keys;
    AcdfText key, value;
    for (std::uint32_t i = 0; acdf_metadata_pair(file, i, &key, &value); ++i) keys += to_string(key) + " ";
    EXPECT_EQ(keys, "accuracy.relative_variance fit.options source.name tool ");
}

TEST(CApi, NothingIsServedForNull) {
    const auto bytes = small_environment();
    const Handle handle(acdf_test::from_memory_in_c(bytes.data(), bytes.size()), acdf_close);
    AcdfEnvironment sky;
    AcdfLocal local;
    AcdfBrdf brdf;
    AcdfTable table;
    EXPECT_EQ(acdf_environment(nullptr, &sky) + acdf_local(nullptr, &local) + acdf_brdf(nullptr, &brdf) +
                  acdf_table(nullptr, &table),
              0);
    EXPECT_EQ(acdf_environment(handle.get(), nullptr), 1);
    EXPECT_EQ(acdf_local(handle.get(), nullptr), 0);
    EXPECT_EQ(acdf_metadata_value(handle.get(), nullptr).data, nullptr);
    AcdfText key, value;
    ASSERT_EQ(acdf_metadata_pair(handle.get(), 2, &key, nullptr), 1);
    EXPECT_EQ(to_string(key), "source.name");
    ASSERT_EQ(acdf_metadata_pair(handle.get(), 2, nullptr, &value), 1);
    EXPECT_EQ(to_string(value), "sky.exr");
}

TEST(CApi, ErrorsAreThoseOfTheCppInterface) {
    AcdfError error;
    EXPECT_EQ(acdf_open("/no/such/file.acdf", &error), nullptr);
    EXPECT_EQ(error.code, ACDF_CANNOT_OPEN);
    EXPECT_NE(std::string(error.message), "");
    EXPECT_EQ(acdf_open("/no/such/file.acdf", nullptr), nullptr);
    auto bytes = small_environment();
    bytes.back() = 1;
    EXPECT_EQ(acdf_test::from_memory_in_c(bytes.data(), bytes.size(), &error), nullptr);
    EXPECT_EQ(error.code, ACDF_MALFORMED);
    EXPECT_EQ(error.rule, 4002);
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
    EXPECT_STREQ(error.message, status.message);
    EXPECT_EQ(error.offset, status.offset);
    acdf_close(nullptr);
}

} // namespace
