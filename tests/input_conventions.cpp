// The table of docs/conventions.md, read from the page itself and checked against each program's own formula
// for where a direction lies in its lat-long image.
#include "input/projection.h"
#include "input_reference.h"

#include <OpenEXR/ImfEnvmap.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <random>
#include <sstream>

namespace {

using namespace acdf::test;

struct Uv {
    double u = 0.0, v = 0.0; // v from the top
};

double turn_fraction(double angle) { // into [0, 1)
    const double t = angle / (2.0 * pi);
    return t - std::floor(t);
}

// OpenEXR, ImfEnvmap.h: longitude +pi at the left, -pi at the right, 0 along +Z, pi/2 along +X; latitude pi/2 at
// the top, along +Y.
Uv openexr(Vec d) { return {0.5 - std::atan2(d.x, d.z) / (2.0 * pi), 0.5 - std::asin(d.y) / pi}; }

// pbrt (imgtool makeequiarea; the infinite light of pbrt-v3): u = phi / 2 pi, v = theta / pi, z up.
Uv pbrt(Vec d) { return {turn_fraction(std::atan2(d.y, d.x)), std::acos(d.z) / pi}; }

// Mitsuba 3, envmap: u = atan2(x, -z) / 2 pi, v = acos(y) / pi.
Uv mitsuba(Vec d) { return {turn_fraction(std::atan2(d.x, -d.z)), std::acos(d.y) / pi}; }

// Cycles, direction_to_equirectangular: u = (phi - pi) / -2 pi, v = (theta - pi) / -pi counted from the bottom.
Uv cycles(Vec d) { return {(std::atan2(d.y, d.x) - pi) / (-2.0 * pi), 1.0 - (std::acos(d.z) - pi) / -pi}; }

// "(−x, y, z)" applied to d. The minus sign is U+2212, three bytes of which none is an ASCII letter.
Vec permuted(const std::string& triple, Vec d) {
    std::array<double, 3> out{};
    std::size_t n = 0;
    double sign = 1.0;
    for (const char c : triple) {
        if (c == '-' || c == '\xe2') sign = -1.0;
        if (c < 'x' || c > 'z') continue;
        const double component = c == 'x' ? d.x : c == 'y' ? d.y : d.z;
        if (n < 3) out[n] = sign * component;
        ++n;
        sign = 1.0;
    }
    EXPECT_EQ(n, 3u) << triple;
    return {out[0], out[1], out[2]};
}

// The table that begins with "| Program |": program and "(..., ..., ...)" of its second column.
std::map<std::string, std::string> documented_rows() {
    std::ifstream page(std::string(ACDF_TEST_DIR) + "/../docs/conventions.md");
    EXPECT_TRUE(page) << "docs/conventions.md is missing";
    std::map<std::string, std::string> rows;
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        inside = line.rfind("| Program |", 0) == 0 || (inside && !line.empty());
        if (!inside) continue;
        std::istringstream cells(line);
        std::string before, program, triple;
        std::getline(cells, before, '|');
        std::getline(cells, program, '|');
        std::getline(cells, triple, '|');
        const std::size_t open = triple.find('('), close = triple.find(')');
        if (open == std::string::npos || close == std::string::npos) continue;
        const std::string name = program.substr(1, program.find_last_not_of(' '));
        rows[name] = triple.substr(open, close - open + 1);
    }
    return rows;
}

std::vector<Vec> directions() {
    std::vector<Vec> all{normalized({0.3, 0.7, 0.5}), normalized({-0.6, 0.2, 0.1}), normalized({0.1, -0.9, -0.4}),
                         normalized({-0.2, -0.3, 0.8})};
    std::mt19937 random(21);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 200; ++i) all.push_back(normalized({normal(random), normal(random), normal(random)}));
    return all;
}

TEST(InputConventions, DocumentedAxesMapToTheSamePixelInEveryProgram) {
    const std::map<std::string, Uv (*)(Vec)> programs{{"OpenEXR", openexr},
                                                      {"USD `UsdLuxDomeLight`", openexr},
                                                      {"pbrt", pbrt},
                                                      {"Mitsuba 3", mitsuba},
                                                      {"Blender (Cycles)", cycles}};
    const std::map<std::string, std::string> rows = documented_rows();
    for (const auto& [program, formula] : programs) {
        ASSERT_EQ(rows.count(program), 1u) << program << " is not in the table";
        for (const Vec& d : directions()) {
            const acdf::input::ImagePoint ours =
                acdf::input::to_image({acdf::input::Layout::latlong, 2, 1}, {d.x, d.y, d.z});
            const Uv theirs = formula(permuted(rows.at(program), d));
            ASSERT_NEAR(theirs.u, ours.u, 1e-9) << program;
            ASSERT_NEAR(theirs.v, ours.v, 1e-7) << program;
        }
    }
}

// The formula above against OpenEXR itself, which counts from texel centres on the border.
TEST(InputConventions, OpenExrsLibraryAgrees) {
    const Imath::Box2i window(Imath::V2i(0, 0), Imath::V2i(1, 1)); // pixel positions are u and v
    for (const Vec& d : directions()) {
        const Imath::V2f pixel = Imf::LatLongMap::pixelPosition(
            window, Imath::V3f(static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)));
        const Uv uv = openexr(d);
        ASSERT_NEAR(pixel.x, uv.u, 1e-5);
        ASSERT_NEAR(pixel.y, uv.v, 1e-5);
    }
}

// pbrt's frame is left-handed, the others are rotations of ours: nothing is mirrored in any of them.
TEST(InputConventions, OnlyPbrtsFrameIsLeftHanded) {
    for (const auto& [program, triple] : documented_rows()) {
        const Vec x = permuted(triple, {1, 0, 0}), y = permuted(triple, {0, 1, 0}), z = permuted(triple, {0, 0, 1});
        EXPECT_EQ(dot(cross(x, y), z), program == "pbrt" ? -1.0 : 1.0) << program;
    }
}

} // namespace
