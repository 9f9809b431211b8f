// Files of kind 2 that break one rule each, and what they must not hide.
#include "tests/lib/reader/check/cases.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/local_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace acdf_test {

namespace {

using Make = Action<Bytes()>;
using Change = Action<void(LocalSpec&)>;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// Changes the parts before they become a file.
Make with(LocalSpec (*make)(), Change change) {
    return [=] {
        LocalSpec spec = make();
        change(spec);
        return spec.encode();
    };
}
Make separate(Change change) { return with(separate_local, std::move(change)); }
// The same with bins of an octahedron.
LocalSpec octahedral_bins() {
    LocalSpec spec = separate_local();
    spec.subdivisions = 1;
    return spec;
}

// Changes the payload of a chunk.
Make payload(LocalSpec (*make)(), const char* type, Action<void(Bytes&)> change) {
    return [=] {
        FileSpec file = make().file();
        for (ChunkSpec& chunk : file.chunks)
            if (chunk.type == type) change(chunk.raw);
        return file.encode();
    };
}
Make field(LocalSpec (*make)(), const char* type, std::size_t at, int size, std::uint64_t value) {
    return payload(make, type, [=](Bytes& raw) { set(raw, at, size, value); });
}
Make without(LocalSpec (*make)(), const char* type) {
    return [=] {
        FileSpec file = make().file();
        for (std::size_t i = file.chunks.size(); i-- > 0;)
            if (file.chunks[i].type == type) file.chunks.erase(file.chunks.begin() + std::ptrdiff_t(i));
        return file.encode();
    };
}
Make beside(FileSpec (*make)(), const char* type, const Bytes& raw) {
    return [=] {
        FileSpec file = make();
        file.chunks.push_back({type, raw, 1, false});
        return file.encode();
    };
}

// Axes anew; `bins` of them.
Make axes(LocalSpec (*make)(), std::uint32_t bins, Action<void(std::vector<AxisSpec>&)> change) {
    return [=] {
        LocalSpec spec = make();
        spec.bins.resize(bins, {no_root, 0.0f});
        FileSpec file = spec.file();
        DescriptionSpec description = spec.description();
        change(description.axes);
        file.chunks[0].raw = description.encode();
        return file.encode();
    };
}

// Rules of chunks and of trees, as local environments have them.
std::vector<Case> tree_cases_of_bins() {
    const Bytes local_chunk(8, 0);
    return {
        {3013, "local_chunk_of_an_environment", beside(complete_file, "LOCL", local_chunk)},
        {3013, "local_chunk_of_a_table", beside(table_file, "LOCL", local_chunk)},
        {6003, "axis_of_normals", field(separate_local, "TREE", 32, 2, 1 << 10 | 0x202)},
        {6010, "of_a_bin",
         [] {
             FileSpec file = separate_local().file();
             set(file.chunks[1].raw, 8, 4, 1);
             return file.encode();
         }},
        {6012, "of_no_bin", separate([](LocalSpec& spec) { spec.tree.curves.push_back(even_curve(1, {4})); })},
        {6016, "behind_the_environment", separate([](LocalSpec& spec) {
             spec.tree = chain(65).tree;
             for (BinSpec& bin : spec.bins) bin.root = no_root;
         })},
        {6017, "infinite", separate([](LocalSpec& spec) { spec.bins[2].share = HUGE_VALF; })},
    };
}

std::vector<Case> kind_cases() {
    return {
        {5016, "table", field(separate_local, "DESC", 0, 4, 3)},
        {7001, "of_a_local", field(separate_local, "DESC", 64 + 48 + 20, 4, 0)},
        {7003, "two_axes", axes(separate_local, 1, [](auto& all) { all.resize(2); })},
        {7003, "five_axes",
         axes(separate_local, 6,
              [](auto& all) {
                  all.push_back({"more", 1, 0, 1, 0.0, 1.0});
              })},
        {7003, "name", axes(octahedral_bins, 6, [](auto& all) { all[2].name = "normals"; })},
        {7003, "role", axes(octahedral_bins, 6, [](auto& all) { all[2].role = 0; })},
        {7003, "measure", axes(octahedral_bins, 6, [](auto& all) { all[2].measure = 1; })},
        {7003, "low", axes(octahedral_bins, 6, [](auto& all) { all[2].low = 1.0; })},
        {7003, "high", axes(octahedral_bins, 6, [](auto& all) { all[2].high = 1.0; })},
        {7003, "no_octahedron",
         axes(octahedral_bins, 7,
              [](auto& all) {
                  all[2].resolution = 7;
                  all[2].high = 7.0;
              })},
        {7003, "exchanged", axes(separate_local, 6, [](auto& all) { std::swap(all[2], all[3]); })},
        {7003, "theta_from_below", axes(separate_local, 6, [](auto& all) { std::swap(all[2].low, all[2].high); })},
        {7003, "phi_the_other_way", axes(separate_local, 6, [](auto& all) { std::swap(all[3].low, all[3].high); })},
        {7003, "wide_grid",
         axes(separate_local, 65537,
              [](auto& all) {
                  all[2].resolution = 1;
                  all[3].resolution = 65537;
              })},
        {7004, "one_less", axes(octahedral_bins, 5, [](auto&) {})},
        {7004, "wrapped",
         axes(separate_local, 0x10000,
              [](auto& all) { // 2^32 + 2^16 bins
                  all[2].resolution = 65536;
                  all[3].resolution = 65536;
              })},
        {7005, "none", without(separate_local, "LOCL")},
        {7005, "empty", payload(separate_local, "LOCL", [](Bytes& raw) { raw.clear(); })},
        {7005, "cut", payload(separate_local, "LOCL", [](Bytes& raw) { raw.pop_back(); })},
        {7005, "too_long", payload(separate_local, "LOCL", [](Bytes& raw) { raw.push_back(0); })},
        {7005, "reserved", field(separate_local, "LOCL", 4, 4, 1)},
        {7005, "all_cosine", separate([](LocalSpec& spec) { spec.cosine_share = 1.0f; })},
        {7005, "negative_cosine", separate([](LocalSpec& spec) { spec.cosine_share = -0.25f; })},
        {7005, "nan_cosine", separate([](LocalSpec& spec) { spec.cosine_share = not_a_number; })},
    };
}

} // namespace

std::vector<Case> local_cases() {
    std::vector<Case> all;
    for (auto make : {tree_cases_of_bins, kind_cases})
        for (const Case& c : make()) all.push_back(c);
    return all;
}

namespace {

TEST(LocalRules, whatIsAtTheirLimitsIsRight) {
    expect_valid(octahedral_bins().encode());
    expect_valid(separate([](LocalSpec& spec) { spec.zlib = true; })());
    expect_valid(separate([](LocalSpec& spec) {
        for (BinSpec& bin : spec.bins) bin = {no_root, 0.0f};
    })());
}

TEST(LocalRules, findingsStandWhereTheFaultIs) {
    FileSpec file = separate_local().file();
    set(file.chunks[1].raw, 5 * 8, 4, 1);
    const Bytes root = file.encode(), reserved = field(separate_local, "LOCL", 4, 4, 1)();
    EXPECT_EQ(findings(root).last_offset, payload_of(root, "BINS") + 5 * 8);
    EXPECT_EQ(findings(reserved).last_offset, payload_of(reserved, "LOCL") + 4);
}

TEST(LocalRules, faultsDoNotHideEachOther) {
    LocalSpec spec = separate_local();
    spec.bins[1].share = -1.0f;
    spec.cosine_share = 2.0f;
    FileSpec file = spec.file();
    set(file.chunks[1].raw, 5 * 8, 4, 1);
    const Findings found = findings(file.encode());
    EXPECT_EQ(found.rules, (std::multiset<int>{6010, 6017, 7005})) << found.text;
}

} // namespace

} // namespace acdf_test
