// .npy files and small tables for the tests.
#pragma once

#include "build/table.h"
#include "input/npy.h"
#include "tests/inputs/synthetic.h"
#include "tests/tools/run.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace acdf::test {

using ShapeVector = std::vector<std::uint32_t>;

/// A whole file: magic, version, header length, `dict` padded as numpy does, `data`.
inline std::string npy_file(const std::string& dict, const std::string& data, int major = 1) {
    std::string file = "\x93NUMPY";
    file += static_cast<char>(major);
    file += '\0';
    const std::size_t length_bytes = major == 1 ? 2 : 4;
    std::string text = dict;
    while ((file.size() + length_bytes + text.size() + 1) % 64 != 0) text += ' ';
    text += '\n';
    for (std::size_t i = 0; i < length_bytes; ++i) file += static_cast<char>(text.size() >> (8 * i) & 0xFF);
    return file + text + data;
}

inline std::string npy_dict(const std::string& descr, bool fortran, const ShapeVector& shape) {
    std::string text =
        "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': (";
    for (const std::uint32_t length : shape) text += std::to_string(length) + ", ";
    return text + "), }";
}

template <class Number>
std::string raw_bytes(const std::vector<Number>& values) {
    std::string data(values.size() * sizeof(Number), '\0');
    std::memcpy(data.data(), values.data(), data.size());
    return data;
}

template <class Number>
std::string npy_file(const std::vector<Number>& values, const ShapeVector& shape, bool fortran = false,
                     int major = 1) {
    return npy_file(npy_dict(sizeof(Number) == 4 ? "<f4" : "<f8", fortran, shape), raw_bytes(values), major);
}

inline std::size_t count_of(const ShapeVector& shape) {
    std::size_t n = 1;
    for (const std::uint32_t length : shape) n *= length;
    return n;
}

/// An array whose number at an index is f(index).
inline input::NpyArray array_of(const ShapeVector& shape, const std::function<double(const ShapeVector&)>& f) {
    input::NpyArray array;
    array.shape = shape;
    ShapeVector index(shape.size(), 0);
    for (std::size_t i = 0; i < count_of(shape); ++i) {
        array.values.push_back(static_cast<float>(f(index)));
        for (std::size_t axis = shape.size(); axis-- > 0 && ++index[axis] == shape[axis];) index[axis] = 0;
    }
    return array;
}

/// Log-normal numbers around a smooth bump, a share of them 0.
inline input::NpyArray noisy_array(const ShapeVector& shape, std::uint64_t seed, double dark = 0.2) {
    std::mt19937_64 random(seed);
    return array_of(shape, [&](const ShapeVector& index) {
        double bump = 0.0;
        for (std::size_t axis = 0; axis < shape.size(); ++axis) {
            const double d = (index[axis] + 0.5) / shape[axis] - 0.3 - 0.1 * static_cast<double>(axis);
            bump += d * d;
        }
        const double gauss = std::sqrt(-2.0 * std::log(1.0 - acdf_test::uniform(random))) *
                             std::cos(2.0 * acdf_test::kPi * acdf_test::uniform(random));
        return acdf_test::uniform(random) < dark ? 0.0 : std::exp(-20.0 * bump + 0.5 * gauss);
    });
}

/// A file in memory, ready to be sampled.
struct LoadedTable {
    std::vector<std::uint8_t> bytes;
    File file;

    explicit LoadedTable(std::vector<std::uint8_t> data) : bytes(std::move(data)) {
        const Status status = File::from_memory(bytes.data(), bytes.size(), file);
        if (!status.ok()) throw std::runtime_error(status.message);
    }
};

inline build::Table table_of(const input::NpyArray& array, const build::TableOptions& options) {
    return build::build_table(array, "test.npy", "", options);
}

} // namespace acdf::test
