// What a device answers by exported functions and tables, beside the reader.
//
//   compare_shader inputs FILE.acdf COUNT FOLDER     writes words.bin, directions.bin and normals.bin
//   compare_shader check FILE.acdf COUNT FOLDER ULPS reads draws.bin and densities.bin, and fails where they differ
//   compare_shader check_walk FILE.acdf COUNT FOLDER ULPS the same of functions that walk (compare_walk.cpp)
//
// words.bin: two u32 a draw. directions.bin, normals.bin: x y z 0, floats. draws.bin: x y z pdf. densities.bin: the
// density of the direction, and that of the draw. Random numbers are fixed. ULPS: by how many steps of 2^-24
// coordinates may differ.
#include "tests/shaders/answers.h"
#include "tests/shaders/compare_walk.h"

#include <acdf/reader.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace acdf_test;

// Normals, which of a BRDF are views: above the surface.
void write_inputs(const acdf::File& file, std::size_t count, const std::string& folder) {
    std::mt19937 random(7);
    std::vector<std::uint32_t> words;
    std::vector<float> directions, normals;
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
    }
    write_all(folder + "/words.bin", words);
    write_all(folder + "/directions.bin", directions);
    write_all(folder + "/normals.bin", normals);
}

struct Differences {
    std::size_t told_draws = 0, other_cells = 0, same_draws = 0, told_densities = 0, other_densities = 0, own = 0;
    double farthest = 0.0;
};

Differences compare(const AcdfEnvironment& environment, std::size_t count, const std::string& folder) {
    const auto words = read_all<std::uint32_t>(folder + "/words.bin", 2 * count);
    const auto directions = read_all<float>(folder + "/directions.bin", 4 * count);
    const auto draws = read_all<float>(folder + "/draws.bin", 4 * count);
    const auto densities = read_all<float>(folder + "/densities.bin", 2 * count);
    Differences found;
    for (std::size_t i = 0; i < count; ++i) {
        const float* draw = &draws[4 * i];
        AcdfDirectionSample told;
        float pdf;
        if (acdf_cells_sample(environment.cells, words[2 * i] * 0x1p-32, words[2 * i + 1] * 0x1p-32, &told)) {
            ++found.told_draws;
            found.other_cells += acdf_float_bits(told.pdf) != acdf_float_bits(draw[3]);
            double far = 0.0;
            for (int k = 0; k < 3; ++k) far = std::max(far, std::fabs(double{told.direction[k]} - draw[k]));
            found.same_draws += std::memcmp(told.direction, draw, sizeof told.direction) == 0;
            found.farthest = std::max(found.farthest, std::isfinite(far) ? far : 1e9);
        }
        found.own += acdf_float_bits(densities[2 * i + 1]) != acdf_float_bits(draw[3]);
        if (acdf_cells_pdf(environment.cells, &directions[4 * i], &pdf)) {
            ++found.told_densities;
            found.other_densities += acdf_float_bits(pdf) != acdf_float_bits(densities[2 * i]);
        }
    }
    return found;
}

int check(const AcdfEnvironment& environment, std::size_t count, const std::string& folder, double ulps) {
    const Differences found = compare(environment, count, folder);
    const double farthest = found.farthest * 0x1p24;
    std::printf(
        "%zu draws, %zu told by the reader's tables: %zu of another cell, %zu the same to the bit, the others "
        "at most %.1f steps of 2^-24 off\n%zu directions, %zu told: %zu of another density\n%zu draws of "
        "another density than that of their direction\n",
        count, found.told_draws, found.other_cells, found.same_draws, farthest, count, found.told_densities,
        found.other_densities, found.own);
    const bool usual = 100 * (count - found.told_draws) < count && 100 * (count - found.told_densities) < count;
    if (!usual) std::fprintf(stderr, "the file is of no use here: its tables tell too little\n");
    return usual && found.other_cells == 0 && found.other_densities == 0 && found.own == 0 && farthest <= ulps ? 0
                                                                                                               : 1;
}

} // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    const bool walk = what == "check_walk";
    if (!(what == "inputs" && argc == 5) && !((what == "check" || walk) && argc == 6)) {
        std::fprintf(stderr, "usage: compare_shader inputs|check|check_walk FILE.acdf COUNT FOLDER [ULPS]\n");
        return 2;
    }
    acdf::File file;
    const acdf::Status status = acdf::File::open(argv[2], file);
    if (!status.ok()) {
        std::fprintf(stderr, "%s: %s\n", argv[2], status.message);
        return 1;
    }
    const auto count = static_cast<std::size_t>(std::strtoul(argv[3], nullptr, 10));
    if (walk) return check_walk(file, count, argv[4], std::strtod(argv[5], nullptr));
    if (what == "inputs") {
        write_inputs(file, count, argv[4]);
        return 0;
    }
    if (file.kind() != ACDF_KIND_ENVIRONMENT || !file.environment().data().cells) {
        std::fprintf(stderr, "%s: no runtime tables\n", argv[2]);
        return 1;
    }
    return check(file.environment().data(), count, argv[4], std::strtod(argv[5], nullptr));
}
