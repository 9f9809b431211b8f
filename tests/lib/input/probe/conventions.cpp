// The table of docs/conventions.md, read from the page itself and checked against each program's own formula
// for where a direction lies in its lat-long image; and OpenImageIO's reading of angular maps.
#include "build/probe/projection.h"
#include "tests/lib/input/write.h"

#include <acdf/renderers.h>

#include <OpenEXR/ImfEnvmap.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <random>
#include <set>
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

// LuxCore, EnvLightSource::ToLatLongMapping: u = phi / 2 pi, v = theta / pi, z up: the formula of pbrt.
Uv luxcore(Vec d) { return pbrt(d); }

// three.js, equirectUv, and three-gpu-pathtracer: u = atan2(z, x) / 2 pi + 1/2, v = asin(y) / pi + 1/2 from the
// bottom.
Uv three(Vec d) { return {std::atan2(d.z, d.x) / (2.0 * pi) + 0.5, 1.0 - (std::asin(d.y) / pi + 0.5)}; }

// USD's Hydra Storm, ProjectToLatLong: u = (atan2(z, x) + pi/2) / 2 pi, which repeats, v = acos(y) / pi from the
// top.
Uv storm(Vec d) { return {turn_fraction(std::atan2(d.z, d.x) + 0.5 * pi), std::acos(d.y) / pi}; }

// RenderMan, PxrDomeLight: its axes x, y and z are USD's -z, -x and y, by which hdPrman turns it to OpenEXR's
// frame.
Uv renderman(Vec d) { return openexr({-d.y, d.z, -d.x}); }

// Unreal, a long-lat texture made into a cube: u = (1 + atan2(x, -z) / pi) / 2, v = acos(y) / pi, in a frame whose
// y and z are those of the world exchanged.
Uv unreal(Vec d) { return {0.5 * (1.0 + std::atan2(d.x, -d.y) / pi), std::acos(d.z) / pi}; }

// Cycles, direction_to_mirrorball: the point of the ball whose normal lies between the direction and -y, towards
// which the camera is; seen with x to the right and z up.
Uv cycles_ball(Vec d) {
    const Vec half = normalized({d.x, d.y - 1.0, d.z});
    return {0.5 * (half.x + 1.0), 1.0 - 0.5 * (half.z + 1.0)};
}

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
    rows.erase("Program"); // the heading
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

/// A program of the table, and its names for --for.
struct Program {
    const char* title;
    Uv (*formula)(Vec);
    std::vector<const char*> presets;
};
const Program programs[] = {{"OpenEXR", openexr, {}},
                            {"USD `UsdLuxDomeLight`", openexr, {}},
                            {"USD Hydra Storm", storm, {"storm"}},
                            {"Mitsuba 3", mitsuba, {"mitsuba3"}},
                            {"pbrt", pbrt, {"pbrt-v3", "pbrt-v4"}},
                            {"Blender (Cycles)", cycles, {"cycles"}},
                            {"LuxCore", luxcore, {"luxcore"}},
                            {"three.js", three, {"three"}},
                            {"Arnold", openexr, {"arnold"}},
                            {"RenderMan", renderman, {"renderman"}},
                            {"Karma", openexr, {"karma"}},
                            {"Unreal Engine", unreal, {"unreal"}}};

/// That a direction is where `theirs` shows what is `there` in the program's frame.
void expect_same_point(acdf::build::Layout layout, const Vec& d, const Vec& there, Uv (*theirs)(Vec),
                       const std::string& program) {
    const acdf::build::ImagePoint ours = acdf::build::to_image({layout, 2, 1}, {d.x, d.y, d.z});
    const Uv uv = theirs(there);
    ASSERT_NEAR(uv.u, ours.u, 1e-9) << program;
    ASSERT_NEAR(uv.v, ours.v, 1e-7) << program;
}

Vec turned(const acdf::builder::Axes& axes, const Vec& d) {
    const auto component = [&](int axis) {
        const double of[3] = {d.x, d.y, d.z};
        return axis < 0 ? -of[-axis - 1] : of[axis - 1];
    };
    return {component(axes.x), component(axes.y), component(axes.z)};
}

TEST(InputConventions, DocumentedAxesMapToTheSamePixelInEveryProgram) {
    const std::map<std::string, std::string> rows = documented_rows();
    EXPECT_EQ(rows.size(), std::size(programs)) << "each program of the table is in this list";
    for (const Program& program : programs) {
        ASSERT_EQ(rows.count(program.title), 1u) << program.title << " is not in the table";
        for (const Vec& d : directions())
            expect_same_point(acdf::build::Layout::latlong, d, permuted(rows.at(program.title), d), program.formula,
                              program.title);
    }
}

TEST(InputConventions, PresetsHaveTheAxesOfTheirPrograms) {
    for (const acdf::builder::Renderer& renderer : acdf::builder::renderers()) {
        const Program* of = nullptr;
        for (const Program& program : programs)
            for (const char* preset : program.presets)
                if (preset == std::string(renderer.name)) of = &program;
        ASSERT_NE(of, nullptr) << renderer.name;
        EXPECT_EQ(acdf::builder::find_renderer(renderer.name), &renderer);
        const acdf::builder::Axes back = renderer.axes.inverse();
        for (const Vec& d : directions()) {
            const Vec there = turned(renderer.axes, d);
            expect_same_point(acdf::build::Layout::latlong, d, there, of->formula, renderer.name);
            EXPECT_EQ(length(turned(back, there) - d), 0.0) << renderer.name;
            const float ours[3] = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
            float turned_there[3];
            renderer.axes.turn(ours, turned_there);
            EXPECT_EQ(turned_there[0], static_cast<float>(there.x));
            EXPECT_EQ(turned_there[1], static_cast<float>(there.y));
            EXPECT_EQ(turned_there[2], static_cast<float>(there.z));
        }
    }
    EXPECT_EQ(acdf::builder::find_renderer("v-ray"), nullptr);
    EXPECT_EQ(acdf::builder::find_renderer(nullptr), nullptr);
}

TEST(InputConventions, CyclesTurnsMirrorBallsAnotherWay) {
    const acdf::builder::Renderer* renderer = acdf::builder::find_renderer("cycles");
    ASSERT_NE(renderer, nullptr);
    const acdf::builder::Axes* ball = renderer->axes_of(acdf::builder::Projection::mirrorball);
    ASSERT_NE(ball, nullptr);
    EXPECT_EQ(ball->text(), "(y, -x, z)");
    EXPECT_EQ(ball->inverse().text("XYZ"), "(-Y, X, Z)");
    for (const Vec& d : directions())
        expect_same_point(acdf::build::Layout::mirrorball, d, turned(*ball, d), cycles_ball, "cycles");
    EXPECT_EQ(renderer->axes_of(acdf::builder::Projection::angular), nullptr);
    EXPECT_EQ(acdf::builder::find_renderer("three")->axes_of(acdf::builder::Projection::mirrorball), nullptr);
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

// The lat-long image that maketx --lightprobe makes of an angular map, at the resolution of ours.
std::vector<float> maketx_lightprobe(const Folder& folder, const Pixels& ball) {
    const OIIO::ImageBuf buffer(rgb_spec(ball), const_cast<float*>(ball.rgb.data()));
    const std::string path = folder / "maketx.tx";
    EXPECT_TRUE(OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxEnvLatlFromLightProbe, buffer, path,
                                                 OIIO::ImageSpec()))
        << OIIO::geterror();
    const OIIO::ImageBuf latlong(path);
    EXPECT_EQ(latlong.spec().width, ball.width);
    EXPECT_EQ(latlong.spec().height, ball.width / 2);
    std::vector<float> rgb(3 * static_cast<std::size_t>(ball.width * ball.width / 2));
    EXPECT_TRUE(latlong.get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, rgb.data())) << latlong.geterror();
    return rgb;
}

// Three patches, one in each channel: right of the middle, low on the left and behind, high up a little left.
TEST(InputConventions, AngularMapsAreMaketxsLightProbes) {
    const int n = 128, width = 6, patches[3][2] = {{88, 58}, {18, 88}, {46, 28}}; // corner: x, y
    Pixels ball{n, n, std::vector<float>(3 * n * n, 0.0f)};
    for (std::size_t c = 0; c < 3; ++c)
        for (int y = 0; y < width; ++y)
            for (int x = 0; x < width; ++x) ball.at(patches[c][0] + x, patches[c][1] + y)[c] = 1.0f;
    const Folder folder;
    const std::vector<float> theirs = maketx_lightprobe(folder, ball);
    write_rgb(folder / "ball.exr", ball);
    acdf::input::ProbeOptions options;
    options.projection = acdf::input::Projection::angular;
    const acdf::input::Probe ours = acdf::input::read_probe(folder / "ball.exr", options);
    ASSERT_EQ(ours.width, n);
    for (int c = 0; c < 3; ++c) {
        const Vec a = mean_direction(n, ours.rgb, c), b = mean_direction(n, theirs, c);
        EXPECT_LT(length(a - b), 0.5 * 2.0 * pi / n) << "channel " << c; // half a texel
        EXPECT_GT(length(a - Vec{b.x, -b.y, b.z}), 0.3) << "channel " << c << " does not tell left from right";
        EXPECT_NEAR(latlong_integral(n, n / 2, ours.rgb, c) / latlong_integral(n, n / 2, theirs, c), 1.0, 0.05)
            << "channel " << c;
    }
}

// The frames of pbrt and Unreal are left-handed, and LuxCore takes pbrt's formula in a right-handed one, so that it
// shows the map mirrored; the others are rotations of ours.
TEST(InputConventions, OnlyLeftHandedFramesAndLuxCoreMirror) {
    const std::set<std::string> mirrored{"pbrt", "LuxCore", "Unreal Engine"};
    for (const auto& [program, triple] : documented_rows()) {
        const Vec x = permuted(triple, {1, 0, 0}), y = permuted(triple, {0, 1, 0}), z = permuted(triple, {0, 0, 1});
        EXPECT_EQ(dot(cross(x, y), z), mirrored.count(program) > 0 ? -1.0 : 1.0) << program;
    }
}

} // namespace
