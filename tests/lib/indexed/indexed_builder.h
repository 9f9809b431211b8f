// Small indexed environments, byte by byte.
#pragma once

#include "tests/lib/reader/builder.h"

#include <cstring>
#include <vector>

namespace acdf_test {

struct MapSpec {
    float share, sun_share, radius;
    float sun[3];
    std::vector<std::uint32_t> codes; ///< of the splits that have a code of each map
};

/// Two maps, or as many as the axes make, over a tree of three halvings: two with codes of each map.
struct IndexedSpec {
    std::uint32_t columns = 8, rows = 8, code_bits = 8, sun = 2;
    bool octahedral = false, zlib = false;
    HalvingsSpec halvings;
    std::vector<bool> own = {true, true, false};
    std::vector<AxisSpec> axes = {{"time", 1, 0, 2, 6.0, 18.0}};
    std::vector<std::vector<double>> coordinates = {{6.0, 18.0}};
    std::vector<MapSpec> maps = {{0.25f, 0.5f, 0.25f, {1.0f, 0.0f, 0.0f}, {100, 20}},
                                 {0.75f, 0.25f, 0.125f, {0.0f, 0.0f, 1.0f}, {30, 200}}};

    IndexedSpec() { halvings.nodes = {{0, 128}, {1, 128}, {}, {}, {1, 60}, {}, {}}; }

    Bytes maps_chunk() const {
        Bytes raw;
        std::size_t splits = 0;
        for (const bool each : own) splits += each;
        put32(raw, static_cast<std::uint32_t>(maps.size()));
        put32(raw, static_cast<std::uint32_t>(splits));
        put32(raw, code_bits);
        put32(raw, sun);
        for (const auto& axis : coordinates)
            for (const double at : axis) put_bytes(raw, &at, sizeof at);
        for (const MapSpec& map : maps) {
            const float numbers[6] = {map.share, map.sun_share, map.radius, map.sun[0], map.sun[1], map.sun[2]};
            put_bytes(raw, numbers, sizeof numbers);
        }
        std::vector<bool> bits = own;
        put_bits(raw, bits);
        bits.clear();
        for (const MapSpec& map : maps)
            for (const std::uint32_t code : map.codes)
                for (std::uint32_t bit = 0; bit < code_bits; ++bit) bits.push_back(code >> bit & 1u);
        put_bits(raw, bits);
        return raw;
    }

    /// DESC, HALV, MAPS.
    FileSpec file() const {
        EnvironmentSpec tree;
        tree.columns = columns;
        tree.rows = rows;
        tree.octahedral = octahedral;
        tree.halvings = halvings;
        FileSpec out = tree.file();
        out.kind = 5;
        Bytes& description = out.chunks[0].raw;
        set(description, 20, 4, 2 + axes.size());
        set(description, 24, 4, maps.size());
        DescriptionSpec others;
        others.axes = axes;
        const Bytes encoded = others.encode();
        description.insert(description.end(), encoded.begin() + 64, encoded.end());
        out.chunks.push_back({"MAPS", maps_chunk(), 1, zlib});
        return out;
    }
    Bytes encode() const { return file().encode(); }

private:
    static void put_bytes(Bytes& raw, const void* data, std::size_t size) {
        const auto* from = static_cast<const std::uint8_t*>(data);
        raw.insert(raw.end(), from, from + size);
    }
    static void put_bits(Bytes& raw, const std::vector<bool>& bits) {
        const std::size_t begin = raw.size();
        raw.resize(begin + (bits.size() + 31) / 32 * 4, 0);
        for (std::size_t i = 0; i < bits.size(); ++i)
            if (bits[i]) raw[begin + i / 8] = static_cast<std::uint8_t>(raw[begin + i / 8] | 1u << i % 8);
    }
};

} // namespace acdf_test
