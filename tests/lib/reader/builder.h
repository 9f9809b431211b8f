// Writes .acdf files from format/SPEC.md alone: it knows nothing of acdf/layout.h. It checks nothing, so that
// tests can write broken files too.
#pragma once

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace acdf_test {

using Bytes = std::vector<std::uint8_t>;

inline void put16(Bytes& out, std::uint32_t v) {
    for (int i = 0; i < 2; ++i) out.push_back(static_cast<std::uint8_t>(v >> 8 * i));
}
inline void put32(Bytes& out, std::uint32_t v) {
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(v >> 8 * i));
}
inline void put64(Bytes& out, std::uint64_t v) {
    for (int i = 0; i < 8; ++i) out.push_back(static_cast<std::uint8_t>(v >> 8 * i));
}
inline void put_double(Bytes& out, double v) {
    std::uint64_t bits;
    std::memcpy(&bits, &v, 8);
    put64(out, bits);
}
inline void put_float(Bytes& out, float v) {
    std::uint32_t bits;
    std::memcpy(&bits, &v, 4);
    put32(out, bits);
}
inline void put_text(Bytes& out, const std::string& text) { out.insert(out.end(), text.begin(), text.end()); }
inline void pad_to(Bytes& out, std::size_t multiple) {
    while (out.size() % multiple != 0) out.push_back(0);
}
inline std::uint64_t get(const Bytes& bytes, std::size_t at, int size) {
    std::uint64_t v = 0;
    for (int i = 0; i < size; ++i) v |= std::uint64_t{bytes[at + static_cast<std::size_t>(i)]} << 8 * i;
    return v;
}
inline void set(Bytes& bytes, std::size_t at, int size, std::uint64_t v) {
    for (int i = 0; i < size; ++i) bytes[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(v >> 8 * i);
}

/// CRC-32 (SPEC.md §1): of each byte bit by bit, once.
inline std::uint32_t crc32_of(const std::uint8_t* data, std::size_t size, std::uint32_t seed = 0) {
    static const std::array<std::uint32_t, 256> of_byte = [] {
        std::array<std::uint32_t, 256> table;
        for (std::uint32_t byte = 0; byte < 256; ++byte) {
            table[byte] = byte;
            for (int bit = 0; bit < 8; ++bit) table[byte] = table[byte] >> 1 ^ (table[byte] & 1 ? 0xEDB88320u : 0u);
        }
        return table;
    }();
    std::uint32_t crc = ~seed;
    for (std::size_t i = 0; i < size; ++i) crc = crc >> 8 ^ of_byte[(crc ^ data[i]) & 0xFF];
    return ~crc;
}

// ---- trees ----------------------------------------------------------------------------------------------

/// Widths are in bytes: 1, 2 or 4.
struct CurveSpec {
    std::uint32_t axis = 0;
    int cumulative_bytes = 1, position_bytes = 1;
    int link_bytes = 0;                    ///< 0: all segments end
    std::uint32_t origin = 0;              ///< what positions of one byte count from
    std::vector<std::uint32_t> cumulative; ///< interior values
    std::vector<std::uint32_t> positions;  ///< interior knots, on the axis
    std::vector<int> children;             ///< with links: one a segment, index of a curve or -1
    std::vector<int> tilts;                ///< empty, or one a segment

    static std::uint32_t code(int bytes) { return bytes == 4 ? 2 : bytes == 2 ? 1 : 0; }
    std::uint32_t maximum() const { return 0xFFFFFFFFu >> (32 - 8 * cumulative_bytes); }
    std::size_t segments() const { return positions.size() + 1; }
    bool many() const { return segments() > 63; }
    std::uint32_t header() const {
        const std::uint32_t link_code = link_bytes == 0 ? 0 : 1 + code(link_bytes);
        const auto count = static_cast<std::uint32_t>(many() ? 0 : segments());
        return axis | code(cumulative_bytes) << 3 | code(position_bytes) << 5 | link_code << 7 |
               (tilts.empty() ? 0u : 1u << 9) | count << 10;
    }
    std::uint32_t child_at(std::size_t i) const { return static_cast<std::uint32_t>(children[i]); }
};

inline void put(Bytes& out, std::uint32_t v, int bytes) {
    for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(v >> 8 * i));
}

/// One curve behind those already in `tree`; `starts` gives where each curve starts, in units of two bytes.
inline void encode(Bytes& tree, const CurveSpec& curve, std::size_t self,
                   const std::vector<std::uint32_t>& starts) {
    put16(tree, curve.header());
    if (curve.many()) put32(tree, static_cast<std::uint32_t>(curve.segments()));
    pad_to(tree, static_cast<std::size_t>(curve.cumulative_bytes));
    for (auto v : curve.cumulative) put(tree, v, curve.cumulative_bytes);
    pad_to(tree, static_cast<std::size_t>(curve.position_bytes));
    for (auto v : curve.positions)
        put(tree, curve.position_bytes == 1 ? v - curve.origin : v, curve.position_bytes);
    if (curve.link_bytes != 0) pad_to(tree, static_cast<std::size_t>(curve.link_bytes));
    for (std::size_t i = 0; curve.link_bytes != 0 && i < curve.segments(); ++i)
        put(tree, curve.children[i] < 0 ? 0 : starts[curve.child_at(i)] - starts[self], curve.link_bytes);
    pad_to(tree, 2);
    for (int tilt : curve.tilts) put16(tree, static_cast<std::uint32_t>(tilt) & 0xFFFF);
}

/// Curves in file order, and where each starts in units of two bytes.
struct TreeSpec {
    std::vector<CurveSpec> curves;
    std::vector<std::uint32_t> starts;

    Bytes encode() {
        Bytes tree;
        starts.assign(curves.size(), 0);
        for (int pass = 0; pass < 2; ++pass) { // the first finds the starts
            tree.clear();
            for (std::size_t i = 0; i < curves.size(); ++i) {
                if (pass == 0) starts[i] = static_cast<std::uint32_t>(tree.size() / 2);
                acdf_test::encode(tree, curves[i], i, starts);
            }
        }
        return tree;
    }
};

// ---- chunks ---------------------------------------------------------------------------------------------

struct AxisSpec {
    std::string name;
    std::uint32_t role = 0, measure = 0, resolution = 1;
    double low = 0.0, high = 1.0;
};

inline constexpr double pi = 3.14159265358979323846;

struct DescriptionSpec {
    std::uint32_t parameterization = 1, fit = 4, filter = 0, up_axis = 2, handedness = 0, bin_count = 1;
    double weights[3] = {0.2126, 0.7152, 0.0722};
    double total = 1.0;
    std::vector<AxisSpec> axes = {{"phi", 0, 0, 1, pi, -pi}, {"theta", 0, 1, 1, 0.0, pi}};

    /// The axes of the octahedral square.
    void make_octahedral() {
        parameterization = 4;
        axes[0] = {"u", 0, 0, axes[0].resolution, 0.0, 1.0};
        axes[1] = {"v", 0, 0, axes[1].resolution, 0.0, 1.0};
    }

    void weigh_as_table() {
        weights[0] = 1.0;
        weights[1] = weights[2] = 0.0;
    }
    Bytes encode() const {
        Bytes out;
        for (auto v : {parameterization, fit, filter, up_axis, handedness, static_cast<std::uint32_t>(axes.size()),
                       bin_count, 0u})
            put32(out, v);
        for (double w : weights) put_double(out, w);
        put_double(out, total);
        for (const AxisSpec& axis : axes) {
            const std::size_t start = out.size();
            put_text(out, axis.name);
            out.resize(start + 16, 0);
            for (auto v : {axis.role, axis.measure, axis.resolution, 0u}) put32(out, v);
            put_double(out, axis.low);
            put_double(out, axis.high);
        }
        return out;
    }
};

struct BinSpec {
    std::uint32_t root = 0;
    float share = 1.0f;
};

inline Bytes encode(const std::vector<BinSpec>& bins) {
    Bytes out;
    for (const BinSpec& bin : bins) {
        put32(out, bin.root);
        put_float(out, bin.share);
    }
    return out;
}

using Metadata = std::vector<std::pair<std::string, std::string>>;

inline Bytes encode(const Metadata& metadata) {
    Bytes out;
    put32(out, static_cast<std::uint32_t>(metadata.size()));
    for (const auto& [key, value] : metadata)
        for (const std::string* text : {&key, &value}) {
            put32(out, static_cast<std::uint32_t>(text->size()));
            put_text(out, *text);
        }
    return out;
}

struct ChunkSpec {
    std::string type; ///< four letters
    Bytes raw;
    std::uint32_t flags = 1;
    bool zlib = false;
    std::uint64_t planes_of = 0; ///< not 0: `raw` are the planes of a tree of so many bytes (codec 2)
};

/// With little memory, which costs less time than compressing: fuzzers write files by the million.
inline Bytes deflated(const Bytes& raw) {
    Bytes out(compressBound(static_cast<uLong>(raw.size())) + 64);
    z_stream stream = {};
    deflateInit2(&stream, 9, Z_DEFLATED, 9, 1, Z_DEFAULT_STRATEGY);
    stream.next_in = const_cast<Bytef*>(raw.data());
    stream.avail_in = static_cast<uInt>(raw.size());
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

// ---- files ----------------------------------------------------------------------------------------------

inline constexpr std::size_t header_size = 64, chunk_size = 48;
inline std::size_t chunk_at(std::size_t i) { return header_size + i * chunk_size; }

/// Writes the header's CRC anew.
inline void seal_header(Bytes& file) {
    const std::uint64_t count = get(file, 36, 4);
    const std::uint32_t crc = crc32_of(file.data(), 60);
    const std::size_t left = file.size() - header_size;
    const std::size_t table = count <= left / chunk_size ? static_cast<std::size_t>(count) * chunk_size : left;
    set(file, 60, 4, crc32_of(file.data() + header_size, table, crc));
}

/// Writes all CRCs anew, as far as chunks lie inside the file.
inline void seal(Bytes& file) {
    const std::uint64_t count = get(file, 36, 4);
    for (std::size_t i = 0; i < count && chunk_at(i + 1) <= file.size(); ++i) {
        const std::uint64_t offset = get(file, chunk_at(i) + 16, 8), stored = get(file, chunk_at(i) + 24, 8);
        if (offset > file.size() || stored > file.size() - offset) continue;
        set(file, chunk_at(i) + 12, 4, crc32_of(file.data() + offset, static_cast<std::size_t>(stored)));
    }
    seal_header(file);
}

struct FileSpec {
    std::uint32_t kind = 1, minor = 0;
    std::vector<ChunkSpec> chunks;

    Bytes encode() const {
        Bytes file = {0xAB, 'A', 'C', 'D', 'F', ' ', ' ', 0xBB, 0x0D, 0x0A, 0x1A, 0x0A};
        put16(file, 1);
        put16(file, minor);
        put64(file, 0); // file_length, below
        put32(file, kind);
        put32(file, 0);
        put32(file, 0);
        put32(file, static_cast<std::uint32_t>(chunks.size()));
        file.resize(header_size, 0);
        file.resize(chunk_at(chunks.size()), 0);
        for (std::size_t i = 0; i < chunks.size(); ++i) {
            const ChunkSpec& chunk = chunks[i];
            const Bytes stored = chunk.zlib || chunk.planes_of ? deflated(chunk.raw) : chunk.raw;
            pad_to(file, 64);
            std::memcpy(file.data() + chunk_at(i), chunk.type.data(), 4);
            set(file, chunk_at(i) + 4, 4, chunk.flags);
            set(file, chunk_at(i) + 8, 4, chunk.planes_of ? 2 : chunk.zlib ? 1 : 0);
            set(file, chunk_at(i) + 16, 8, file.size());
            set(file, chunk_at(i) + 24, 8, stored.size());
            set(file, chunk_at(i) + 32, 8, chunk.planes_of ? chunk.planes_of : chunk.raw.size());
            file.insert(file.end(), stored.begin(), stored.end());
        }
        pad_to(file, 64);
        set(file, 16, 8, file.size());
        seal(file);
        return file;
    }
};

/// The chunks of a file whose table and payloads lie inside it; empty where they do not.
inline FileSpec taken_apart(const Bytes& file) {
    FileSpec spec;
    if (file.size() < header_size) return spec;
    const std::uint64_t count = get(file, 36, 4);
    if (count > 64 || chunk_at(static_cast<std::size_t>(count)) > file.size()) return spec;
    spec.minor = static_cast<std::uint32_t>(get(file, 14, 2));
    spec.kind = static_cast<std::uint32_t>(get(file, 24, 4));
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t offset = get(file, chunk_at(i) + 16, 8), stored = get(file, chunk_at(i) + 24, 8);
        const auto codec = get(file, chunk_at(i) + 8, 4);
        if (offset > file.size() || stored > file.size() - offset) return FileSpec();
        const auto* begin = file.data() + offset;
        ChunkSpec chunk;
        chunk.type.assign(reinterpret_cast<const char*>(file.data() + chunk_at(i)), 4);
        chunk.flags = static_cast<std::uint32_t>(get(file, chunk_at(i) + 4, 4));
        chunk.zlib = codec == 1 || codec == 2;
        if (codec == 2) chunk.planes_of = get(file, chunk_at(i) + 32, 8);
        chunk.raw.assign(begin, begin + stored);
        if (chunk.zlib) {
            static std::uint8_t room[1 << 16];
            uLongf size = sizeof room;
            if (uncompress(room, &size, begin, static_cast<uLong>(stored)) != Z_OK) return FileSpec();
            chunk.raw.assign(room, room + size);
        }
        spec.chunks.push_back(chunk);
    }
    return spec;
}

/// A node of a tree of halvings.
struct HalvingSpec {
    int axis = -1; ///< -1: a leaf
    std::uint32_t code = 0;
};

/// Bits, the lowest of each byte first (SPEC.md §6.2).
class BitSpec {
public:
    void put(std::uint32_t value, std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) bits_.push_back(value >> i & 1);
    }
    void add_to(Bytes& out) const {
        const std::size_t begin = out.size();
        out.resize(begin + (bits_.size() + 31) / 32 * 4, 0);
        for (std::size_t i = 0; i < bits_.size(); ++i)
            out[begin + i / 8] = static_cast<std::uint8_t>(out[begin + i / 8] | bits_[i] << i % 8);
    }

private:
    std::vector<std::uint32_t> bits_;
};

/// Chunk HALV of a tree over two sampled axes.
struct HalvingsSpec {
    std::uint32_t code_bits = 8, axis_bits = 1;
    std::vector<HalvingSpec> nodes; ///< in preorder

    Bytes encode() const {
        BitSpec structure, codes;
        std::uint32_t count = 0;
        for (const HalvingSpec& node : nodes) {
            structure.put(node.axis >= 0, 1);
            if (node.axis < 0) continue;
            structure.put(static_cast<std::uint32_t>(node.axis), axis_bits);
            codes.put(node.code, code_bits);
            ++count;
        }
        Bytes out;
        for (const std::uint32_t v : {count, code_bits, 0u, 0u}) put32(out, v);
        structure.add_to(out);
        codes.add_to(out);
        return out;
    }
};

/// An environment file with everything that SPEC.md asks of one.
struct EnvironmentSpec {
    std::uint32_t columns = 1, rows = 1;
    HalvingsSpec halvings; ///< instead of curves, if it has nodes
    TreeSpec tree = {{CurveSpec{}}, {}};
    std::size_t root = 0; ///< index of a curve
    Metadata metadata;    ///< no chunk META if empty
    bool zlib = false;
    double total = 1.0;
    bool octahedral = false;

    FileSpec file() {
        DescriptionSpec description;
        description.axes[0].resolution = columns;
        description.axes[1].resolution = rows;
        description.total = total;
        if (octahedral) description.make_octahedral();
        const Bytes curves = tree.encode();
        FileSpec file;
        file.chunks = {{"DESC", description.encode(), 1, zlib}};
        if (halvings.nodes.empty()) {
            file.chunks.push_back(
                {"BINS", acdf_test::encode(std::vector<BinSpec>{{tree.starts[root], 1.0f}}), 1, zlib});
            file.chunks.push_back({"TREE", curves, 1, zlib});
        } else {
            file.chunks.push_back({"HALV", halvings.encode(), 1, zlib});
        }
        if (!metadata.empty()) file.chunks.push_back({"META", acdf_test::encode(metadata), 0, zlib});
        return file;
    }
    Bytes encode() { return file().encode(); }
};

} // namespace acdf_test
