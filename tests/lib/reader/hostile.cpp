// Files of every kind, golden ones among them, taken apart and put together wrongly: each is refused by a rule's
// number or can be sampled, with little memory and in work that is linear in its bytes. Work is counted, not timed:
// the reader's sources are compiled for this program so that each basic block calls __sanitizer_cov_trace_pc, but
// not with sanitizers (ACDF_COUNTS_WORK is 0): there the same files are only checked.
#include "tests/fuzz/sample_file.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/curves/planes.h"
#include "tests/lib/reader/brdf_builder.h"
#include "tests/lib/reader/count_allocations.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/normals_builder.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

namespace {
std::uint64_t blocks = 0;
}
extern "C" void __sanitizer_cov_trace_pc() { ++blocks; }

using namespace acdf_test;

namespace {

struct Named {
    std::string name;
    Bytes bytes;
};
void PrintTo(const Named& file, std::ostream* out) { *out << file.bytes.size() << " bytes"; }

template <class Spec>
Bytes compressed(Spec spec) {
    spec.zlib = true;
    return spec.encode();
}

std::vector<Named> good_files() {
    std::vector<Named> files = {{"table", table_file().encode()},
                                {"spare_table", spare_file().encode()},
                                {"complete", complete_environment().encode()},
                                {"planes", as_planes(preorder_environment()).encode()},
                                {"compressed_environment", compressed(complete_environment())},
                                {"compressed_local", compressed(windowed_normals())},
                                {"compressed_brdf", compressed(separate_brdf())}};
    for (const auto& entry : std::filesystem::directory_iterator(ACDF_TEST_DIR "/golden/v1.0")) {
        if (entry.path().extension() != ".acdf") continue;
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        files.push_back({"golden_" + entry.path().stem().string(), Bytes(bytes.begin(), bytes.end())});
    }
    std::sort(files.begin() + 7, files.end(), [](const Named& a, const Named& b) { return a.name < b.name; });
    return files;
}

std::uint64_t inflated_bytes(const Bytes& file) {
    std::uint64_t sum = 0;
    for (const ChunkSpec& chunk : taken_apart(file).chunks)
        sum += chunk.zlib ? chunk.raw.size() + chunk.planes_of : 0;
    return sum;
}

// The rule that refuses a file; 0: it is accepted, and then sampled. Memory is below four times what there is to
// check, and 1 MiB.
int rule_of(const Bytes& file) {
    const Exact exact(file);
    acdf::File loaded;
    acdf::Status status;
    {
        Counted counted;
        status = acdf::File::from_memory(exact.data(), exact.size(), loaded, acdf::with_curves());
    }
    const std::size_t most = 4 * file.size() + (1 << 20);
    if (bytes_taken > most) {
        EXPECT_LE(bytes_taken, most + 4 * inflated_bytes(file));
    }
    if (status.ok()) {
        sample_everything(loaded, exact.data(), exact.size());
        return 0;
    }
    EXPECT_NE(std::strstr(status.message, std::to_string(status.rule).c_str()), nullptr) << status.message;
    EXPECT_LE(status.offset, file.size());
    return status.rule;
}

class Hostile : public testing::TestWithParam<Named> {
protected:
    const Bytes& file() const { return GetParam().bytes; }
    std::size_t chunks() const { return taken_apart(file()).chunks.size(); }
    std::uint64_t offset(const Bytes& bytes, std::size_t i) const { return get(bytes, chunk_at(i) + 16, 8); }
};

TEST_P(Hostile, isGoodAsItIs) {
    EXPECT_EQ(rule_of(file()), 0);
    EXPECT_EQ(rule_of(taken_apart(file()).encode()), 0) << "what the tests below take apart and put together";
}

TEST_P(Hostile, everyTruncationAndEveryFlippedByteIsRefused) {
    for (std::size_t size = 0; size < file().size(); ++size)
        ASSERT_EQ(rule_of(Bytes(file().begin(), file().begin() + static_cast<std::ptrdiff_t>(size))),
                  size < 64 ? 2001 : 2005)
            << size;
    for (std::size_t at = 0; at < file().size(); ++at)
        for (const unsigned mask : {0x01u, 0x80u, 0xFFu}) {
            Bytes damaged = file();
            damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ mask);
            ASSERT_NE(rule_of(damaged), 0) << "byte " << at;
        }
}

TEST_P(Hostile, everyByteUnderRightCrcsIsRefusedOrSampled) {
    for (std::size_t at = 12; at < file().size(); ++at)
        for (const unsigned value : {0x00u, 0xFFu, file()[at] + 1u, file()[at] ^ 0x40u}) {
            if (acdf_test::kSanitized && (at + value) % 2 == 0) continue; // half of them, as they take long
            Bytes damaged = file();
            damaged[at] = static_cast<std::uint8_t>(value);
            seal(damaged);
            rule_of(damaged);
        }
}

TEST_P(Hostile, hugeCountsAnywhereAreRefusedOrSampled) {
    const FileSpec whole = taken_apart(file());
    for (std::size_t c = 0; c < whole.chunks.size(); ++c)
        for (std::size_t at = 0; at + 4 <= whole.chunks[c].raw.size(); at += 4)
            for (const std::uint32_t value : {0xFFFFFFFFu, 0x80000000u, 0x7FFFFFFFu, 0x00010000u}) {
                FileSpec spec = whole;
                set(spec.chunks[c].raw, at, 4, value);
                rule_of(spec.encode());
            }
}

TEST_P(Hostile, chunksDroppedOrTwice) {
    for (std::size_t c = 0; c < chunks(); ++c) {
        FileSpec without = taken_apart(file()), twice = without;
        const bool optional = without.chunks[c].type == "META" || without.chunks[c].type == "COMP" ||
                              without.chunks[c].type == "PORT" || without.chunks[c].type == "PLAC";
        without.chunks.erase(without.chunks.begin() + static_cast<std::ptrdiff_t>(c));
        const int rule = rule_of(without.encode());
        EXPECT_EQ(rule == 0, optional) << twice.chunks[c].type << ": " << rule;
        twice.chunks.push_back(twice.chunks[c]);
        EXPECT_EQ(rule_of(twice.encode()), 3003) << twice.chunks[c].type;
    }
}

// In another order they are right where the table follows, and overlap or leave gaps where it does not.
TEST_P(Hostile, chunksInAnotherOrderOrOverlapping) {
    FileSpec rotated = taken_apart(file());
    std::rotate(rotated.chunks.begin(), rotated.chunks.begin() + 1, rotated.chunks.end());
    EXPECT_EQ(rule_of(rotated.encode()), 0);
    for (std::size_t c = 0; c < chunks(); ++c)
        for (std::size_t other = 0; other < chunks(); ++other) {
            if (other == c) continue;
            Bytes overlapping = file(), swapped = file();
            set(overlapping, chunk_at(c) + 16, 8, offset(file(), other));
            set(swapped, chunk_at(c) + 16, 8, offset(file(), other));
            set(swapped, chunk_at(other) + 16, 8, offset(file(), c));
            for (Bytes* bytes : {&overlapping, &swapped}) {
                seal(*bytes);
                EXPECT_EQ(rule_of(*bytes), 3006);
            }
        }
}

TEST_P(Hostile, wrongCrcsAndBombs) {
    for (std::size_t c = 0; c < chunks(); ++c) {
        Bytes wrong = file();
        set(wrong, chunk_at(c) + 12, 4, get(wrong, chunk_at(c) + 12, 4) ^ 0x10);
        seal_header(wrong);
        EXPECT_EQ(rule_of(wrong), 4001);
        FileSpec bomb = taken_apart(file()); // inflates to a thousand times what it says
        bomb.chunks[c].zlib = true;
        bomb.chunks[c].planes_of = 0;
        const std::size_t size = bomb.chunks[c].raw.size();
        bomb.chunks[c].raw.resize(1 << 20);
        Bytes bytes = bomb.encode();
        set(bytes, chunk_at(c) + 32, 8, size);
        seal(bytes);
        EXPECT_EQ(rule_of(bytes), 4003);
        set(bytes, chunk_at(c) + 32, 8, std::uint64_t{1} << 40); // says more than deflate can
        seal(bytes);
        EXPECT_EQ(rule_of(bytes), 3011);
    }
}

// What a later version may write: more minor versions and ancillary chunks are read, all else is refused by name.
TEST_P(Hostile, laterVersions) {
    FileSpec spec = taken_apart(file());
    spec.minor = 9;
    spec.chunks.insert(spec.chunks.begin(), {"xtra", {1, 2, 3}, 0, true});
    spec.chunks.push_back({"more", {}, 0, false});
    Bytes later = spec.encode();
    set(later, 32, 4, 0xFFFFFFFF); // optional features
    seal(later);
    EXPECT_EQ(rule_of(later), 0);
    spec.chunks.back() = {"NEWS", {1, 2, 3}, 1, false};
    const acdf::Status status = load(spec.encode());
    EXPECT_EQ(status.rule, 3002);
    EXPECT_EQ(status.code, ACDF_UNSUPPORTED);
    EXPECT_NE(std::strstr(status.message, "NEWS"), nullptr) << status.message;
    set(later, 12, 2, 2); // the major version
    seal(later);
    EXPECT_EQ(rule_of(later), 2003);
}

INSTANTIATE_TEST_SUITE_P(Files, Hostile, testing::ValuesIn(good_files()),
                         [](const testing::TestParamInfo<Named>& info) { return info.param.name; });

// ---- linear work ----------------------------------------------------------------------------------------

// n groups of 40 curves, each with both segments leading to the next: 2^39 paths a group.
EnvironmentSpec many_paths(int n) {
    EnvironmentSpec spec;
    spec.columns = static_cast<std::uint32_t>(n) + 1;
    spec.rows = 1 << 16;
    std::vector<std::uint32_t> columns;
    for (int i = 1; i < n; ++i) columns.push_back(static_cast<std::uint32_t>(i));
    CurveSpec root = even_curve(0, columns);
    root.link_bytes = 4;
    spec.tree.curves.clear();
    for (int i = 0; i < n; ++i) root.children.push_back(1 + 40 * i);
    spec.tree.curves.push_back(root);
    for (int i = 0; i < n; ++i)
        for (int level = 0; level < 40; ++level) {
            CurveSpec curve;
            if (level < 39) {
                curve.link_bytes = 1;
                curve.children = {static_cast<int>(spec.tree.curves.size()) + 1};
            }
            if (level % 8 == 0 && level < 39) { // splits, so that paths differ
                curve.cumulative = {128};
                curve.positions = {static_cast<std::uint32_t>(30000 + level)};
                curve.position_bytes = 2;
                curve.axis = 1;
                curve.children.push_back(curve.children[0]);
            }
            spec.tree.curves.push_back(curve);
        }
    return spec;
}

LocalSpec many_bins(int n) {
    LocalSpec spec = separate_local();
    spec.bin_columns = static_cast<std::uint32_t>(n);
    spec.bin_rows = 8;
    spec.bins.assign(8 * static_cast<std::size_t>(n), spec.bins[0]);
    return spec;
}

Bytes wrong_everywhere(int n) { // each curve is on a wrong axis
    EnvironmentSpec spec = many_paths(n);
    for (CurveSpec& curve : spec.tree.curves) curve.axis = 5;
    return spec.encode();
}

Bytes much_metadata(int n) {
    EnvironmentSpec spec = complete_environment();
    for (int i = 0; i < 1000; ++i)
        spec.metadata.push_back(
            {std::string(200, 'k') + std::to_string(i), std::string(static_cast<std::size_t>(n), 'v')});
    return spec.encode();
}

struct Growing {
    const char* name;
    std::function<Bytes(int)> make;
    int n;
};
void PrintTo(const Growing& growing, std::ostream* out) { *out << "from n = " << growing.n; }

class Work : public testing::TestWithParam<Growing> {};

std::uint64_t blocks_to_check(const Bytes& file) {
    const Exact exact(file);
    const std::uint64_t before = blocks;
    acdf::validate(
        exact.data(), exact.size(), [](const acdf::Finding&) {}, acdf::with_curves());
    return blocks - before;
}

TEST_P(Work, isLinearInTheBytes) {
    const Growing& growing = GetParam();
    const Bytes small = growing.make(growing.n), large = growing.make(4 * growing.n);
    const std::uint64_t little = blocks_to_check(small), much = blocks_to_check(large);
    if (!ACDF_COUNTS_WORK) return;
    ASSERT_GT(little, 1000u);
    const double sizes = static_cast<double>(large.size()) / static_cast<double>(small.size());
    const double work = static_cast<double>(much) / static_cast<double>(little);
    std::printf("%zu bytes: %.2f blocks a byte; %zu bytes: %.2f\n", small.size(),
                static_cast<double>(little) / static_cast<double>(small.size()), large.size(),
                static_cast<double>(much) / static_cast<double>(large.size()));
    EXPECT_LT(work, 1.1 * sizes);
    EXPECT_LT(much, 60 * large.size());
}

INSTANTIATE_TEST_SUITE_P(Files, Work,
                         testing::Values(Growing{"exponentially_many_paths",
                                                 [](int n) { return many_paths(n).encode(); }, 200},
                                         Growing{"a_finding_a_curve", wrong_everywhere, 200},
                                         Growing{"bins", [](int n) { return many_bins(n).encode(); }, 500},
                                         Growing{"metadata", much_metadata, 500},
                                         Growing{"curves_of_two_bytes",
                                                 [](int n) {
                                                     EnvironmentSpec spec;
                                                     spec.tree.curves.assign(static_cast<std::size_t>(n),
                                                                             CurveSpec());
                                                     return spec.encode();
                                                 },
                                                 10000}),
                         [](const testing::TestParamInfo<Growing>& info) { return std::string(info.param.name); });

} // namespace
