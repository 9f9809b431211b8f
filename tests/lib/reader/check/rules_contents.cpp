// Files whose description, tree or table breaks a rule.
#include "tests/lib/reader/check/broken.h"
#include "tests/lib/reader/check/cases.h"
#include "tests/lib/reader/local_builder.h"

namespace acdf_test {
namespace {

// COMP of one record a bin, if any, with one number changed.
Bytes partner_chunk(std::uint32_t kind, std::uint32_t records, float flux) {
    Bytes raw;
    put32(raw, kind);
    put32(raw, ACDF_HEURISTIC_BALANCE);
    put_float(raw, 0.5f);
    put_float(raw, 0.75f);
    put32(raw, records);
    put32(raw, 0);
    for (std::uint32_t i = 0; i < records; ++i) {
        put_float(raw, 0.25f);
        put_float(raw, flux);
    }
    return raw;
}
Action<Bytes()> partner(FileSpec file, Bytes raw, const Action<void(Bytes&)>& change = {}) {
    return [=]() mutable {
        if (change) change(raw);
        file.chunks.push_back({"COMP", raw, 1, false});
        return file.encode();
    };
}
Action<Bytes()> partner_field(std::size_t at, int size, std::uint64_t value) {
    return partner(complete_file(), partner_chunk(ACDF_PARTNER_COSINE, 1, 0.0f),
                   [=](Bytes& raw) { set(raw, at, size, value); });
}
FileSpec local_file() { return separate_local().file(); }
std::uint32_t bins_of(const FileSpec& file) {
    std::uint32_t count;
    std::memcpy(&count, file.chunks[0].raw.data() + 24, 4);
    return count;
}

} // namespace

std::vector<Case> partner_cases() {
    const FileSpec local = local_file(), table = table_file();
    const std::uint32_t bins = bins_of(local);
    const Bytes cosine = partner_chunk(ACDF_PARTNER_COSINE, 1, 0.0f);
    return {
        {5020, "empty", partner(complete_file(), {})},
        {5020, "cut", partner(complete_file(), cosine, [](Bytes& raw) { raw.pop_back(); })},
        {5020, "too_long", partner(complete_file(), cosine, [](Bytes& raw) { raw.push_back(0); })},
        {5020, "enormous", partner_field(16, 4, 0xFFFFFFFF)},
        {5020, "reserved", partner_field(20, 4, 1)},
        {5020, "all_ours", partner_field(8, 4, 0x3F800000)},
        {5020, "none_ours", partner_field(8, 4, 0)},
        {5020, "nan_share", partner_field(8, 4, 0x7FC00000)},
        {5020, "recommends_none", partner_field(12, 4, 0)},
        {5020, "recommends_nan", partner_field(12, 4, 0x7FC00000)},
        {5020, "record_above_one", partner_field(24, 4, 0x3F800001)},
        {5020, "flux_of_an_environment", partner_field(28, 4, 0x3F800000)},
        {5020, "two_records", partner(complete_file(), partner_chunk(ACDF_PARTNER_COSINE, 2, 0.0f))},
        {5020, "local_without_records", partner(local, partner_chunk(ACDF_PARTNER_COSINE, 0, 0.0f))},
        {5020, "infinite_flux",
         partner(local, partner_chunk(ACDF_PARTNER_COSINE, bins, std::numeric_limits<float>::infinity()))},
        {5020, "negative_flux", partner(local, partner_chunk(ACDF_PARTNER_COSINE, bins, -1.0f))},
        {5021, "none", partner_field(0, 4, 0)},
        {5021, "five", partner_field(0, 4, 5)},
        {5021, "table_beside_an_environment", partner_field(0, 4, 4)},
        {5021, "cosine_beside_a_table", partner(table, partner_chunk(ACDF_PARTNER_COSINE, 0, 0.0f))},
        {5021, "heuristic", partner_field(4, 4, 2)},
    };
}

std::vector<Case> description_cases() {
    return {
        {5001, "zero", payload_field("DESC", 0, 4, 0)},
        {5001, "five", payload_field("DESC", 0, 4, 5)},
        {5002, "zero", payload_field("DESC", 4, 4, 0)},
        {5002, "five", payload_field("DESC", 4, 4, 5)},
        {5003, "two", payload_field("DESC", 8, 4, 2)},
        {5004, "y", payload_field("DESC", 12, 4, 1)},
        {5005, "left", payload_field("DESC", 16, 4, 1)},
        {5006, "zero", payload_field("DESC", 20, 4, 0)},
        {5006, "nine", payload_field("DESC", 20, 4, 9)},
        {5007, "zero",
         [] {
             FileSpec file = separate_local().file();
             set(file.chunks[0].raw, 24, 4, 0);
             file.chunks[1].raw.clear();
             return file.encode();
         }},
        {5019, "three", payload_field("DESC", 28, 4, 3)},
        {5008, "axis", payload_field("DESC", 64 + 28, 4, 1)},
        {5009, "negative", payload_double("DESC", 32, -1e-300)},
        {5009, "infinite", payload_double("DESC", 48, infinity)},
        {5010, "zero", payload_double("DESC", 56, 0.0)},
        {5010, "negative", payload_double("DESC", 56, -1.0)},
        {5010, "nan", payload_double("DESC", 56, nan_value)},
        {5010, "infinite", payload_double("DESC", 56, infinity)},
        {5011, "empty", third_axis(0, 4, 0)},
        {5011, "not_padded", third_axis(15, 1, 'x')},
        {5011, "overlong_utf8", third_axis(0, 2, 0x80C0)},
        {5011, "surrogate", third_axis(0, 3, 0x80A0ED)},
        {5011, "cut_utf8", third_axis(3, 1, 0xC3)},
        {5011, "taken", third_axis(0, 4, 'p' | 'h' << 8 | 'i' << 16)},
        {5012, "two", third_axis(16, 4, 2)},
        {5013, "three", third_axis(20, 4, 3)},
        {5014, "zero", third_axis(24, 4, 0)},
        {5014, "too_large", third_axis(24, 4, 0x80000000)},
        {5015, "equal", third_axis(32, 8, 0x3FF0000000000000)},
        {5015, "nan", third_axis(32, 8, 0x7FF8000000000000)},
        {5015, "infinite", third_axis(40, 8, 0x7FF0000000000000)},
        {5016, "half_angle", payload_field("DESC", 0, 4, 2)},
        {5016, "octahedral_table", table_field(0, 4, 4)},
        {5016, "environment_as_table", table_field(0, 4, 1)},
        {5017, "count", payload_field("META", 0, 4, 3)},
        {5017, "fewer", payload_field("META", 0, 4, 1)},
        {5017, "many", payload_field("META", 0, 4, 1025)},
        {5017, "length", payload_field("META", 4, 4, 0xFFFFFFFF)},
        {5017, "no_count", rebuilt([](FileSpec& f) { f.chunks[3].raw.resize(3); })},
        {5017, "left_over", rebuilt([](FileSpec& f) { f.chunks[3].raw.push_back(0); })},
        {5017, "empty_key", metadata_file({{"", "value"}})},
        {5017, "long_key", metadata_file({{std::string(256, 'k'), "value"}})},
        {5017, "key_not_utf8", metadata_file({{"\xff", "value"}})},
        {5017, "value_not_utf8", metadata_file({{"key", "\xf4\x90\x80\x80"}})},
        {5018, "twice", metadata_file({{"a", "1"}, {"b", "2"}, {"a", "1"}})},
    };
}

// Offsets in TREE: see complete_environment.
std::vector<Case> tree_cases() {
    return {
        {6001, "empty", rebuilt([](FileSpec& f) { f.chunks[2].raw.clear(); })},
        {6001, "half_a_unit", rebuilt([](FileSpec& f) { f.chunks[2].raw.resize(35); })},
        {6002, "segments", payload_field("TREE", 32, 2, 2 << 10 | 0x200)},
        {6002, "last_byte", payload_field("TREE", 32, 2, 3 << 10)},
        {6002, "all_segments", payload_field("TREE", 12, 6, std::uint64_t{0xFFFFF} << 16 | 0x1D1)},
        {6003, "five", payload_field("TREE", 32, 2, 1 << 10 | 0x205)},
        {6003, "indexed",
         [] {
             Bytes file = separate_local().encode();
             set(file, payload_of(file, "TREE") + 32, 2, 1 << 10 | 0x202);
             seal(file);
             return file;
         }},
        {6004, "cumulative_3", payload_field("TREE", 32, 2, 1 << 10 | 0x218)},
        {6004, "positions_3", payload_field("TREE", 32, 2, 1 << 10 | 0x260)},
        {6004, "both_3_and_no_count", payload_field("TREE", 32, 2, 0x278)},
        {6005, "zero", long_count(0)},
        {6005, "short_in_long_form", long_count(63)},
        {6005, "too_many", long_count(1048576)},
        {6005, "most", long_count(0xFFFFFFFF)},
        {6005, "count_missing", payload_field("TREE", 32, 2, 0x200)},
        {6005, "count_cut", // the last curve starts at the last unit
         with_tree([](std::vector<CurveSpec>& curves) { curves[2].tilts.clear(); }, 32, 2, 0)},
        {6006, "equal", payload_field("TREE", 7, 1, 3)},
        {6006, "falling", payload_field("TREE", 7, 1, 2)},
        {6007, "at_zero", payload_field("TREE", 6, 1, 0)},
        {6007, "at_the_end", payload_field("TREE", 7, 1, 8)},
        {6007, "second_path", // inside [3, 6], where segment 1 leads, but not in [0, 3]
         with_tree([](std::vector<CurveSpec>& curves) { curves[2] = split(0, {4}); })},
        {6007, "first_path", // the other way round
         with_tree([](std::vector<CurveSpec>& curves) { curves[2] = split(0, {2}); })},
        {6007, "through_another_axis", // theta lies in [2, 8] below segment 1 of curve 1
         with_tree([](std::vector<CurveSpec>& curves) { curves[2] = split(1, {2}); })},
        {6007, "wide", // whose sum with what is inherited would wrap
         with_tree([](std::vector<CurveSpec>& curves) {
             curves[2] = split(0, {0xFFFFFFFF});
             curves[2].position_bytes = 4;
         })},
        {6007, "one_byte_at_the_low_end", one_byte_below_3_to_6(0)},
        {6007, "one_byte_at_the_high_end", one_byte_below_3_to_6(3)},
        {6007, "one_byte_beyond", one_byte_below_3_to_6(255)},
        {6008, "falling", payload_field("TREE", 4, 2, 19999)},
        {6009, "inside_a_curve", payload_field("TREE", 8, 1, 7)},
        {6009, "beyond_the_tree", payload_field("TREE", 8, 1, 18)},
        {6009, "far_beyond_the_tree", payload_field("TREE", 28, 4, 0xFFFFFFFF)},
        {6010, "inside_a_curve", payload_field("BINS", 0, 4, 1)},
        {6010, "beyond_the_tree", payload_field("BINS", 0, 4, 0xFFFFFFFF)},
        {6011, "after_the_curve", payload_field("TREE", 11, 1, 1)},
        {6011, "before_the_first_array", payload_field("TREE", 15, 1, 1)},
        {6011, "before_the_tilts",
         with_tree(
             [](std::vector<CurveSpec>& curves) {
                 curves[0].tilts = {0, 0, 0};
             },
             11, 1, 1)},
        {6011, "between_arrays",
         with_tree(
             [](std::vector<CurveSpec>& curves) {
                 curves[0] = even_curve(0, {2, 4, 6}); // 3 values of 2 bytes, then one of 4
                 curves[0].cumulative_bytes = 1;
                 curves[0].cumulative = {80, 160, 200};
                 curves[0].link_bytes = 1;
                 curves[0].children = std::vector<int>{1, 2, -1, -1};
             },
             5, 1, 1)},
        {6012, "last", with_tree([](std::vector<CurveSpec>& curves) { curves.push_back(even_curve(1, {4})); })},
        {6013, "least", payload_field("TREE", 34, 2, 0x8000)},
        {6014, "grandchild", with_tree([](std::vector<CurveSpec>& curves) {
             curves[0].tilts = {5, 0, 0};
         })},
        {6014, "child", with_tree([](std::vector<CurveSpec>& curves) {
             curves[0].tilts = {0, -5, 0};
         })},
        {6015, "first", payload_field("TREE", 2, 2, 0)},
        {6015, "middle", payload_field("TREE", 4, 2, 20000)},
        {6016, "chain", [] { return chain(65).encode(); }},
        {6016, "long_chain", [] { return chain(200).encode(); }},
        {6017, "negative", payload_field("BINS", 4, 4, 0xBF800000)},
        {6017, "nan", payload_field("BINS", 4, 4, 0x7FC00000)},
        {6018, "three_in_six_bytes", curves_of_two_bytes(3)},
        {6018, "many", curves_of_two_bytes(100000)},
        {6019, "two_parents", // ranges [3, 6] and [0, 3]: one step in is inside both
         with_tree([](std::vector<CurveSpec>& curves) {
             curves[2] = split(0, {1});
             curves[2].position_bytes = 1;
         })},
        {6019, "through_a_curve_between", // of one segment, which inherits both ranges
         with_tree([](std::vector<CurveSpec>& curves) {
             curves[2] = CurveSpec();
             curves[2].link_bytes = 1;
             curves[2].children.push_back(3);
             curves.push_back(split(0, {1}));
             curves.back().position_bytes = 1;
         })},
        {6019, "two_segments", // of one parent
         with_tree([](std::vector<CurveSpec>& curves) {
             curves[0].children = {1, 2, 2};
             curves[1].children = {-1, -1};
             curves[2] = split(0, {1});
             curves[2].position_bytes = 1;
         })},
        {7001, "one_axis",
         [] {
             EnvironmentSpec spec = chain(1);
             FileSpec file = spec.file();
             DescriptionSpec description;
             description.axes.resize(1);
             file.chunks[0].raw = description.encode();
             return file.encode();
         }},
        {7001, "three_axes",
         [] {
             FileSpec file = chain(1).file();
             DescriptionSpec description;
             description.axes.push_back({"third", 1, 0, 1, 0.0, 1.0});
             file.chunks[0].raw = description.encode();
             return file.encode();
         }},
        {7001, "name", payload_field("DESC", 64, 1, 'P')},
        {7001, "octahedral_with_angles", payload_field("DESC", 0, 4, 4)},
        {7001, "angles_with_u_and_v", octahedral_axes([](FileSpec& f) { set(f.chunks[0].raw, 0, 4, 1); })},
        {7001, "octahedral_name", octahedral_axes([](FileSpec& f) { set(f.chunks[0].raw, 64, 1, 'x'); })},
        {7001, "octahedral_measure", octahedral_axes([](FileSpec& f) { set(f.chunks[0].raw, 64 + 68, 4, 1); })},
        {7001, "octahedral_resolution",
         octahedral_axes([](FileSpec& f) { set(f.chunks[0].raw, 64 + 24, 4, 65537); })},
        {7001, "role",
         [] {
             FileSpec file = chain(1).file();
             set(file.chunks[0].raw, 64 + 48 + 16, 4, 1);
             return file.encode();
         }},
        {7001, "measure", payload_field("DESC", 64 + 48 + 20, 4, 0)},
        {7001, "low", payload_double("DESC", 64 + 32, 3.14159265358979)},
        {7001, "resolution", payload_field("DESC", 64 + 48 + 24, 4, 65537)},
        {7002, "two_bins", rebuilt([](FileSpec& f) {
             set(f.chunks[0].raw, 24, 4, 2);
             f.chunks[1].raw = encode(std::vector<BinSpec>{{0, 0.5f}, {0, 0.5f}});
         })},
        {7008, "half", rebuilt([](FileSpec& f) {
             f.chunks[1].raw = encode(std::vector<BinSpec>{{0, 0.5f}});
         })},
        {7008, "none", rebuilt([](FileSpec& f) {
             f.chunks[1].raw = encode(std::vector<BinSpec>{{0, 0.0f}});
         })},
    };
}

namespace {

Action<Bytes()> table_chunk(std::size_t chunk, Action<void(Bytes&)> change) {
    return [=] {
        FileSpec file = table_file();
        change(file.chunks[chunk].raw);
        return file.encode();
    };
}
Action<Bytes()> table_root(std::size_t bin, std::uint32_t root) {
    return table_chunk(1, [=](Bytes& raw) { set(raw, 8 * bin, 4, root); });
}
Action<Bytes()> table_without(std::size_t chunk) {
    return [=] {
        FileSpec file = table_file();
        file.chunks.erase(file.chunks.begin() + static_cast<std::ptrdiff_t>(chunk));
        return file.encode();
    };
}
// As many halvings as the table has by its count, whatever nodes there are.
Action<Bytes()> table_halvings(const std::vector<HalvingSpec>& nodes) {
    return table_chunk(2, [=](Bytes& raw) {
        raw = HalvingsSpec{8, 1, nodes}.encode();
        set(raw, 0, 4, 4);
    });
}
Action<Bytes()> spare_halvings(const std::vector<HalvingSpec>& nodes) {
    return [=] {
        FileSpec file = spare_file();
        file.chunks[2].raw = HalvingsSpec{8, 2, nodes}.encode();
        return file.encode();
    };
}

} // namespace

std::vector<Case> table_cases() {
    return {
        {9001, "cosine", table_field(64 + 3 * 48 + 20, 4, 1)},
        {9001, "indexed_cosine", table_field(64 + 20, 4, 1)},
        {9002, "sampled_first",
         [] {
             FileSpec file = table_file(); // exchanges axes 1 and 2
             Bytes& raw = file.chunks[0].raw;
             std::swap_ranges(raw.begin() + 64 + 48, raw.begin() + 64 + 96, raw.begin() + 64 + 96);
             return file.encode();
         }},
        {9003, "fewer_bins",
         [] {
             FileSpec file = table_file();
             set(file.chunks[0].raw, 24, 4, 5);
             file.chunks[1].raw = encode(std::vector<BinSpec>(5, {kNoRoot, 0.2f}));
             file.chunks[2].raw = HalvingsSpec{8, 1, std::vector<HalvingSpec>(5)}.encode();
             return file.encode();
         }},
        {9003, "longer_axis", table_field(64 + 24, 4, 3)},
        {9003, "product_of_2_to_the_62",
         [] {
             FileSpec file = table_file();
             for (const std::size_t axis : {0u, 1u}) set(file.chunks[0].raw, 64 + axis * 48 + 24, 4, 0x7FFFFFFF);
             for (const std::size_t axis : {0u, 1u})
                 set(file.chunks[0].raw, 64 + axis * 48 + 40, 8, 0x4260000000000000);
             return file.encode();
         }},
        {9004, "far_from_zero", table_range(0x1p43, 0x1p43 + 1.0)},
        {9004, "too_large", table_range(0.0, 0x1.8p100)},
        {9004, "too_wide", table_range(-1e308, 1e308)},
        {9004, "too_small", table_range(0.0, 0x1p-98)},
        {9005, "less", table_shares(0.5f - 0x1p-18f)},
        {9005, "more", table_shares(0.5f + 0x1p-18f)},
        {9005, "none",
         [] {
             FileSpec file = table_file();
             file.chunks[1].raw = encode(std::vector<BinSpec>(6, {kNoRoot, 0.0f}));
             file.chunks[2].raw = HalvingsSpec{}.encode();
             return file.encode();
         }},
        {9006, "separate", table_field(28, 4, 1)},
        {9006, "first", table_field(32, 8, 0x3FE0000000000000)},
        {9006, "second", table_field(40, 8, 0x3FE0000000000000)},
        {9007, "of_one_cell", table_root(1, 2)},
        {9007, "without_energy", table_root(3, 2)},
        {9007, "of_another_tree", table_root(2, 0)},
        {9007, "in_its_own_tree", table_root(0, 1)},
        {9007, "missing", table_root(5, kNoRoot)},
        {9007, "enormous", table_root(5, 0xFFFFFFFE)},
        {3004, "table_without_halvings", table_without(2)},
        {3004, "table_without_bins", table_without(1)},
        {3013, "curves_of_a_table",
         [] {
             FileSpec file = table_file();
             file.chunks.push_back(complete_file().chunks[2]);
             return file.encode();
         }},
        {4004, "bins_of_a_table", table_chunk(1, [](Bytes& raw) { raw.resize(40); })},
        {6017, "share_of_a_table", table_chunk(1, [](Bytes& raw) { set(raw, 12, 4, 0x7FC00000); })},
        {6030, "trees_of_a_table", table_chunk(2, [](Bytes& raw) { raw.resize(20); })},
        {6031, "fewer_in_a_table", table_halvings({{0, 100}, {1, 200}, {}, {}, {}, {}, {1, 128}, {}, {}, {}})},
        {6032, "axis_of_a_table", spare_halvings({{3, 100}, {1, 200}, {}, {}, {}})},
        {6032, "one_step_of_a_table", spare_halvings({{2, 100}, {1, 200}, {}, {}, {}})},
        {6033, "below_a_dark_node_of_a_table", spare_halvings({{0, 0}, {1, 200}, {}, {}, {}})},
        {6034, "behind_the_trees", table_chunk(2, [](Bytes& raw) { set(raw, 19, 1, 0x80); })},
        {6035, "fit_of_a_table", table_field(4, 4, 2)},
    };
}
} // namespace acdf_test
