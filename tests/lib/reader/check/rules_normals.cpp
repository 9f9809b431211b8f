// Local environments on one tree of halvings that break one rule each.
#include "tests/lib/reader/check/broken.h"
#include "tests/lib/reader/check/cases.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/normals_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace acdf_test {

namespace {

using Make = Action<Bytes()>;

// Chunks: DESC, HALV, BINS, LOCL, NORM.
enum Chunk : std::size_t { description, halvings, bins, local, normals };

Make spec(Action<void(NormalsSpec&)> change) {
    return [=] {
        NormalsSpec out = small_normals();
        change(out);
        return out.encode();
    };
}
Make file(Action<void(FileSpec&)> change) {
    return [=] {
        FileSpec out = small_normals().file();
        change(out);
        return out.encode();
    };
}
// NORM: 16 bytes of header, 4 of splits, 4 of codes: 28 bits.
Make normals_field(std::size_t at, int size, std::uint64_t value) {
    return file([=](FileSpec& f) { set(f.chunks[normals].raw, at, size, value); });
}

} // namespace

std::vector<Case> normals_cases() {
    return {
        {3004, "no_rows_of_normals", file([](FileSpec& f) { f.chunks.pop_back(); })},
        {3004, "no_bins_of_normals", file([](FileSpec& f) { f.chunks.erase(f.chunks.begin() + bins); })},
        {3013, "normals_of_an_environment",
         [] {
             FileSpec out = complete_file();
             out.chunks.push_back(small_normals().file().chunks[normals]);
             return out.encode();
         }},
        {4004, "bins_of_normals_too_short", file([](FileSpec& f) { f.chunks[bins].raw.resize(40); })},
        {6017, "share_not_a_number", spec([](NormalsSpec& s) { s.bins[1].share = NAN; })},
        {6017, "share_below_0", spec([](NormalsSpec& s) { s.bins[1].share = -1.0f; })},
        {6026, "row_of_a_bin", spec([](NormalsSpec& s) { s.bins[5].root = 2; })},
        {6035, "curves_beside_normals", file([](FileSpec& f) { f.chunks.push_back(complete_file().chunks[2]); })},
        {6037, "row_code_below_a_shared_one", spec([](NormalsSpec& s) {
             s.own = {false, true, true};
         })},
        {6037, "one_row_code_fewer", normals_field(16, 4, 1)},
        {6038, "behind_the_splits_of_rows", normals_field(16, 4, 0x0B)},
        {6038, "behind_the_codes_of_rows", normals_field(23, 1, 0xF0)},
        {6039, "cut_in_the_header_of_normals", file([](FileSpec& f) { f.chunks[normals].raw.resize(12); })},
        {6039, "bytes_behind_the_codes", file([](FileSpec& f) { f.chunks[normals].raw.resize(28); })},
        {6039, "no_row", normals_field(0, 4, 0)},
        {6039, "more_rows_than_bins", normals_field(0, 4, 7)},
        {6039, "more_splits_than_there_are_halvings", normals_field(4, 4, 4)},
        {6039, "rows_of_3_code_bits", normals_field(8, 4, 3)},
        {6039, "rows_of_9_code_bits", normals_field(8, 4, 9)},
        {6039, "reserved", normals_field(12, 4, 1)},
        {6039, "too_many_for_their_bytes",
         [] {
             NormalsSpec s = small_normals();
             s.subdivisions = 60; // 14402 rows of two splits, in 24 bytes
             s.bins.assign(4 * 60 * 60 + 2, {0, 0.5f});
             FileSpec out = s.file();
             set(out.chunks[normals].raw, 0, 4, s.bins.size());
             return out.encode();
         }},
        {6040, "codes_are_missing", file([](FileSpec& f) { f.chunks[normals].raw.resize(20); })},
        {7003, "grid_of_normals", file([](FileSpec& f) {
             LocalSpec grid = separate_local();
             grid.columns = grid.rows = 8;
             grid.total = 1.0;
             f.chunks[description].raw = grid.description().encode();
             f.chunks[bins].raw = acdf_test::encode(std::vector<BinSpec>(6, {0, 0.5f}));
         })},
        {7005, "no_local_beside_normals", file([](FileSpec& f) { f.chunks.erase(f.chunks.begin() + local); })},
    };
}

namespace {

TEST(NormalsRules, whatIsAtTheirLimitsIsRight) {
    const auto valid = [](Action<void(NormalsSpec&)> change) {
        NormalsSpec out = small_normals();
        change(out);
        const Findings found = findings(out.encode());
        EXPECT_TRUE(found.rules.empty()) << found.text;
    };
    valid([](NormalsSpec&) {});
    valid([](NormalsSpec& s) { s.tree.octahedral = true; });
    valid([](NormalsSpec& s) { s.zlib = s.tree.zlib = true; });
    valid([](NormalsSpec& s) { // half of all is dark: one code of the second split is left out
        s.rows = {{0, 20}, {127, 64}};
    });
    valid([](NormalsSpec& s) {
        s.own = {false, false, false};
        s.rows = {{}, {}};
    });
    valid([](NormalsSpec& s) { // a leaf
        s.tree.halvings.nodes = {{}};
        s.own.clear();
        s.rows = {{}, {}};
    });
    for (std::uint32_t seed = 0; seed < 30; ++seed) valid([=](NormalsSpec& s) { s = random_normals(seed); });
}

} // namespace

} // namespace acdf_test
