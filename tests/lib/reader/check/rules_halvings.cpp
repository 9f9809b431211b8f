// Environments whose tree of halvings breaks one rule each.
#include "tests/lib/reader/brdf_builder.h"
#include "tests/lib/reader/check/broken.h"
#include "tests/lib/reader/check/cases.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/local_builder.h"

#include <gtest/gtest.h>

namespace acdf_test {

namespace {

using Make = Action<Bytes()>;

// Bytes of HALV: 16 of header, 4 of structure (7 bits), 4 of codes (16 bits).
EnvironmentSpec halved() {
    EnvironmentSpec spec;
    spec.columns = spec.rows = 8;
    spec.halvings.nodes = {{0, 100}, {1, 200}, {}, {}, {}};
    return spec;
}

// Changes the chunks of the file: DESC, HALV.
Make halved_file(Action<void(FileSpec&)> change) {
    return [=] {
        FileSpec file = halved().file();
        change(file);
        return file.encode();
    };
}
Make halv_payload(Action<void(Bytes&)> change) {
    return halved_file([=](FileSpec& f) { change(f.chunks[1].raw); });
}
Make halv_field(std::size_t at, int size, std::uint64_t value) {
    return halv_payload([=](Bytes& raw) { set(raw, at, size, value); });
}
Make halv_record(std::size_t at, int size, std::uint64_t value) {
    return [=] {
        Bytes bytes = halved().encode();
        set(bytes, record_of(bytes, "HALV") + at, size, value);
        seal(bytes);
        return bytes;
    };
}

EnvironmentSpec tree(std::uint32_t columns, std::uint32_t rows, std::vector<HalvingSpec> nodes,
                     std::uint32_t code_bits = 8) {
    EnvironmentSpec spec;
    spec.columns = columns;
    spec.rows = rows;
    spec.halvings.code_bits = code_bits;
    spec.halvings.nodes = std::move(nodes);
    return spec;
}
Make broken(std::uint32_t columns, std::uint32_t rows, std::vector<HalvingSpec> nodes,
            std::uint32_t code_bits = 8) {
    return [=] { return tree(columns, rows, nodes, code_bits).encode(); };
}

// One step of random numbers leads to the lowest of 16 columns, which is halved with `code`.
std::vector<HalvingSpec> below_one_step(std::uint32_t code) { return {{0, 1}, {0, 1}, {0, code}, {}, {}, {}, {}}; }

Make with_chunks(const std::vector<std::size_t>& curves) { // 1: BINS, 2: TREE of the complete file
    return halved_file([=](FileSpec& f) {
        const FileSpec complete = complete_file();
        for (const std::size_t chunk : curves) f.chunks.push_back(complete.chunks[chunk]);
    });
}
Make of_fit(std::uint32_t fit) {
    return halved_file([=](FileSpec& f) { set(f.chunks[0].raw, 4, 4, fit); });
}

} // namespace

std::vector<Case> halvings_cases() {
    return {
        {3004, "no_halvings", halved_file([](FileSpec& f) { f.chunks.pop_back(); })},
        {3004, "no_description_beside_halvings",
         halved_file([](FileSpec& f) { f.chunks.erase(f.chunks.begin()); })},
        {3005, "planes_of_halvings", halv_record(8, 4, 2)},
        {3009, "ancillary_halvings", halv_record(4, 4, 0)},
        {6035, "halvings_beside_curves_of_a_brdf",
         [] {
             FileSpec brdf = shared_brdf().file();
             brdf.chunks.push_back(separate_brdf().file().chunks[2]);
             return brdf.encode();
         }},
        {6030, "empty", halv_payload([](Bytes& raw) { raw.clear(); })},
        {6030, "cut_in_the_header", halv_payload([](Bytes& raw) { raw.resize(15); })},
        {6030, "header_alone", halv_payload([](Bytes& raw) { raw.resize(16); })},
        {6030, "too_short", halv_payload([](Bytes& raw) { raw.pop_back(); })},
        {6030, "too_long", halv_payload([](Bytes& raw) { raw.push_back(0); })},
        {6030, "a_word_too_long", halv_payload([](Bytes& raw) { raw.resize(28); })},
        {6030, "more_halvings", halv_field(0, 4, 5)},
        {6030, "most_halvings", halv_field(0, 4, 0x7FFFFFF)},
        {6030, "too_many_halvings", halv_field(0, 4, 0x8000000)},
        {6030, "enormous_count", halv_field(0, 4, 0xFFFFFFFF)},
        {6030, "no_code_bits", halv_field(4, 4, 0)},
        {6030, "1_code_bit", halv_field(4, 4, 1)},
        {6030, "13_code_bits", halv_field(4, 4, 13)},
        {6030, "enormous_code_bits", halv_field(4, 4, 0xFFFFFFFF)},
        {6030, "first_reserved", halv_field(8, 4, 1)},
        {6030, "last_reserved", halv_field(15, 1, 0x80)},
        {6031, "one_node_more", halv_field(0, 4, 1)},
        {6031, "one_node_fewer", halv_field(0, 4, 3)},
        {6031, "a_leaf_instead", halv_field(16, 4, 0)},
        {6031, "no_end", halv_field(16, 4, 0xFFFFFFFF)},
        {6032, "one_column", broken(1, 8, {{0, 100}, {}, {}})},
        {6032, "one_row", broken(8, 1, {{1, 100}, {}, {}})},
        {6032, "one_column_left", broken(2, 8, {{0, 100}, {0, 100}, {}, {}, {}})},
        {6032, "one_row_left", broken(8, 2, {{1, 100}, {}, {0, 100}, {}, {1, 100}, {}, {}})},
        {6032, "lower_half_of_three", broken(3, 8, {{0, 100}, {0, 100}, {}, {}, {}})},
        {6033, "dark_lower_half", broken(8, 8, {{0, 0}, {1, 100}, {}, {}, {}})},
        {6033, "dark_upper_half", broken(8, 8, {{1, 255}, {}, {0, 100}, {}, {}})},
        {6033, "dark_half_with_the_first_code", broken(8, 8, {{0, 0}, {1, 0}, {}, {}, {}})},
        {6033, "dark_half_with_the_last_code", broken(8, 8, {{0, 255}, {}, {1, 255}, {}, {}})},
        {6033, "one_step_of_random_numbers", broken(16, 1, below_one_step(2048), 12)},
        {6033, "one_step_with_the_second_code", broken(16, 1, below_one_step(1), 12)},
        {6034, "behind_the_structure", halv_field(16, 1, 0x80 | 0x0D)},
        {6034, "at_the_end_of_the_structure", halv_field(19, 1, 0x80)},
        {6034, "behind_the_codes", halv_field(22, 1, 1)},
        {6034, "at_the_end_of_the_codes", halv_field(23, 1, 0x80)},
        {6034, "of_a_leaf",
         [] {
             FileSpec spec = tree(8, 8, {{}}).file();
             spec.chunks[1].raw[16] = 2;
             return spec.encode();
         }},
        {6035, "bins_and_tree", with_chunks({1, 2})},
        {6035, "bins", with_chunks({1})},
        {6035, "tree", with_chunks({2})},
        {6035, "uniform", of_fit(1)},
        {6035, "cdf", of_fit(2)},
        {6035, "pdf", of_fit(3)},
    };
}

namespace {

// Where ends do not fit into 31 bits, middles are none, and there is no end to halving.
TEST(HalvingsRules, axesThatAreTooLongAreNotHalved) {
    constexpr std::size_t depth = 2000;
    std::vector<HalvingSpec> nodes = {{0, 1}, {}};
    nodes.insert(nodes.end(), depth, HalvingSpec{0, 3}); // the lower half, again and again
    nodes.insert(nodes.end(), depth + 1, HalvingSpec{});
    EXPECT_EQ(findings(tree(0xFFFFFFFF, 8, nodes, 2).encode()).rules, (std::multiset<int>{5014, 7001}));
}

TEST(HalvingsRules, whatIsAtTheirLimitsIsRight) {
    expect_valid(halved().encode());
    expect_valid(tree(8, 8, {{}}).encode());                                        // a leaf
    expect_valid(tree(3, 1, {{0, 1}, {}, {0, 254}, {}, {}}).encode());              // [1, 3) is halved
    expect_valid(tree(8, 8, {{0, 0}, {}, {1, 255}, {0, 0}, {}, {}, {}}).encode());  // dark halves are leaves
    expect_valid(tree(16, 1, below_one_step(0), 12).encode());                      // one step, all of it above
    expect_valid(tree(16, 1, below_one_step(4095), 12).encode());                   // or below
    expect_valid(tree(8, 8, {{0, 1}, {1, 2}, {}, {}, {0, 1}, {}, {}}, 2).encode()); // the fewest bits
    EnvironmentSpec zipped = halved();
    zipped.zlib = zipped.octahedral = true;
    expect_valid(zipped.encode());
    FileSpec with_metadata = halved().file();
    with_metadata.chunks.insert(with_metadata.chunks.begin(), complete_file().chunks[3]);
    expect_valid(with_metadata.encode());
}

TEST(HalvingsRules, curvesStayLegalWithEachFit) {
    for (std::uint32_t fit = 1; fit <= 4; ++fit) {
        FileSpec curves = complete_file();
        set(curves.chunks[0].raw, 4, 4, fit);
        expect_valid(curves.encode());
    }
}

} // namespace

} // namespace acdf_test
