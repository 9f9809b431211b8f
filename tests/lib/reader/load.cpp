// Loading: damage of every kind, memory of every alignment, compression, metadata, files.
#include "tests/lib/reader/load.h"
#include "tests/lib/curves/open.h"
#include "tests/lib/curves/planes.h"
#include "tests/lib/reader/files.h"
#include "tests/lib/reader/normals_builder.h"

#include <acdf/acdf.h>
#include <acdf/curves/curves.h>

#include <gtest/gtest.h>

#include <fstream>
#include <random>

using namespace acdf_test;
using acdf::File;
using acdf::Status;

namespace {

// ---- damage ---------------------------------------------------------------------------------------------

TEST(Damage, everyTruncationIsRefused) {
    for (const Bytes& file : {complete_environment().encode(), compressed().encode(), EnvironmentSpec().encode()})
        for (std::size_t size = 0; size < file.size(); ++size) {
            const Status status = load(truncated(file, size));
            ASSERT_EQ(status.rule, size < 64 ? 2001 : 2005) << size << ": " << status.message;
            ASSERT_FALSE(findings(truncated(file, size)).rules.empty());
        }
}

TEST(Damage, extraBytesAreRefused) {
    for (std::size_t extra = 1; extra <= 200; ++extra) {
        Bytes file = complete_environment().encode();
        file.resize(file.size() + extra);
        ASSERT_EQ(load(file).rule, 2005) << extra;
    }
}

// Header and table, payloads, and padding are each covered by a CRC or must be zero.
TEST(Damage, everyFlippedBitIsFound) {
    for (const Bytes& file : {complete_environment().encode(), compressed().encode(), EnvironmentSpec().encode()})
        for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
            Bytes damaged = file;
            damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ 1u << bit % 8);
            ASSERT_FALSE(load(damaged).ok()) << "byte " << bit / 8 << ", bit " << bit % 8;
        }
}

// What a malicious writer does: wrong bytes under right CRCs. Whatever is accepted can be sampled.
TEST(Damage, everyByteUnderRightCrcsIsSafe) {
    std::mt19937 rng(1);
    int accepted = 0;
    for (const Bytes& file : {complete_environment().encode(), compressed().encode()})
        for (std::size_t at = 12; at < file.size(); ++at)
            for (std::uint32_t value : {0x00u, 0x01u, 0x7Fu, 0x80u, 0xFFu, file[at] + 1u, file[at] ^ 0x10u}) {
                Bytes damaged = file;
                damaged[at] = static_cast<std::uint8_t>(value);
                seal(damaged);
                const Exact exact(damaged);
                File loaded;
                const Status status = File::from_memory(exact.data(), exact.size(), loaded, acdf::with_curves());
                ASSERT_EQ(status.ok(),
                          acdf::validate(
                              exact.data(), exact.size(), [](const acdf::Finding&) {}, acdf::with_curves())
                              .valid());
                if (!status.ok() || loaded.kind() != ACDF_KIND_ENVIRONMENT) continue;
                ++accepted;
                for (int n = 0; n < 20; ++n) {
                    const double u0 = std::generate_canonical<double, 53>(rng),
                                 u1 = std::generate_canonical<double, 53>(rng);
                    const auto s = loaded.environment().sample(u0, u1);
                    ASSERT_GT(s.pdf, 0.0f);
                    ASSERT_GT(loaded.environment().pdf(s.direction), 0.0f);
                }
            }
    EXPECT_GT(accepted, 100);
}

TEST(Damage, otherFormatsAreRefused) {
    for (const char* start : {"\x76\x2f\x31\x01", "#?RADIANCE\n", "hello", "PN"}) {
        Bytes file(start, start + std::strlen(start));
        EXPECT_EQ(load(file).rule, 2002);
        file.resize(1000);
        EXPECT_EQ(load(file).rule, 2002);
    }
}

// ---- versions -------------------------------------------------------------------------------------------

TEST(Versions, whatAnOlderReaderMustRead) {
    FileSpec spec = complete_file();
    spec.minor = 9;
    spec.chunks.insert(spec.chunks.begin(), {"xtra", {1, 2, 3}, 0, true});
    spec.chunks.push_back({"more", {}, 0, false});
    Bytes file = spec.encode();
    set(file, 32, 4, 0xFFFFFFFF); // optional features
    seal(file);
    EXPECT_TRUE(findings(file).rules.empty()) << findings(file).text;
    File loaded;
    ASSERT_TRUE(File::from_memory(file.data(), file.size(), loaded, acdf::with_curves()).ok());
    EXPECT_EQ(loaded.header().version_minor, 9);
    EXPECT_EQ(loaded.environment().data().columns, 8u);
}

TEST(Versions, errorCodesSayWhoIsToBlame) {
    const auto code_of = [](std::size_t at, int size, std::uint64_t value) {
        Bytes file = complete_file().encode();
        set(file, at, size, value);
        seal(file);
        return load(file).code;
    };
    EXPECT_EQ(code_of(12, 2, 2), ACDF_UNSUPPORTED);  // major version
    EXPECT_EQ(code_of(24, 4, 77), ACDF_UNSUPPORTED); // kind
    EXPECT_EQ(code_of(28, 4, 1), ACDF_UNSUPPORTED);  // required feature
    EXPECT_EQ(code_of(16, 8, 77), ACDF_MALFORMED);   // length
    EXPECT_EQ(static_cast<int>(ACDF_MALFORMED), 5);
    EXPECT_EQ(static_cast<int>(ACDF_UNSUPPORTED), 6);
}

TEST(Versions, otherKindsLoad) {
    const Bytes file = small_normals().encode();
    File loaded;
    ASSERT_TRUE(File::from_memory(file.data(), file.size(), loaded, acdf::with_curves()).ok());
    EXPECT_EQ(loaded.kind(), ACDF_KIND_LOCAL);
    EXPECT_EQ(loaded.description().axis_count, 3u);
    EXPECT_EQ(loaded.axis(2).role, static_cast<std::uint32_t>(ACDF_AXIS_INDEXED));
}

// ---- memory ---------------------------------------------------------------------------------------------

bool inside(const void* p, const Exact& bytes) {
    const auto* q = static_cast<const std::uint8_t*>(p);
    return q >= bytes.data() && q < bytes.data() + bytes.size();
}

// What both headers promise of alignment is what the header of a file asks for.
TEST(Memory, bothHeadersAskForTheSameAlignment) {
    for (const char* header : {"file.h", "reader.h"}) {
        std::ifstream in(std::string(ACDF_TEST_DIR "/../lib/reader/acdf/") + header);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        EXPECT_NE(text.find("aligned to " + std::to_string(alignof(AcdfHeader)) + " bytes"), std::string::npos)
            << header;
        EXPECT_EQ(text.find("aligned to 4 bytes"), std::string::npos) << header;
    }
}

TEST(Memory, usedInPlaceWhereAligned) {
    const Bytes bytes = complete_environment().encode();
    for (std::size_t shift = 0; shift <= 16; ++shift) {
        const Exact exact(bytes, shift);
        File file;
        ASSERT_TRUE(File::from_memory(exact.data(), exact.size(), file, acdf::with_curves()).ok());
        EXPECT_EQ(inside(TreeOf(file).data, exact), shift % 8 == 0) << shift;
        EXPECT_EQ(inside(&file.header(), exact), shift % 8 == 0) << shift;
        AcdfFile* c_file = acdf_test::from_memory_in_c(exact.data(), exact.size());
        ASSERT_NE(c_file, nullptr);
        EXPECT_EQ(inside(acdf_header(c_file), exact), shift % 8 == 0) << shift;
        acdf_close(c_file);
        EXPECT_EQ(TreeOf(file).units, 18u);
        EXPECT_EQ(file.size(), bytes.size());
        EXPECT_EQ(std::memcmp(&file.header(), bytes.data(), bytes.size()), 0);
        EXPECT_TRUE(findings(bytes).rules.empty());
        EXPECT_TRUE(acdf::validate(
                        exact.data(), exact.size(), [](const acdf::Finding&) {}, acdf::with_curves())
                        .valid());
    }
}

TEST(Memory, compressedIsTheSame) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        EnvironmentSpec spec = RandomTree(seed, {}).make();
        spec.metadata = {{"key", std::string(3000, 'v')}};
        const Bytes plain = spec.encode();
        spec.zlib = true;
        const Bytes packed = spec.encode();
        File a, b;
        ASSERT_TRUE(File::from_memory(plain.data(), plain.size(), a, acdf::with_curves()).ok());
        ASSERT_TRUE(File::from_memory(packed.data(), packed.size(), b, acdf::with_curves()).ok());
        ASSERT_EQ(TreeOf(a).units, TreeOf(b).units);
        EXPECT_EQ(std::memcmp(TreeOf(a).data, TreeOf(b).data, 2 * TreeOf(a).units), 0);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(TreeOf(b).data) % 64, 0u);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&b.description()) % 64, 0u);
        EXPECT_EQ(b.metadata("key").size, 3000u);
        EXPECT_EQ(b.environment().data().root, a.environment().data().root);
        for (double u : {0.1, 0.5, 0.9}) {
            const auto s = a.environment().sample(u, 1 - u), t = b.environment().sample(u, 1 - u);
            EXPECT_EQ(std::memcmp(&s, &t, sizeof s), 0);
        }
    }
}

TEST(Memory, filesMove) {
    const Bytes bytes = compressed().encode();
    File a;
    EXPECT_TRUE(a.empty());
    ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), a, acdf::with_curves()).ok());
    const acdf::EnvironmentView view = a.environment();
    const auto before = view.sample(0.3, 0.7);
    File b = std::move(a);
    EXPECT_TRUE(a.empty()); // NOLINT: that is the test
    File c;
    c = std::move(b);
    EXPECT_TRUE(b.empty()); // NOLINT
    File& same = c;
    c = std::move(same);
    ASSERT_FALSE(c.empty());
    const auto after = view.sample(0.3, 0.7); // the view's bytes moved along
    EXPECT_EQ(std::memcmp(&before, &after, sizeof before), 0);
    const Bytes bad = {1, 2, 3};
    EXPECT_FALSE(File::from_memory(bad.data(), bad.size(), c, acdf::with_curves()).ok());
    EXPECT_TRUE(c.empty()) << "a failed load leaves nothing behind";
}

TEST(Memory, limitsHold) {
    const Bytes plain = complete_environment().encode(), packed = compressed().encode();
    acdf::Limits limits;
    limits.max_file_bytes = plain.size();
    EXPECT_TRUE(load(plain, limits).ok());
    limits.max_file_bytes = plain.size() - 1;
    EXPECT_EQ(load(plain, limits).rule, 1004);
    EXPECT_EQ(findings(plain, limits).rules, std::multiset<int>{1004});
    limits = {};
    limits.max_inflated_bytes = 1;
    EXPECT_TRUE(load(plain, limits).ok()); // nothing to inflate
    EXPECT_EQ(load(packed, limits).rule, 3012);
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < 4; ++i) raw += get(packed, chunk_at(i) + 32, 8);
    limits.max_inflated_bytes = raw - 1;
    EXPECT_EQ(load(packed, limits).code, ACDF_LIMIT_EXCEEDED);
    limits.max_inflated_bytes = raw;
    EXPECT_TRUE(load(packed, limits).ok());
    FileSpec unknown = compressed().file();
    unknown.chunks.push_back({"more", Bytes(100, 7), 0, true});
    EXPECT_TRUE(load(unknown.encode(), limits).ok()); // is not inflated
}

// ---- contents -------------------------------------------------------------------------------------------

TEST(Contents, metadata) {
    const Bytes bytes = complete_environment().encode();
    File file;
    ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
    ASSERT_EQ(file.metadata_count(), 2u);
    acdf::Text key, value;
    file.metadata(1, key, value);
    EXPECT_EQ(text(key), "source.name");
    EXPECT_EQ(text(value), "härbour.exr");
    file.metadata(2, key, value);
    EXPECT_EQ(text(key), "");
    EXPECT_EQ(text(file.metadata("tool")), "test 1");
    EXPECT_EQ(file.metadata("too").data, nullptr);
    const Bytes none = EnvironmentSpec().encode();
    ASSERT_TRUE(File::from_memory(none.data(), none.size(), file, acdf::with_curves()).ok());
    EXPECT_EQ(file.metadata_count(), 0u);
    EXPECT_EQ(file.metadata("tool").data, nullptr);
}

TEST(Contents, fields) {
    EnvironmentSpec spec = complete_environment();
    spec.total = 12.5;
    const Bytes bytes = spec.encode();
    File file;
    ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
    EXPECT_EQ(file.kind(), ACDF_KIND_ENVIRONMENT);
    EXPECT_EQ(file.description().fit, static_cast<std::uint32_t>(ACDF_FIT_VARIANCE));
    EXPECT_EQ(file.description().channel_weights[1], 0.7152);
    EXPECT_EQ(file.axis(1).resolution, 8u);
    EXPECT_EQ(file.bin(0).root, 0u);
    EXPECT_EQ(file.bin(0).share, 1.0f);
    EXPECT_EQ(file.environment().total(), 12.5);
}

} // namespace
