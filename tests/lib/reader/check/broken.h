// The complete file with one thing changed: what breaks a rule.
#pragma once

#include "tests/lib/curves/planes.h"
#include "tests/lib/reader/action.h"
#include "tests/lib/reader/files.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <limits>
#include <vector>

namespace acdf_test {
// Changes the complete file, then makes the CRCs right again.
inline Action<Bytes()> changed(Action<void(Bytes&)> change) {
    return [change] {
        Bytes file = complete_file().encode();
        change(file);
        seal(file);
        return file;
    };
}

// One number of the file, `at` bytes into a chunk's payload or table record.
inline Action<Bytes()> header_field(std::size_t at, int size, std::uint64_t value) {
    return changed([=](Bytes& file) { set(file, at, size, value); });
}
inline Action<Bytes()> record_field(const char* type, std::size_t at, int size, std::uint64_t value) {
    return changed([=](Bytes& file) { set(file, record_of(file, type) + at, size, value); });
}
inline Action<Bytes()> payload_field(const char* type, std::size_t at, int size, std::uint64_t value) {
    return changed([=](Bytes& file) { set(file, payload_of(file, type) + at, size, value); });
}
inline Action<Bytes()> payload_double(const char* type, std::size_t at, double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, 8);
    return payload_field(type, at, 8, bits);
}

constexpr std::uint32_t kNoRoot = 0xFFFFFFFF;

// The same for a table whose third axis has one step.
inline Action<Bytes()> third_axis(std::size_t at, int size, std::uint64_t value) {
    return [=] {
        Bytes file = spare_file().encode();
        set(file, payload_of(file, "DESC") + 64 + 2 * 48 + at, size, value);
        seal(file);
        return file;
    };
}

// One number of DESC of the table.
inline Action<Bytes()> table_field(std::size_t at, int size, std::uint64_t value) {
    return [=] {
        FileSpec file = table_file();
        set(file.chunks[0].raw, at, size, value);
        return file.encode();
    };
}
inline Action<Bytes()> table_range(double low, double high) { // of the first sampled axis
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

inline Action<Bytes()> table_shares(float first) { // of six bins, the others together a half
    return [=] {
        FileSpec file = table_file();
        file.chunks[1].raw = encode(std::vector<BinSpec>{
            {0, first}, {kNoRoot, 0.25f}, {2, 0.125f}, {kNoRoot, 0}, {kNoRoot, 0}, {3, 0.125f}});
        return file.encode();
    };
}

// Changes the parts before they become a file.
inline Action<Bytes()> rebuilt(Action<void(FileSpec&)> change) {
    return [change] {
        FileSpec file = complete_file();
        change(file);
        return file.encode();
    };
}
// The same of a file on the octahedral square.
inline Action<Bytes()> octahedral_axes(Action<void(FileSpec&)> change) {
    return [change] {
        EnvironmentSpec spec = complete_environment();
        spec.octahedral = true;
        FileSpec file = spec.file();
        change(file);
        return file.encode();
    };
}
inline Action<Bytes()> with_tree(Action<void(std::vector<CurveSpec>&)> change) {
    return [change] {
        EnvironmentSpec spec = complete_environment();
        change(spec.tree.curves);
        return spec.encode();
    };
}
// And then one number of TREE.
inline Action<Bytes()> with_tree(Action<void(std::vector<CurveSpec>&)> change, std::size_t at, int size,
                                 std::uint64_t value) {
    return [=] {
        Bytes file = with_tree(change)();
        set(file, payload_of(file, "TREE") + at, size, value);
        seal(file);
        return file;
    };
}

// Curve 1 of the complete file with its number of segments in the long form.
inline Action<Bytes()> long_count(std::uint64_t segments) {
    return payload_field("TREE", 12, 6, segments << 16 | 0x1D1);
}

// A curve of two segments with positions of two bytes.
inline CurveSpec split(std::uint32_t axis, const std::vector<std::uint32_t>& positions) {
    CurveSpec curve = even_curve(axis, positions);
    curve.tilts = std::vector<int>{1, 2};
    return curve;
}

// One path leads to curve 2, which splits [3, 6] at 3 + step.
inline Action<Bytes()> one_byte_below_3_to_6(std::uint32_t step) {
    return with_tree([step](std::vector<CurveSpec>& curves) {
        curves[1].children = {-1, -1};
        curves[2] = split(0, {3 + step});
        curves[2].position_bytes = 1;
        curves[2].origin = 3;
    });
}

inline Action<Bytes()> curves_of_two_bytes(std::size_t count) {
    return [count] {
        EnvironmentSpec spec;
        spec.tree.curves.assign(count, CurveSpec());
        return spec.encode();
    };
}

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

inline acdf::Limits small_limits() {
    acdf::Limits limits;
    limits.max_inflated_bytes = 8;
    return limits;
}
} // namespace acdf_test
