// Memory of open files, of both interfaces.
#include "tests/lib/curves/open.h"

#include <acdf/acdf.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>

namespace allocator_test {
namespace {

using Handle = std::unique_ptr<AcdfFile, decltype(&acdf_close)>;

std::string golden(const char* name) { return std::string(ACDF_TEST_DIR "/golden/v1.0/") + name + ".acdf"; }

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
        const acdf::Status status = acdf::File::open(golden("zlib").c_str(), file, options);
        if (left < 2) EXPECT_EQ(status.code, ACDF_OUT_OF_MEMORY) << left; // bytes; inflated chunks
        else ++opened;                                                    // tables are only for speed
        file = acdf::File();
        EXPECT_TRUE(ledger.out.empty()) << left;
        AcdfLoadOptions c_options = {};
        ledger.left = left;
        c_options.allocator = ledger.allocator();
        c_options.curves = acdf_curves();
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
    acdf::File sky, local, brdf;
    ASSERT_TRUE(acdf::File::open(golden("smallest").c_str(), sky, acdf::with_curves()).ok());
    ASSERT_TRUE(acdf::File::open(golden("local").c_str(), local, acdf::with_curves()).ok());
    ASSERT_TRUE(acdf::File::open(golden("brdf").c_str(), brdf, acdf::with_curves()).ok());
    light.sky = sky.environment();
    light.local = local.local();
    light.brdf = brdf.brdf();
    EXPECT_FALSE(light.sky.empty() || light.local.empty() || light.brdf.empty());
    EXPECT_GT(light.sky.sample(0.5, 0.5).pdf, 0.0f);
}

} // namespace
} // namespace allocator_test
