// The symbols of acdf/batch/batch_c.h give what those of acdf/linked.h give, and nothing for files of other kinds.
#include "tests/lib/batch/batches.h"
#include "tests/lib/curves/open.h"

#include <acdf/acdf.h>
#include <acdf/batch/batch_c.h>

#include <memory>
#include <string>

namespace batch_test {
namespace {

constexpr std::size_t kCount = 1000;

using File = std::unique_ptr<AcdfFile, decltype(&acdf_close)>;

File golden(const char* name) {
    return {acdf_test::open_in_c((std::string(ACDF_TEST_DIR "/golden/v1.0/") + name + ".acdf").c_str()),
            acdf_close};
}

const double* flat(const std::vector<Pair>& pairs) { return pairs[0].data(); }
const float* flat(const std::vector<Vector>& vectors) { return vectors[0].data(); }

TEST(BatchArrays, OfEnvironmentsAreThoseOfSingleCalls) {
    const std::vector<Pair> u = numbers(kCount, 1);
    const std::vector<Vector> w = directions(kCount, 2);
    for (const char* name : {"halvings", "halvings_octahedral", "zlib"}) {
        const File file = golden(name);
        ASSERT_TRUE(file);
        Results batch(kCount), single(kCount), batch_pdfs(kCount), single_pdfs(kCount);
        EXPECT_EQ(acdf_sample_environment_batch(file.get(), flat(u), kCount, batch.directions()[0], batch.pdfs()),
                  1);
        EXPECT_EQ(acdf_sample_environment_array(file.get(), flat(u), kCount, single.directions()[0], single.pdfs()),
                  1);
        EXPECT_TRUE(batch == single) << name;
        EXPECT_EQ(acdf_pdf_environment_batch(file.get(), flat(w), kCount, batch_pdfs.pdfs()), 1);
        EXPECT_EQ(acdf_pdf_environment_array(file.get(), flat(w), kCount, single_pdfs.pdfs()), 1);
        EXPECT_TRUE(batch_pdfs == single_pdfs) << name;
    }
}

/// Functions of one kind of file, each serving several calls.
using SampleArray = int (*)(const AcdfFile*, const float*, size_t, const double*, size_t, float*, float*);
using PdfArray = int (*)(const AcdfFile*, const float*, size_t, const float*, size_t, float*);

void expect_same(const char* name, SampleArray sample_batch, SampleArray sample_array, PdfArray pdf_batch,
                 PdfArray pdf_array) {
    const File file = golden(name);
    ASSERT_TRUE(file);
    const std::vector<Pair> u = numbers(kCount, 1);
    const std::vector<Vector> at = directions(kCount, 3), w = directions(kCount, 2);
    for (const std::size_t each : {std::size_t{1}, std::size_t{7}, kCount}) {
        Results batch(kCount), single(kCount), batch_pdfs(kCount), single_pdfs(kCount);
        EXPECT_EQ(sample_batch(file.get(), flat(at), each, flat(u), kCount, batch.directions()[0], batch.pdfs()),
                  1);
        EXPECT_EQ(sample_array(file.get(), flat(at), each, flat(u), kCount, single.directions()[0], single.pdfs()),
                  1);
        EXPECT_TRUE(batch == single) << name << ' ' << each;
        EXPECT_EQ(pdf_batch(file.get(), flat(at), each, flat(w), kCount, batch_pdfs.pdfs()), 1);
        EXPECT_EQ(pdf_array(file.get(), flat(at), each, flat(w), kCount, single_pdfs.pdfs()), 1);
        EXPECT_TRUE(batch_pdfs == single_pdfs) << name << ' ' << each;
    }
}

TEST(BatchArrays, OfLocalEnvironmentsAreThoseOfSingleCalls) {
    for (const char* name : {"local", "local_grid"})
        expect_same(name, acdf_sample_local_batch, acdf_sample_local_array, acdf_pdf_local_batch,
                    acdf_pdf_local_array);
}
TEST(BatchArrays, OfBrdfsAreThoseOfSingleCalls) {
    for (const char* name : {"brdf", "brdf_anisotropic", "brdf_floor", "brdf_mirrored", "brdf_separate"})
        expect_same(name, acdf_sample_brdf_batch, acdf_sample_brdf_array, acdf_pdf_brdf_batch, acdf_pdf_brdf_array);
}

/// What other kinds of file, and no calls a normal or view, leave as it is.
TEST(BatchArrays, OfOtherKindsOfFileAreRefused) {
    const std::vector<Pair> u = numbers(kCount, 1);
    const std::vector<Vector> w = directions(kCount, 2);
    const Results untouched(kCount);
    for (const char* name : {"local", "brdf", "halvings"}) {
        const File file = golden(name);
        ASSERT_TRUE(file);
        Results batch(kCount);
        float *directions = batch.directions()[0], *pdfs = batch.pdfs();
        const AcdfKind kind = acdf_kind(file.get());
        if (kind != ACDF_KIND_ENVIRONMENT) {
            EXPECT_EQ(acdf_sample_environment_batch(file.get(), flat(u), kCount, directions, pdfs), 0);
            EXPECT_EQ(acdf_pdf_environment_batch(file.get(), flat(w), kCount, pdfs), 0);
        }
        const std::size_t local = kind != ACDF_KIND_LOCAL, brdf = kind != ACDF_KIND_BRDF; // else 0 a normal
        EXPECT_EQ(acdf_sample_local_batch(file.get(), flat(w), local, flat(u), kCount, directions, pdfs), 0);
        EXPECT_EQ(acdf_pdf_local_batch(file.get(), flat(w), local, flat(w), kCount, pdfs), 0);
        EXPECT_EQ(acdf_sample_brdf_batch(file.get(), flat(w), brdf, flat(u), kCount, directions, pdfs), 0);
        EXPECT_EQ(acdf_pdf_brdf_batch(file.get(), flat(w), brdf, flat(w), kCount, pdfs), 0);
        EXPECT_TRUE(batch == untouched) << name;
    }
}

} // namespace
} // namespace batch_test
