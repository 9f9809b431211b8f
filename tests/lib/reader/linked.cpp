// The symbols of acdf/linked.h give what the inline functions give, and nothing for files of other kinds.
#include "tests/lib/curves/open.h"

#include <acdf/acdf.h>
#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace linked_test {
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

TEST(Linked, environments) {
    Both both(golden("zlib"));
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

// Several samples a normal, and one.
void expect_local_arrays(std::size_t each) {
    Both both(golden("local"));
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

TEST(Linked, localEnvironmentsServeSeveralSamplesANormal) { expect_local_arrays(kEach); }
TEST(Linked, localEnvironmentsServeANormalASample) { expect_local_arrays(1); }

TEST(Linked, brdfs) {
    for (const char* name : {"brdf", "brdf_anisotropic"}) {
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

TEST(Linked, tables) {
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

TEST(Linked, otherKindsAreRefused) {
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

TEST(Linked, noItemsAConditionAreRefused) {
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

TEST(Linked, anIndexThatIsMissingIsRefused) {
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

// ---- memory and alignment ----

/// Counts what is out; `left` calls succeed.
struct Ledger {
    std::map<void*, std::size_t> out;
    int left = 1000, wrong = 0;

    AcdfAllocator allocator() {
        return {[](void* self, size_t bytes, size_t alignment) -> void* {
                    auto& ledger = *static_cast<Ledger*>(self);
                    if (ledger.left-- <= 0) return nullptr;
                    if (alignment > 64 || bytes % alignment != 0) ++ledger.wrong;
                    void* block = std::aligned_alloc(alignment, bytes);
                    ledger.out[block] = bytes;
                    return block;
                },
                [](void* self, void* block, size_t bytes) {
                    auto& ledger = *static_cast<Ledger*>(self);
                    const auto found = ledger.out.find(block);
                    if (found == ledger.out.end() || found->second != bytes) ++ledger.wrong;
                    else ledger.out.erase(found);
                    std::free(block);
                },
                this};
    }
};

TEST(Memory, ofTheCallersAllocatorAndBackToIt) {
    for (const char* name : {"zlib", "local", "planes", "brdf"}) {
        Ledger ledger;
        AcdfLoadOptions options = {};
        options.allocator = ledger.allocator();
        options.curves = acdf_curves();
        AcdfError error;
        AcdfFile* file = acdf_open_with(golden(name).c_str(), &options, &error);
        ASSERT_TRUE(file) << error.message;
        EXPECT_GE(ledger.out.size(), 2u) << "the bytes, and the handle";
        EXPECT_GE(ledger.out.count(file), 1u);
        std::size_t bytes = 0;
        for (const auto& [block, size] : ledger.out) bytes += size;
        EXPECT_GE(bytes, acdf_size(file) + acdf_table_bytes(file));
        acdf_close(file);
        EXPECT_TRUE(ledger.out.empty()) << name;
        EXPECT_EQ(ledger.wrong, 0);
    }
}

TEST(Memory, noOptionsAreTheDefault) {
    AcdfError error;
    const Handle opened(acdf_open_with(golden("halvings_zlib").c_str(), nullptr, &error), acdf_close);
    ASSERT_TRUE(opened) << error.message;
    const Handle loaded(acdf_from_memory_with(acdf_header(opened.get()), acdf_size(opened.get()), nullptr, &error),
                        acdf_close);
    ASSERT_TRUE(loaded) << error.message;
    EXPECT_EQ(acdf_table_bytes(opened.get()), acdf_table_bytes(loaded.get()));
    EXPECT_EQ(acdf_from_memory(nullptr, 100, &error), nullptr);
    EXPECT_EQ(error.code, ACDF_MALFORMED);
}

TEST(Memory, thatIsNeverReleasedIsTheCallersToFree) {
    Ledger ledger;
    AcdfLoadOptions options = {};
    options.allocator = ledger.allocator();
    options.curves = acdf_curves();
    options.allocator.release = nullptr;
    acdf_close(acdf_open_with(golden("zlib").c_str(), &options, nullptr));
    EXPECT_GE(ledger.out.size(), 2u);
    for (const auto& [block, size] : ledger.out) std::free(block);
}

TEST(Memory, thatEndsIsAnErrorAndNotALeak) {
    int opened = 0;
    for (int left = 0; left < 6; ++left) {
        Ledger ledger;
        ledger.left = left;
        acdf::LoadOptions options;
        options.allocator = ledger.allocator();
        options.curves = acdf_curves();
        acdf::File file;
        const acdf::Status status = acdf::File::open(golden("zlib").c_str(), file, acdf::with_curves(options));
        if (left < 2) EXPECT_EQ(status.code, acdf::ErrorCode::out_of_memory) << left; // bytes; inflated chunks
        else ++opened;                                                                // tables are only for speed
        file = acdf::File();
        EXPECT_TRUE(ledger.out.empty()) << left;
        AcdfLoadOptions c_options = {};
        ledger.left = left;
        c_options.allocator = ledger.allocator();
        options.curves = acdf_curves();
        acdf_close(acdf_open_with(golden("zlib").c_str(), &c_options, nullptr));
        EXPECT_TRUE(ledger.out.empty()) << left;
    }
    EXPECT_EQ(opened, 4);
}

TEST(Memory, bothInterfacesUseBytesInPlaceAtTheSameAlignment) {
    std::ifstream in(golden("smallest"), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    alignas(64) static unsigned char room[1 << 16];
    ASSERT_LT(bytes.size() + 64, sizeof room);
    for (std::size_t shift = 0; shift < 64; ++shift) {
        const unsigned char* data = room + shift;
        std::memcpy(room + shift, bytes.data(), bytes.size());
        acdf::File file;
        ASSERT_TRUE(acdf::File::from_memory(data, bytes.size(), file, acdf::with_curves()).ok());
        const Handle handle(acdf_test::from_memory_in_c(data, bytes.size()), acdf_close);
        ASSERT_TRUE(handle);
        const bool in_place = shift % 8 == 0;
        EXPECT_EQ(static_cast<const void*>(&file.header()) == data, in_place) << shift;
        EXPECT_EQ(static_cast<const void*>(acdf_header(handle.get())) == data, in_place) << shift;
    }
}

TEST(Views, canBeMembers) {
    struct Light {
        acdf::EnvironmentView sky;
        acdf::LocalEnvironmentView local;
        acdf::BrdfView brdf;
        acdf::TableView table;
    } light;
    EXPECT_TRUE(light.sky.empty() && light.local.empty() && light.brdf.empty() && light.table.empty());
    EXPECT_EQ(light.sky.total(), 0.0);
    Both sky(golden("smallest")), local(golden("local")), brdf(golden("brdf"));
    light.sky = sky.file.environment();
    light.local = local.file.local();
    light.brdf = brdf.file.brdf();
    EXPECT_FALSE(light.sky.empty() || light.local.empty() || light.brdf.empty());
    EXPECT_GT(light.sky.sample(0.5, 0.5).pdf, 0.0f);
}

} // namespace
} // namespace linked_test
