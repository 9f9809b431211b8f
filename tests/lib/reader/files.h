// Small files from which the tests of the reader make broken ones.
#pragma once

#include "tests/lib/reader/action.h"
#include "tests/lib/reader/random.h"

namespace acdf_test {

/// Three curves that use every array. Bytes of TREE:
///   0 header  2 cumulative[2] of 2   6 positions[2] of 1  8 links[3] of 1  11 padding  curve 0, axis 0, at unit 0
///   12 header 14 padding  16 cumulative[1] of 4  20 positions[1] of 4  24 links[2] of 4 curve 1, axis 1, at unit 6
///   32 header 34 tilts[1]                                                              curve 2, axis 0, at unit 16
/// 36 bytes. Curve 2 has two parents: segment 1 of curve 0, where its range is [3, 6], and segment 1 of curve 1,
/// where it is [0, 3].
inline EnvironmentSpec complete_environment() {
    EnvironmentSpec spec;
    spec.columns = spec.rows = 8;
    CurveSpec root = even_curve(0, {3, 6});
    root.position_bytes = 1;
    root.cumulative = {20000, 40000};
    root.link_bytes = 1;
    root.children = {1, 2, -1};
    CurveSpec rows = even_curve(1, {2});
    rows.cumulative_bytes = rows.position_bytes = 4;
    rows.cumulative = {0x80000000};
    rows.link_bytes = 4;
    rows.children = {-1, 2};
    CurveSpec tilted;
    tilted.tilts = std::vector<int>{1000};
    spec.tree = {{root, rows, tilted}, {}};
    spec.metadata = {{"tool", "test 1"}, {"source.name", "härbour.exr"}};
    return spec;
}
inline FileSpec complete_file() { return complete_environment().file(); }

/// A table of three axes, the last of which has one step.
inline FileSpec spare_file() {
    FileSpec file = complete_file();
    DescriptionSpec description;
    description.parameterization = 3;
    description.axes = {{"phi", 0, 0, 8, 0.0, 1.0}, {"theta", 0, 0, 8, 0.0, 1.0}, {"nor", 0, 0, 1, 0.0, 1.0}};
    description.weigh_as_table();
    file.kind = 4;
    file.chunks[0].raw = description.encode();
    file.chunks[2] = {"HALV", HalvingsSpec{8, 2, {{0, 100}, {1, 200}, {}, {}, {}}}.encode()};
    return file;
}

/// A table of 2 x 3 bins over two sampled axes, two bins without energy, two of more cells than one. Bytes of HALV:
/// 16 of header, 4 of structure (16 bits), 4 of codes.
inline FileSpec table_file() {
    FileSpec file = complete_file();
    DescriptionSpec description;
    description.parameterization = 3;
    description.bin_count = 6;
    description.axes = {
        {"i", 1, 0, 2, 0.0, 2.0}, {"j", 1, 0, 3, 5.0, -5.0}, {"x", 0, 0, 8, -1.0, 1.0}, {"y", 0, 0, 8, 10.0, 12.5}};
    description.weigh_as_table();
    file.kind = 4;
    file.chunks[0].raw = description.encode();
    constexpr std::uint32_t none = 0xFFFFFFFF;
    file.chunks[1].raw =
        encode(std::vector<BinSpec>{{0, 0.5f}, {none, 0.25f}, {2, 0.125f}, {none, 0}, {none, 0}, {3, 0.125f}});
    file.chunks[2] = {
        "HALV",
        HalvingsSpec{8, 1, {{0, 100}, {1, 200}, {}, {}, {}, {}, {1, 128}, {}, {}, {0, 255}, {}, {}}}.encode()};
    return file;
}

/// `length` curves of one segment, each the child of the one before.
inline EnvironmentSpec chain(int length) {
    EnvironmentSpec spec;
    spec.tree.curves.clear();
    for (int i = 0; i < length; ++i) {
        CurveSpec curve;
        if (i + 1 < length) {
            curve.link_bytes = 1;
            curve.children = {i + 1};
        }
        spec.tree.curves.push_back(curve);
    }
    return spec;
}

inline std::size_t record_of(const Bytes& file, const char* type) {
    for (std::size_t i = 0; i < get(file, 36, 4); ++i)
        if (std::memcmp(file.data() + chunk_at(i), type, 4) == 0) return chunk_at(i);
    return 0;
}
inline std::size_t payload_of(const Bytes& file, const char* type) {
    return static_cast<std::size_t>(get(file, record_of(file, type) + 16, 8));
}

inline Bytes truncated(Bytes file, std::size_t size) {
    file.resize(size);
    return file;
}

inline Action<Bytes()> metadata_file(const Metadata& metadata) {
    return [metadata] {
        EnvironmentSpec spec = complete_environment();
        spec.metadata = metadata;
        return spec.encode();
    };
}

/// META last and compressed; `change(raw, stored, raw_length)` before it is written.
inline Action<Bytes()> zlib_metadata(Action<void(Bytes&, Bytes&, std::uint64_t&)> change) {
    return [change] {
        FileSpec spec = complete_file();
        Bytes raw = spec.chunks[3].raw, stored = deflated(raw);
        std::uint64_t raw_length = raw.size();
        change(raw, stored, raw_length);
        spec.chunks[3].raw = stored;
        Bytes file = spec.encode();
        set(file, record_of(file, "META") + 8, 4, 1);
        set(file, record_of(file, "META") + 32, 8, raw_length);
        seal_header(file);
        return file;
    };
}

inline EnvironmentSpec compressed() {
    EnvironmentSpec spec = complete_environment();
    spec.zlib = true;
    return spec;
}

} // namespace acdf_test
