// layouts FILE.acdf...: what chunk TREE would take in other layouts before deflate, as Markdown on stdout. Every
// layout here can be undone: sizes of the arrays follow from the headers, in the order of the curves.
#include "compress/store/planes.h"

#include <acdf/reader.h>
#include <acdf/sample.h>

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
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
    bool delta, grouped, planes;
};
constexpr Layout layouts[] = {{"delta", true, false, false},
                              {"by kind", false, true, false},
                              {"by kind, delta", true, true, false},
                              {"by kind, byte planes", false, true, true},
                              {"by kind, delta, byte planes", true, true, true}};

/// One stream per kind of array, per size of its values, and per byte of these, in that order.
Bytes laid_out(std::vector<StoredCurve> curves, const Layout& layout) {
    std::map<std::vector<std::uint32_t>, Bytes> streams;
    for (StoredCurve& curve : curves)
        for (Array& array : curve.arrays) {
            if (layout.delta && (array.kind == Array::cumulative || array.kind == Array::positions)) delta(array);
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

/// What a curve without links must be equal in to be shared: its bytes, and where its range begins (rule 6019).
struct Place {
    std::uint32_t parent = 0;
    std::array<std::uint32_t, ACDF_MAX_AXES> low{};
};

std::map<std::uint32_t, Place> places_of(const acdf::File& file, const std::vector<StoredCurve>& curves) {
    std::map<std::uint32_t, Place> places;
    for (const StoredCurve& stored : curves) {
        const AcdfCurve curve = acdf_curve_at(file.tree(), stored.offset);
        const std::uint32_t axis = acdf_curve_axis(&curve), code = ACDF_CURVE_POSITION_CODE(curve.header);
        const Place own = places[stored.offset];
        for (std::uint32_t s = 0; curve.links && s < curve.segments; ++s) {
            const std::uint32_t link = acdf_curve_link(&curve, s);
            if (link == 0) continue;
            Place& place = places[stored.offset + link] = {stored.offset, own.low};
            if (s > 0) place.low[axis] = acdf_load(curve.positions, s - 1, code) + (code == 0 ? own.low[axis] : 0);
        }
    }
    return places;
}

/// Bytes of curves without links that a later one repeats: all; those that a link of one byte reaches; and of these
/// the ones that may be shared.
std::array<std::size_t, 3> repeated(const acdf::File& file, const std::vector<StoredCurve>& curves) {
    const std::map<std::uint32_t, Place> places = places_of(file, curves);
    std::array<std::size_t, 3> bytes{};
    std::map<Bytes, std::uint32_t> anywhere, alike; // the nearest one behind
    for (auto curve = curves.rbegin(); curve != curves.rend(); ++curve) {
        const AcdfCurve header = acdf_curve_at(file.tree(), curve->offset);
        if (header.links) continue;
        Bytes own(file.tree() + 2 * std::size_t{curve->offset}, file.tree() + 2 * std::size_t{curve->end});
        const Place& place = places.at(curve->offset);
        const std::size_t size = own.size();
        const auto reaches = [&](std::uint32_t at) { return at - place.parent <= 0xFF; };
        const auto [same, first] = anywhere.try_emplace(own, curve->offset);
        if (!first) bytes[0] += size;
        if (!first && reaches(same->second)) bytes[1] += size;
        else same->second = curve->offset;
        put(own, place.low[acdf_curve_axis(&header)], 4);
        put(own, acdf_curve_axis(&header), 1);
        const auto [may, only] = alike.try_emplace(own, curve->offset);
        if (!only && reaches(may->second)) bytes[2] += size;
        else may->second = curve->offset;
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
    for (const std::size_t bytes : repeated(file, curves)) std::printf(" | %zu", bytes);
    const Bytes stored(file.tree(), file.tree() + 2 * std::size_t{file.tree_units()});
    std::printf(" | %zu", deflated(stored));
    for (const Layout& layout : layouts) std::printf(" | %zu", deflated(laid_out(curves, layout)));
    std::printf(" | %zu |\n", deflated(acdf::compress::tree_to_planes(stored)));
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: layouts FILE.acdf...\n");
        return 2;
    }
    std::printf(
        "| file | TREE | headers | cumulative | positions | links | repeated curves | in reach | may be shared");
    std::printf(" | deflated, as stored");
    for (const Layout& layout : layouts) std::printf(" | %s", layout.name);
    std::printf(" | codec 2 |\n|");
    for (std::size_t i = 0; i < 11 + std::size(layouts); ++i) std::printf("---|");
    std::printf("\n");
    for (int i = 1; i < argc; ++i) report(argv[i]);
}
