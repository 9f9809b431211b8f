// For every rule of the table a file that breaks it and no other.
#include "tests/lib/reader/brdf_builder.h"
#include "tests/lib/reader/cases.h"
#include "tests/lib/reader/files.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/local_builder.h"
#include "tests/lib/reader/planes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>

using namespace acdf_test;

namespace {

// Changes the complete file, then makes the CRCs right again.
std::function<Bytes()> changed(std::function<void(Bytes&)> change) {
    return [change] {
        Bytes file = complete_file().encode();
        change(file);
        seal(file);
        return file;
    };
}

// One number of the file, `at` bytes into a chunk's payload or table record.
std::function<Bytes()> header_field(std::size_t at, int size, std::uint64_t value) {
    return changed([=](Bytes& file) { set(file, at, size, value); });
}
std::function<Bytes()> record_field(const char* type, std::size_t at, int size, std::uint64_t value) {
    return changed([=](Bytes& file) { set(file, record_of(file, type) + at, size, value); });
}
std::function<Bytes()> payload_field(const char* type, std::size_t at, int size, std::uint64_t value) {
    return changed([=](Bytes& file) { set(file, payload_of(file, type) + at, size, value); });
}
std::function<Bytes()> payload_double(const char* type, std::size_t at, double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, 8);
    return payload_field(type, at, 8, bits);
}

// The same for a table whose third axis no curve splits.
std::function<Bytes()> third_axis(std::size_t at, int size, std::uint64_t value) {
    return [=] {
        Bytes file = spare_file().encode();
        set(file, payload_of(file, "DESC") + 64 + 2 * 48 + at, size, value);
        seal(file);
        return file;
    };
}

// One number of DESC of the table.
std::function<Bytes()> table_field(std::size_t at, int size, std::uint64_t value) {
    return [=] {
        FileSpec file = table_file();
        set(file.chunks[0].raw, at, size, value);
        return file.encode();
    };
}
std::function<Bytes()> table_range(double low, double high) { // of the first sampled axis
    return [=] {
        FileSpec file = table_file();
        for (const auto& [at, value] : {std::pair{32, low}, {40, high}}) {
            std::uint64_t bits;
            std::memcpy(&bits, &value, 8);
            set(file.chunks[0].raw, 64 + 2 * 48 + static_cast<std::size_t>(at), 8, bits);
        }
        return file.encode();
    };
}

std::function<Bytes()> table_shares(float first) { // of six bins, the others together a half
    return [=] {
        FileSpec file = table_file();
        file.chunks[1].raw =
            encode(std::vector<BinSpec>{{0, first}, {6, 0.25f}, {0, 0.125f}, {0, 0}, {6, 0}, {0, 0.125f}});
        return file.encode();
    };
}

// Changes the parts before they become a file.
std::function<Bytes()> rebuilt(std::function<void(FileSpec&)> change) {
    return [change] {
        FileSpec file = complete_file();
        change(file);
        return file.encode();
    };
}
// The same of a file on the octahedral square.
std::function<Bytes()> octahedral_axes(std::function<void(FileSpec&)> change) {
    return [change] {
        EnvironmentSpec spec = complete_environment();
        spec.octahedral = true;
        FileSpec file = spec.file();
        change(file);
        return file.encode();
    };
}
std::function<Bytes()> with_tree(std::function<void(std::vector<CurveSpec>&)> change) {
    return [change] {
        EnvironmentSpec spec = complete_environment();
        change(spec.tree.curves);
        return spec.encode();
    };
}
// And then one number of TREE.
std::function<Bytes()> with_tree(std::function<void(std::vector<CurveSpec>&)> change, std::size_t at, int size,
                                 std::uint64_t value) {
    return [=] {
        Bytes file = with_tree(change)();
        set(file, payload_of(file, "TREE") + at, size, value);
        seal(file);
        return file;
    };
}

// Curve 1 of the complete file with its number of segments in the long form.
std::function<Bytes()> long_count(std::uint64_t segments) {
    return payload_field("TREE", 12, 6, segments << 16 | 0x1D1);
}

// A curve of two segments with positions of two bytes.
CurveSpec split(std::uint32_t axis, const std::vector<std::uint32_t>& positions) {
    CurveSpec curve = even_curve(axis, positions);
    curve.tilts = std::vector<int>{1, 2};
    return curve;
}

// One path leads to curve 2, which splits [3, 6] at 3 + step.
std::function<Bytes()> one_byte_below_3_to_6(std::uint32_t step) {
    return with_tree([step](std::vector<CurveSpec>& curves) {
        curves[1].children = {-1, -1};
        curves[2] = split(0, {3 + step});
        curves[2].position_bytes = 1;
        curves[2].origin = 3;
    });
}

std::function<Bytes()> curves_of_two_bytes(std::size_t count) {
    return [count] {
        EnvironmentSpec spec;
        spec.tree.curves.assign(count, CurveSpec());
        return spec.encode();
    };
}

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

acdf::Limits small_limits() {
    acdf::Limits limits;
    limits.max_inflated_bytes = 8;
    return limits;
}

std::vector<Case> container_cases() {
    return {
        {2001, "empty", [] { return Bytes(); }},
        {2001, "half_header", [] { return truncated(complete_file().encode(), 63); }},
        {2002, "damaged_magic", header_field(9, 1, 0x0D)},
        {2003, "next_major", header_field(12, 2, 2)},
        {2003, "draft", header_field(12, 2, 0)},
        {2004, "header_crc",
         [] {
             Bytes file = complete_file().encode();
             set(file, 60, 4, get(file, 60, 4) ^ 1);
             return file;
         }},
        {2005, "extra_bytes",
         [] {
             Bytes file = complete_file().encode();
             file.resize(file.size() + 64);
             return file;
         }},
        {2006, "kind_0", header_field(24, 4, 0)},
        {2006, "kind_5", header_field(24, 4, 5)},
        {2007, "feature_31", header_field(28, 4, 0x80000000)},
        {2008, "first", header_field(40, 4, 1)},
        {2008, "last", header_field(59, 1, 1)},
        {3001, "none", header_field(36, 4, 0)},
        {3001, "too_many", header_field(36, 4, 65)},
        {3001, "beyond_the_file", header_field(36, 4, 64)},
        {3002, "unknown", rebuilt([](FileSpec& f) {
             f.chunks.push_back({"XTRA", {1, 2, 3}, 1, false});
         })},
        {3003, "two_metadata", rebuilt([](FileSpec& f) { f.chunks.push_back(f.chunks[3]); })},
        {3003, "two_unknown", rebuilt([](FileSpec& f) {
             f.chunks.insert(f.chunks.end(), 2, {"XTRA", {1, 2, 3}, 0, false});
         })},
        {3014, "control_character", rebuilt([](FileSpec& f) {
             f.chunks.push_back({"XT\x1F"
                                 "A",
                                 {1, 2, 3},
                                 0,
                                 false});
         })},
        {3014, "beyond_ascii", rebuilt([](FileSpec& f) {
             f.chunks.push_back({"\xC3\x84TR", {1, 2, 3}, 1, false});
         })},
        {3014, "delete", rebuilt([](FileSpec& f) {
             f.chunks.push_back({"XTR\x7F", {1, 2, 3}, 0, false});
         })},
        {3004, "no_description", rebuilt([](FileSpec& f) { f.chunks.erase(f.chunks.begin()); })},
        {3004, "no_bins", rebuilt([](FileSpec& f) { f.chunks.erase(f.chunks.begin() + 1); })},
        {3004, "no_tree", rebuilt([](FileSpec& f) { f.chunks.erase(f.chunks.begin() + 2); })},
        {3005, "planes_of_metadata", record_field("META", 8, 4, 2)},
        {3005, "codec_3", record_field("TREE", 8, 4, 3)},
        {3006, "gap", changed([](Bytes& file) {
             const std::size_t at = payload_of(file, "META");
             file.insert(file.begin() + static_cast<std::ptrdiff_t>(at), 64, 0);
             set(file, record_of(file, "META") + 16, 8, at + 64);
             set(file, 16, 8, file.size());
         })},
        {3006, "overlap",
         changed([](Bytes& file) { set(file, record_of(file, "META") + 16, 8, payload_of(file, "TREE")); })},
        {3007, "beyond_the_file", changed([](Bytes& file) {
             for (std::size_t at : {24u, 32u}) set(file, record_of(file, "META") + at, 8, file.size());
         })},
        {3007, "overflow", changed([](Bytes& file) {
             for (std::size_t at : {24u, 32u}) set(file, record_of(file, "META") + at, 8, ~std::uint64_t{63});
         })},
        {3008, "more_padding", changed([](Bytes& file) {
             file.resize(file.size() + 64);
             set(file, 16, 8, file.size());
         })},
        {3009, "unknown_flag", record_field("META", 4, 4, 2)},
        {3009, "critical_metadata", record_field("META", 4, 4, 1)},
        {3009, "ancillary_tree", record_field("TREE", 4, 4, 0)},
        {3009, "reserved", record_field("BINS", 40, 8, std::uint64_t{1} << 63)},
        {3010, "longer", record_field("META", 32, 8, 1 << 20)},
        {3011, "bomb", changed([](Bytes& file) {
             const std::size_t record = record_of(file, "META");
             set(file, record + 8, 4, 1);
             set(file, record + 32, 8, 1032 * (get(file, record + 24, 8) + 1));
         })},
        {3011, "enormous", changed([](Bytes& file) {
             set(file, record_of(file, "META") + 8, 4, 1);
             set(file, record_of(file, "META") + 32, 8, ~std::uint64_t{0});
         })},
        {3012, "limit", rebuilt([](FileSpec& f) { f.chunks[3].zlib = true; }), small_limits()},
        {4001, "wrong",
         [] {
             Bytes file = complete_file().encode();
             const std::size_t at = record_of(file, "META") + 12;
             set(file, at, 4, get(file, at, 4) ^ 1);
             seal_header(file);
             return file;
         }},
        {4001, "unknown_chunk",
         [] {
             FileSpec spec = complete_file();
             spec.chunks.push_back({"XTRA", {1, 2, 3}, 0, false});
             Bytes file = spec.encode();
             file[payload_of(file, "XTRA")] ^= 1;
             return file;
         }},
        {4002, "after_the_table",
         [] {
             FileSpec spec = complete_file();
             spec.chunks.pop_back(); // the table of three ends at byte 208
             Bytes file = spec.encode();
             file[208] = 1;
             return file;
         }},
        {4002, "between", changed([](Bytes& file) { file[payload_of(file, "TREE") - 1] = 1; })},
        {4002, "at_the_end", changed([](Bytes& file) { file.back() = 1; })},
        {4003, "not_zlib", record_field("META", 8, 4, 1)},
        {4003, "longer_than_raw", zlib_metadata([](Bytes&, Bytes&, std::uint64_t& raw) { --raw; })},
        {4003, "shorter_than_raw", zlib_metadata([](Bytes&, Bytes&, std::uint64_t& raw) { ++raw; })},
        {4003, "bytes_after", zlib_metadata([](Bytes&, Bytes& stored, std::uint64_t&) { stored.push_back(0); })},
        {4003, "cut", zlib_metadata([](Bytes&, Bytes& stored, std::uint64_t&) { stored.pop_back(); })},
        {4003, "adler", zlib_metadata([](Bytes&, Bytes& stored, std::uint64_t&) { stored.back() ^= 1; })},
        {4004, "description_too_long", rebuilt([](FileSpec& f) { f.chunks[0].raw.resize(64 + 3 * 48); })},
        {4004, "description_too_short", rebuilt([](FileSpec& f) { f.chunks[0].raw.resize(63); })},
        {4004, "bins_too_long", rebuilt([](FileSpec& f) { f.chunks[1].raw.resize(16); })},
        {4004, "no_bins", rebuilt([](FileSpec& f) { f.chunks[1].raw.clear(); })},
    };
}

// Streams of preorder_environment: 8 holds 2 1 0, for curve 0, then 1 1, for curve 1.
std::vector<Case> plane_cases() {
    const auto streams = [](PlaneChange change) {
        return [change] { return as_planes(preorder_environment(), change).encode(); };
    };
    const auto bytes = [](std::function<void(Bytes&)> change) {
        return [change] {
            FileSpec file = as_planes(preorder_environment());
            change(file.chunks[2].raw);
            return file.encode();
        };
    };
    return {
        {4005, "counts_cut", bytes([](Bytes& planes) { planes.resize(43); })},
        {4005, "byte_missing", bytes([](Bytes& planes) { planes.pop_back(); })},
        {4005, "byte_more", bytes([](Bytes& planes) { planes.push_back(0); })},
        {4005, "enormous_count", bytes([](Bytes& planes) { set(planes, 4, 4, 0xFFFFFFFF); })},
        {4005, "longer_than_any", bytes([](Bytes& planes) { planes.resize(1000); })},
        {4005, "longer_tree", streams([](PlaneStreams&, std::uint64_t& length) { length += 4; })},
        {4005, "shorter_tree", streams([](PlaneStreams&, std::uint64_t& length) { length -= 4; })},
        {4005, "odd_tree", streams([](PlaneStreams&, std::uint64_t& length) { length -= 1; })},
        {4005, "value_left", streams([](PlaneStreams& s, std::uint64_t&) { s.values[3].push_back(1); })},
        {4005, "value_missing", streams([](PlaneStreams& s, std::uint64_t&) { s.values[4].pop_back(); })},
        {4005, "no_tilt", streams([](PlaneStreams& s, std::uint64_t&) { s.values[10].clear(); })},
        {4005, "cumulative_code", streams([](PlaneStreams& s, std::uint64_t&) { s.values[0][0] |= 3u << 3; })},
        {4005, "no_count", streams([](PlaneStreams& s, std::uint64_t&) { s.values[0][3] &= 0x3FFu; })},
        {4005, "count_of_0", streams([](PlaneStreams& s, std::uint64_t&) {
             s.values[0][3] &= 0x3FFu;
             s.values[1] = {0};
         })},
        {4005, "enormous_curve", streams([](PlaneStreams& s, std::uint64_t&) {
             s.values[0][3] &= 0x3FFu;
             s.values[1] = {0xFFFFFFFF};
         })},
        {4005, "no_such_segment", streams([](PlaneStreams& s, std::uint64_t&) { s.values[8][1] = 3; })},
        {4005, "two_children", streams([](PlaneStreams& s, std::uint64_t&) { s.values[8][2] = 1; })},
        {4005, "more_children", streams([](PlaneStreams& s, std::uint64_t&) { s.values[8] = {3, 1, 0, 2, 1, 1}; })},
        {4005, "too_many_children", streams([](PlaneStreams& s, std::uint64_t&) { s.values[8][0] = 9; })},
        {4005, "not_zlib", record_field("TREE", 8, 4, 2)},
        {4005, "bytes_after",
         [] {
             Bytes file = as_planes(preorder_environment()).encode();
             const std::size_t length = record_of(file, "TREE") + 24; // into the padding
             set(file, length, 8, get(file, length, 8) + 1);
             seal(file);
             return file;
         }},
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
        {5013, "two", third_axis(20, 4, 2)},
        {5014, "zero", third_axis(24, 4, 0)},
        {5014, "too_large", third_axis(24, 4, 0x80000000)},
        {5015, "equal", third_axis(32, 8, 0x3FF0000000000000)},
        {5015, "nan", third_axis(32, 8, 0x7FF8000000000000)},
        {5015, "infinite", third_axis(40, 8, 0x7FF0000000000000)},
        {5016, "half_angle", payload_field("DESC", 0, 4, 2)},
        {5016, "octahedral_table", [] { return octahedral_axes([](FileSpec& f) { f.kind = 4; })(); }},
        {5016, "environment_as_table", header_field(24, 4, 4)},
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

std::vector<Case> table_cases() {
    return {
        {9001, "cosine", table_field(64 + 3 * 48 + 20, 4, 1)},
        {9001, "indexed_cosine", table_field(64 + 20, 4, 1)},
        {9002, "sampled_first",
         [] {
             FileSpec file = table_file(); // exchanges axes 1 and 2; curves on axis 1 are then on a sampled one
             Bytes& raw = file.chunks[0].raw;
             std::swap_ranges(raw.begin() + 64 + 48, raw.begin() + 64 + 96, raw.begin() + 64 + 96);
             EnvironmentSpec tree = complete_environment();
             for (CurveSpec& curve : tree.tree.curves) curve.axis = curve.axis == 0 ? 1 : 3;
             file.chunks[2].raw = tree.file().chunks[2].raw;
             return file.encode();
         }},
        {9003, "fewer_bins",
         [] {
             FileSpec file = table_file();
             set(file.chunks[0].raw, 24, 4, 5);
             file.chunks[1].raw = encode(std::vector<BinSpec>(5, {0, 0.2f}));
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
             file.chunks[1].raw = encode(std::vector<BinSpec>(6, {0, 0.0f}));
             return file.encode();
         }},
        {9006, "separate", table_field(28, 4, 1)},
        {9006, "first", table_field(32, 8, 0x3FE0000000000000)},
        {9006, "second", table_field(40, 8, 0x3FE0000000000000)},
    };
}

std::vector<Case> cases() {
    std::vector<Case> all = container_cases();
    for (auto make : {plane_cases, description_cases, tree_cases, table_cases, local_cases, brdf_cases})
        for (const Case& c : make()) all.push_back(c);
    return all;
}

class BrokenRule : public testing::TestWithParam<Case> {};

TEST_P(BrokenRule, isFoundAndNoOther) {
    const Case& c = GetParam();
    const acdf::Rule* rule = acdf::find_rule(c.rule);
    ASSERT_NE(rule, nullptr);
    const Bytes file = c.make();
    const Findings found = findings(file, c.limits);
    EXPECT_EQ(std::set<int>(found.rules.begin(), found.rules.end()), std::set<int>{c.rule}) << found.text;
    EXPECT_LE(found.last_offset, file.size());
    const acdf::Status status = load(file, c.limits);
    EXPECT_EQ(status.code, rule->code);
    if (rule->severity == acdf::Severity::warning) return;
    EXPECT_EQ(status.rule, c.rule) << status.message;
    EXPECT_NE(std::strstr(status.message, std::to_string(c.rule).c_str()), nullptr) << status.message;
    EXPECT_EQ(std::strchr(status.message, '\n'), nullptr) << status.message;
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
    std::string id = acdf::find_rule(info.param.rule)->id;
    for (char& letter : id)
        if (letter == '-') letter = '_';
    return std::to_string(info.param.rule) + "_" + id + "_" + info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Rules, BrokenRule, testing::ValuesIn(cases()), case_name);

TEST(Rules, theCompleteFilesBreakNone) {
    for (const FileSpec& spec :
         {complete_file(), spare_file(), table_file(), chain(1).file(), chain(64).file(), shared_local().file(),
          lit_local().file(), separate_local().file(), shared_brdf().file(), separate_brdf().file()}) {
        const Findings found = findings(spec.encode());
        EXPECT_TRUE(found.rules.empty()) << found.text;
    }
    EXPECT_TRUE(load(table_shares(0.5f + 0x1p-21f)()).ok()); // what rounding leaves
    FileSpec spaced = complete_file();
    spaced.chunks.push_back({"X ~!", {1, 2, 3}, 0, false});
    EXPECT_TRUE(load(spaced.encode()).ok());
}

// Where no tile has a tree, a BRDF has a TREE that nothing uses; else unit 0 is not a root of its own.
TEST(Rules, unitZeroIsARootWhereTheSpecificationSaysSo) {
    BrdfSpec spec = separate_brdf();
    spec.tree.curves.insert(spec.tree.curves.begin(), CurveSpec());
    for (CurveSpec& curve : spec.tree.curves)
        for (int& child : curve.children) child += child >= 0;
    for (BinSpec& bin : spec.bins) ++bin.root;
    EXPECT_EQ(findings(spec.encode()).rules, std::multiset<int>{6012}); // a warning
    BrdfSpec tiles = shared_brdf();
    EXPECT_TRUE(findings(tiles.encode()).rules.empty());
    CurveSpec curve = even_curve(0, {5}); // in columns [3, 8), from which its knot counts
    curve.position_bytes = 1;
    curve.origin = 3;
    tiles.tree.curves = {curve};
    tiles.tile_curves = {-1, -1, 0, -1};
    EXPECT_TRUE(findings(tiles.encode()).rules.empty()) << findings(tiles.encode()).text;
    LocalSpec local = shared_local(); // where unit 0 is the whole environment's too
    local.tree.curves = {curve};
    local.tile_curves = {-1, 0, -1};
    EXPECT_EQ(findings(local.encode()).rules, std::multiset<int>{6019});
}

TEST(Rules, eachHasABrokenFile) {
    std::set<int> tested = {1001, 1002, 1003, 1004}; // reader_load.cpp: Open.rule1001 and so on
    for (const Case& c : cases()) tested.insert(c.rule);
    for (std::size_t i = 0; i < acdf::rule_count; ++i)
        EXPECT_TRUE(tested.count(acdf::rules[i].number)) << acdf::rules[i].number << " has no broken file";
}

// For other readers (tests/format/decoder.py): RULE_name.acdf for each broken file, in the folder that a variable
// names.
TEST(Rules, brokenFilesAreWrittenWhereAskedFor) {
    const char* folder = std::getenv("ACDF_BROKEN_FILES");
    if (!folder) GTEST_SKIP() << "ACDF_BROKEN_FILES names no folder";
    for (const Case& c : cases()) {
        if (c.limits.max_inflated_bytes != acdf::Limits().max_inflated_bytes) continue;
        const Bytes file = c.make();
        std::ofstream out(std::string(folder) + "/" + std::to_string(c.rule) + "_" + c.name + ".acdf",
                          std::ios::binary);
        out.write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
        ASSERT_TRUE(out.flush()) << folder;
    }
}

// With no sampled axis no curve can be right either.
TEST(Rules, someAxisIsSampled) {
    FileSpec file = spare_file();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        set(file.chunks[0].raw, 64 + 48 * axis + 16, 4, 1); // indexed
        set(file.chunks[0].raw, 64 + 48 * axis + 24, 4, 1); // of one step
    }
    EXPECT_EQ(load(file.encode()).rule, 5012);
    EXPECT_EQ(findings(file.encode()).rules, (std::multiset<int>{5012, 6003, 6003, 6003}));
}

TEST(Rules, areSortedAndNamedOnce) {
    std::set<std::string> ids;
    for (std::size_t i = 0; i < acdf::rule_count; ++i) {
        const acdf::Rule& rule = acdf::rules[i];
        if (i > 0) {
            EXPECT_LT(acdf::rules[i - 1].number, rule.number);
        }
        const bool same_id_elsewhere = !ids.insert(rule.id).second;
        EXPECT_FALSE(same_id_elsewhere) << rule.number << ' ' << rule.id;
        EXPECT_EQ(rule.severity == acdf::Severity::warning, rule.code == acdf::ErrorCode::none) << rule.number;
    }
    EXPECT_EQ(acdf::find_rule(2002), &acdf::rules[5]);
    EXPECT_EQ(acdf::find_rule(9999), nullptr);
}

// Faults that do not hide each other are all told; the sink may stop.
TEST(Validate, reportsAllFindings) {
    Bytes file = complete_file().encode();
    set(file, 28, 4, 5);                                 // two feature bits
    set(file, payload_of(file, "DESC") + 56, 8, 0);      // total 0
    set(file, payload_of(file, "TREE") + 34, 2, 0x8000); // tilt
    set(file, payload_of(file, "TREE") + 11, 1, 7);      // curve padding
    file.back() = 1;                                     // file padding
    seal(file);
    const Findings found = findings(file);
    EXPECT_EQ(found.rules, (std::multiset<int>{2007, 2007, 4002, 5010, 6011, 6013})) << found.text;
    int calls = 0;
    const acdf::Verdict verdict =
        acdf::validate(file.data(), file.size(), [&](const acdf::Finding&) { return ++calls < 3; });
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(verdict.errors, 3u);
    EXPECT_FALSE(verdict.valid());
}

} // namespace
