// layouts FILE.acdf...: what chunk TREE would take in other layouts before deflate, as Markdown on stdout. Every
// layout here can be undone: sizes of the arrays follow from the headers, in the order of the curves.
#include <acdf/reader.h>
#include <acdf/sample.h>

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using Bytes = std::vector<std::uint8_t>;

/// One array of a curve: `count` values of `size` bytes each.
struct Array {
    enum Kind { header, cumulative, positions, links, tilts, kinds };
    Kind kind;
    std::uint32_t size;
    std::vector<std::uint32_t> values;
};

struct StoredCurve {
    std::uint32_t offset = 0, end = 0; // in units of two bytes
    std::vector<Array> arrays;
};

Array array_of(Array::Kind kind, const std::uint8_t* data, std::uint32_t count, std::uint32_t code) {
    Array array{kind, acdf_element_size(code), {}};
    for (std::uint32_t i = 0; i < count; ++i) array.values.push_back(acdf_load(data, i, code));
    return array;
}

std::vector<StoredCurve> curves_of(const acdf::File& file) {
    std::vector<StoredCurve> curves;
    for (std::uint32_t at = 0; at < file.tree_units();) {
        StoredCurve stored;
        AcdfCurve curve;
        stored.offset = at;
        at = stored.end = static_cast<std::uint32_t>(acdf_curve_decode(file.tree(), at, &curve));
        const std::uint32_t n = curve.segments;
        stored.arrays.push_back({Array::header, 2, {curve.header}});
        if (curve.header >> ACDF_CURVE_SEGMENTS_SHIFT == 0) stored.arrays.push_back({Array::header, 4, {n}});
        stored.arrays.push_back(
            array_of(Array::cumulative, curve.cumulative, n - 1, ACDF_CURVE_CUMULATIVE_CODE(curve.header)));
        stored.arrays.push_back(
            array_of(Array::positions, curve.positions, n - 1, ACDF_CURVE_POSITION_CODE(curve.header)));
        if (curve.links)
            stored.arrays.push_back(array_of(Array::links, curve.links, n, ACDF_CURVE_LINK_CODE(curve.header) - 1));
        if (curve.tilts) stored.arrays.push_back(array_of(Array::tilts, curve.tilts, n, 1));
        curves.push_back(std::move(stored));
    }
    return curves;
}

/// Values minus the one before them, within an array.
void delta(Array& array) {
    for (std::size_t i = array.values.size(); i-- > 1;) array.values[i] -= array.values[i - 1];
}

/// A link's rank among those of its curve, from 1: subtrees lie one after the other behind their parent, so that
/// their sizes give the distances back.
void rank(Array& links) {
    const std::set<std::uint32_t> sorted(links.values.begin(), links.values.end());
    for (std::uint32_t& link : links.values)
        if (link != 0)
            link = static_cast<std::uint32_t>(std::distance(sorted.begin(), sorted.find(link))) + !sorted.count(0);
}

void put(Bytes& bytes, std::uint32_t value, std::uint32_t size) {
    for (std::uint32_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::size_t deflated(const Bytes& raw) {
    uLongf size = compressBound(static_cast<uLong>(raw.size()));
    Bytes out(size);
    if (compress2(out.data(), &size, raw.data(), static_cast<uLong>(raw.size()), Z_BEST_COMPRESSION) != Z_OK)
        std::abort();
    return size;
}

struct Layout {
    const char* name;
    bool delta, grouped, planes, ranks;
};
constexpr Layout layouts[] = {{"as stored", false, false, false, false},
                              {"delta", true, false, false, false},
                              {"by kind", false, true, false, false},
                              {"by kind, delta", true, true, false, false},
                              {"by kind, byte planes", false, true, true, false},
                              {"by kind, delta, byte planes", true, true, true, false},
                              {"by kind, delta, byte planes, links as ranks", true, true, true, true}};

/// One stream per kind of array, per size of its values, and per byte of these, in that order.
Bytes laid_out(std::vector<StoredCurve> curves, const Layout& layout) {
    std::map<std::vector<std::uint32_t>, Bytes> streams;
    for (StoredCurve& curve : curves)
        for (Array& array : curve.arrays) {
            if (layout.delta && (array.kind == Array::cumulative || array.kind == Array::positions)) delta(array);
            if (layout.ranks && array.kind == Array::links) rank(array);
            const std::uint32_t kind = layout.grouped ? array.kind : Array::header;
            for (const std::uint32_t value : array.values) {
                if (!layout.planes) put(streams[{kind}], value, array.size);
                else
                    for (std::uint32_t i = 0; i < array.size; ++i)
                        streams[{kind, array.size, i}].push_back(static_cast<std::uint8_t>(value >> (8 * i)));
            }
        }
    Bytes out;
    for (const auto& stream : streams) out.insert(out.end(), stream.second.begin(), stream.second.end());
    return out;
}

/// Bytes of curves without links that repeat an earlier one, and so could be shared (if links reached them).
std::size_t repeated(const acdf::File& file, const std::vector<StoredCurve>& curves) {
    std::set<Bytes> seen;
    std::size_t bytes = 0;
    for (const StoredCurve& curve : curves) {
        const bool links = std::any_of(curve.arrays.begin(), curve.arrays.end(),
                                       [](const Array& array) { return array.kind == Array::links; });
        const Bytes own(file.tree() + 2 * std::size_t{curve.offset}, file.tree() + 2 * std::size_t{curve.end});
        if (!links && !seen.insert(own).second) bytes += own.size();
    }
    return bytes;
}

void report(const char* path) {
    acdf::File file;
    if (const acdf::Status status = acdf::File::open(path, file); !status.ok()) {
        std::fprintf(stderr, "%s: %s\n", path, status.message);
        std::exit(1);
    }
    const std::vector<StoredCurve> curves = curves_of(file);
    std::size_t kinds[Array::kinds] = {};
    for (const StoredCurve& curve : curves)
        for (const Array& array : curve.arrays) kinds[array.kind] += array.size * array.values.size();
    std::printf("| %s | %zu", std::filesystem::path(path).stem().string().c_str(),
                2 * std::size_t{file.tree_units()});
    for (int kind : {Array::header, Array::cumulative, Array::positions, Array::links})
        std::printf(" | %zu", kinds[kind]);
    std::printf(" | %zu", repeated(file, curves));
    for (const Layout& layout : layouts) {
        const Bytes stored(file.tree(), file.tree() + 2 * std::size_t{file.tree_units()});
        std::printf(" | %zu", deflated(&layout == layouts ? stored : laid_out(curves, layout)));
    }
    std::printf(" |\n");
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: layouts FILE.acdf...\n");
        return 2;
    }
    std::printf("| file | TREE | headers | cumulative | positions | links | repeated curves");
    for (const Layout& layout : layouts) std::printf(" | deflated, %s", layout.name);
    std::printf(" |\n|");
    for (std::size_t i = 0; i < 7 + std::size(layouts); ++i) std::printf("---|");
    std::printf("\n");
    for (int i = 1; i < argc; ++i) report(argv[i]);
}
