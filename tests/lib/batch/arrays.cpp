// The symbols of acdf/batch/batch_c.h give what those of acdf/linked.h give, and nothing for files of other kinds.
#include <acdf/acdf.h>
#include <acdf/batch/batch_c.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace {

constexpr std::size_t kCount = 1000;

using File = std::unique_ptr<AcdfFile, decltype(&acdf_close)>;

File golden(const char* name) {
    return {acdf_open((std::string(ACDF_TEST_DIR "/golden/v1.0/") + name + ".acdf").c_str(), nullptr), acdf_close};
}

/// Unit vectors; `least` is the smallest z.
std::vector<float> directions(double least) {
    std::vector<float> out;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double z = least + (1.0 - least) * (static_cast<double>(i) + 0.5) / kCount;
        const double phi = 2.399963 * static_cast<double>(i), r = std::sqrt(1.0 - z * z);
        for (double x : {r * std::cos(phi), r * std::sin(phi), z}) out.push_back(static_cast<float>(x));
    }
    return out;
}

std::vector<double> numbers() {
    std::vector<double> u;
    for (std::size_t i = 0; i < kCount; ++i) {
        u.push_back((static_cast<double>(i) + 0.5) / kCount);
        u.push_back(std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0));
    }
    return u;
}

/// What is sampled and evaluated; more than is asked for, which stays as it is.
struct Results {
    std::vector<float> w = std::vector<float>(3 * kCount, -7.0f), p = std::vector<float>(kCount, -7.0f),
                       again = std::vector<float>(kCount, -7.0f);
    bool operator==(const Results& other) const {
        return std::memcmp(w.data(), other.w.data(), 12 * kCount) == 0 &&
               std::memcmp(p.data(), other.p.data(), 4 * kCount) == 0 &&
               std::memcmp(again.data(), other.again.data(), 4 * kCount) == 0;
    }
};

TEST(BatchArrays, OfLocalEnvironmentsAreThoseOfSingleCalls) {
    const File file = golden("local");
    ASSERT_TRUE(file);
    const std::vector<double> u = numbers();
    const std::vector<float> normals = directions(-1.0);
    for (const std::size_t each : {std::size_t{1}, std::size_t{7}, std::size_t{300}, kCount}) {
        for (const std::size_t count : {kCount, std::size_t{1}, std::size_t{0}}) {
            Results single, batch;
            ASSERT_EQ(acdf_sample_local_array(file.get(), normals.data(), each, u.data(), count, single.w.data(),
                                              single.p.data()),
                      1);
            ASSERT_EQ(
                acdf_pdf_local_array(file.get(), normals.data(), each, single.w.data(), count, single.again.data()),
                1);
            ASSERT_EQ(acdf_local_batch_sample(file.get(), normals.data(), each, u.data(), count, batch.w.data(),
                                              batch.p.data()),
                      1);
            ASSERT_EQ(
                acdf_local_batch_pdf(file.get(), normals.data(), each, batch.w.data(), count, batch.again.data()),
                1);
            EXPECT_TRUE(single == batch) << each << ' ' << count;
        }
    }
}

TEST(BatchArrays, WriteNothingOfOtherKinds) {
    const File environment = golden("zlib"), local = golden("local");
    ASSERT_TRUE(environment && local);
    const std::vector<double> u = numbers();
    const std::vector<float> w = directions(-1.0);
    Results untouched, results;
    EXPECT_EQ(acdf_local_batch_sample(environment.get(), w.data(), 1, u.data(), kCount, results.w.data(),
                                      results.p.data()),
              0);
    EXPECT_EQ(
        acdf_local_batch_sample(local.get(), w.data(), 0, u.data(), kCount, results.w.data(), results.p.data()), 0);
    EXPECT_EQ(acdf_local_batch_pdf(environment.get(), w.data(), 1, w.data(), kCount, results.p.data()), 0);
    EXPECT_TRUE(untouched == results);
}

} // namespace
