// What a device answers by exported functions and tables, beside the reader.
//
//   compare_shader inputs FILE.acdf COUNT FOLDER     writes words.bin, directions.bin and normals.bin
//   compare_shader check FILE.acdf COUNT FOLDER ULPS reads samples.bin and pdfs.bin, and fails where they
//   differ
//
// words.bin: two u32 a sample. directions.bin, normals.bin: x y z 0, floats. samples.bin: x y z pdf. pdfs.bin:
// the pdf of the direction, and that of the sample's. Random numbers are fixed.
#include "tests/shaders/answers.h"
#include "tests/shaders/check.h"

#include <acdf/indexed/views.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace acdf_test;

// From the first coordinate of each axis to the last, and a little beyond.
void write_coordinates(const AcdfIndexed& data, std::mt19937& random, float* out) {
    const double* of_axis = data.coordinates;
    for (std::uint32_t axis = 0; axis < data.axes; of_axis += data.counts[axis++]) {
        const double low = of_axis[0], wide = of_axis[data.counts[axis] - 1] - low;
        out[axis] = static_cast<float>(low + wide * (static_cast<double>(random()) * 0x1p-32 * 1.1 - 0.05));
    }
}

// Normals, which of a BRDF are views: above the surface; of several maps coordinates.
void write_inputs(const acdf::File& file, std::size_t count, const std::string& folder) {
    std::mt19937 random(7);
    std::vector<std::uint32_t> words;
    std::vector<float> directions, normals;
    acdf::IndexedEnvironment maps; // empty for other kinds
    acdf::IndexedEnvironment::open(file, maps);
    const auto add_direction = [&](std::vector<float>& out) {
        const double z = 1.0 - static_cast<double>(random()) * 0x1p-31,
                     phi = 2.0 * M_PI * static_cast<double>(random()) * 0x1p-32;
        const double sine = std::sqrt((1.0 - z) * (1.0 + z));
        for (const double x : {sine * std::cos(phi), sine * std::sin(phi), z, 0.0})
            out.push_back(static_cast<float>(x));
    };
    for (std::size_t i = 0; i < count; ++i) {
        for (int axis = 0; axis < 2; ++axis) words.push_back(static_cast<std::uint32_t>(random()));
        add_direction(directions);
    }
    for (std::size_t i = 0; i < count; ++i) {
        add_direction(normals);
        if (file.kind() == ACDF_KIND_BRDF) normals[4 * i + 2] = std::max(std::fabs(normals[4 * i + 2]), 1e-6f);
        if (!maps.empty()) write_coordinates(maps.data(), random, &normals[4 * i]);
    }
    write_all(folder + "/words.bin", words);
    write_all(folder + "/directions.bin", directions);
    write_all(folder + "/normals.bin", normals);
}

} // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    if (!(what == "inputs" && argc == 5) && !(what == "check" && argc == 6)) {
        std::fprintf(stderr, "usage: compare_shader inputs|check FILE.acdf COUNT FOLDER [ULPS]\n");
        return 2;
    }
    acdf::File file;
    const acdf::Status status = acdf::File::open(argv[2], file);
    if (!status.ok()) {
        std::fprintf(stderr, "%s: %s\n", argv[2], status.message);
        return 1;
    }
    const auto count = static_cast<std::size_t>(std::strtoul(argv[3], nullptr, 10));
    if (what == "check") return check(file, count, argv[4], std::strtod(argv[5], nullptr));
    write_inputs(file, count, argv[4]);
    return 0;
}
