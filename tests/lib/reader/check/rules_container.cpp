// Files whose header, chunk table or planes break a rule.
#include "tests/lib/reader/check/broken.h"
#include "tests/lib/reader/check/cases.h"

namespace acdf_test {
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
        {2006, "kind_6", header_field(24, 4, 6)},
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
    const auto bytes = [](Action<void(Bytes&)> change) {
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
} // namespace acdf_test
