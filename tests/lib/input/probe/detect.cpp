// What --projection auto decides, and what is refused.
#include "tests/lib/input/write.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace {

using namespace acdf::input;
using namespace acdf::test;

Pixels uniform_noise(int width, int height) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> uniform(0.5f, 1.5f);
    Pixels pixels{width, height, std::vector<float>(static_cast<std::size_t>(3 * width * height))};
    for (float& v : pixels.rgb) v = uniform(random);
    return pixels;
}

/// Grey, by what `value` says of the middle of each texel, in [0, 1] x [0, 1].
Pixels picture(int width, int height, const std::function<double(double u, double v)>& value) {
    Pixels pixels{width, height, std::vector<float>(static_cast<std::size_t>(3 * width * height))};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            std::fill_n(pixels.at(x, y), 3, static_cast<float>(value((x + 0.5) / width, (y + 0.5) / height)));
    return pixels;
}

// Letters in a corner, as the Light Probe Image Gallery signs its probes.
void sign(Pixels& pixels) {
    for (int y = pixels.height - 4; y < pixels.height - 2; ++y)
        for (int x = pixels.width - 12; x < pixels.width - 2; x += 2) std::fill_n(pixels.at(x, y), 3, 1.0f);
}

Probe read(const Folder& folder, const Pixels& pixels, Projection projection = Projection::automatic) {
    write_rgb(folder / "a.exr", pixels);
    ProbeOptions options;
    options.projection = projection;
    return read_probe(folder / "a.exr", options);
}

std::string refused(const Folder& folder, const Pixels& pixels, Projection projection = Projection::automatic) {
    write_rgb(folder / "a.exr", pixels);
    return refusal(folder / "a.exr", projection);
}

TEST(InputDetect, CrossesByShapeAndBlackCorners) {
    const Folder folder;
    Pixels vertical = render_sky(vertical_cross_reference(), 96, 128);
    sign(vertical);
    Probe probe = read(folder, vertical);
    EXPECT_EQ(probe.projection, Projection::cube_cross);
    EXPECT_CONTAINS(probe.projection_reason, "3:4 shape");
    EXPECT_EQ(probe.width, 128);

    Pixels horizontal = render_sky(horizontal_cross_reference(), 128, 96);
    probe = read(folder, horizontal);
    EXPECT_EQ(probe.projection, Projection::cube_cross);
    EXPECT_CONTAINS(probe.projection_reason, "4:3 shape");
}

/// The vertical cross with its back face as it is seen by who turns round.
Reference upright_cross_reference() {
    std::vector<CubeFace> faces = cross_faces();
    faces.push_back({1, 3, {1, 1, 1}, {-1, 1, 1}, {1, -1, 1}});
    return cube_reference(3, 4, faces);
}

TEST(InputDetect, BackFacesOfVerticalCrossesHangOrStandUpright) {
    const Folder folder;
    for (const int n : {8, 31, 64}) {
        const Probe hanging = read(folder, render_sky(vertical_cross_reference(), 3 * n, 4 * n));
        EXPECT_EQ(hanging.projection_reason.find("upright"), std::string::npos) << n;
        const Pixels cross = render_sky(upright_cross_reference(), 3 * n, 4 * n);
        for (const Projection projection : {Projection::automatic, Projection::cube_cross}) {
            const Probe upright = read(folder, cross, projection);
            EXPECT_CONTAINS(upright.projection_reason, "upright");
            ASSERT_EQ(upright.rgb.size(), hanging.rgb.size());
            for (std::size_t i = 0; i < hanging.rgb.size(); ++i)
                ASSERT_NEAR(upright.rgb[i], hanging.rgb[i], 1e-5f * hanging.rgb[i]) << n << " " << i;
        }
    }
    // Without a hint it hangs.
    const std::string reason = read(folder, uniform_noise(96, 128), Projection::cube_cross).projection_reason;
    EXPECT_EQ(reason, "--projection cube-cross");
}

TEST(InputDetect, PhotographsOfCrossShapeAreRefused) {
    const Folder folder;
    for (const auto& [width, height] : {std::pair{96, 128}, std::pair{128, 96}}) {
        const std::string text = refused(folder, uniform_noise(width, height));
        EXPECT_CONTAINS(text, std::to_string(width) + "x" + std::to_string(height));
        EXPECT_CONTAINS(text, "--projection cube-cross");
    }
    // But the user may insist.
    EXPECT_EQ(read(folder, uniform_noise(96, 128), Projection::cube_cross).projection, Projection::cube_cross);
    // All black proves nothing.
    refused(folder, Pixels{96, 128, std::vector<float>(3 * 96 * 128, 0.0f)});
}

TEST(InputDetect, OctahedralByItsFoldedBorders) {
    const Folder folder;
    const Probe probe = read(folder, render_sky(octahedral_reference, 128, 128));
    EXPECT_EQ(probe.projection, Projection::octahedral);
    EXPECT_CONTAINS(probe.projection_reason, "folded");
}

TEST(InputDetect, DiscsAreRefusedNamingBoth) {
    const Folder folder;
    for (const auto& reference : {angular_reference, mirrorball_reference}) {
        Pixels disc = render_sky(reference, 128, 128);
        sign(disc);
        const std::string text = refused(folder, disc);
        EXPECT_CONTAINS(text, "--projection angular");
        EXPECT_CONTAINS(text, "--projection mirrorball");
        EXPECT_CONTAINS(text, "128x128");
    }
}

TEST(InputDetect, OtherSquaresAreRefused) {
    const Folder folder;
    EXPECT_CONTAINS(refused(folder, uniform_noise(64, 64)), "octahedral");
    // A square cut out of a lat-long image: smooth, but its borders do not fold.
    const Pixels sky = latlong_sky(256);
    Pixels crop{128, 128, {}};
    for (int y = 0; y < 128; ++y) crop.rgb.insert(crop.rgb.end(), sky.at(40, y), sky.at(40, y) + 3 * 128);
    EXPECT_CONTAINS(refused(folder, crop), "square");
    // A constant image is continuous in any projection.
    EXPECT_CONTAINS(refused(folder, Pixels{32, 32, std::vector<float>(3 * 32 * 32, 1.0f)}), "square");
    // An octahedral map over black ground has black corners too, but so has its rim.
    Pixels dome = render_sky(octahedral_reference, 128, 128);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x)
            if (std::abs(2 * x - 127) + std::abs(2 * y - 127) > 128) std::fill_n(dome.at(x, y), 3, 0.0f);
    EXPECT_CONTAINS(refused(folder, dome), "neither a disc");
}

// They match at their borders, but as pictures do that are symmetric, not as the two sides of a fold.
TEST(InputDetect, SymmetryIsNoProofOfOctahedralMaps) {
    const Folder folder;
    const auto falloff = [](double x, double y) { return 1.0 / (0.05 + x * x + y * y); };
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<double> texture(64 * 64);
    for (double& value : texture) value = uniform(random);
    const auto mirrored = [&](double u, double v) { // in both axes
        const auto at = [](double t) { return static_cast<std::size_t>(std::min(t, 1.0 - t) * 128.0); };
        return texture[64 * at(v) + at(u)];
    };
    const std::pair<const char*, std::function<double(double, double)>> pictures[] = {
        {"radial", [&](double u, double v) { return falloff(u - 0.5, v - 0.5); }},
        {"radial, not quite in the middle", [&](double u, double v) { return falloff(u - 0.51, v - 0.5); }},
        {"elliptic", [&](double u, double v) { return falloff(u - 0.5, 3.0 * (v - 0.5)); }},
        {"radial and grainy",
         [&](double u, double v) { return falloff(u - 0.5, v - 0.5) * (1.0 + 0.2 * uniform(random)); }},
        {"radial with a spot",
         [&](double u, double v) {
             return falloff(u - 0.5, v - 0.5) +
                    50.0 * std::exp(-200.0 * (std::pow(u - 0.3, 2) + std::pow(v - 0.6, 2)));
         }},
        {"a texture, mirrored", mirrored},
        {"smooth waves, mirrored",
         [&](double u, double v) { return std::exp(std::cos(10.0 * (u - 0.5)) + std::cos(7.0 * (v - 0.5))); }},
        {"a sky that is the same all round", [](double u, double v) {
             Vec d;
             octahedral_reference(u, v, d);
             return 1.5 + d.z + 0.3 * std::sin(9.0 * d.z);
         }}};
    for (const auto& [name, value] : pictures)
        for (const int n : {64, 128}) {
            SCOPED_TRACE(name);
            EXPECT_CONTAINS(refused(folder, picture(n, n, value)), "proves nothing");
        }
}

TEST(InputDetect, SquaresOfRenderersThatKnowNoOtherAreOctahedral) {
    const Folder folder;
    ProbeOptions options;
    options.squares_are_octahedral = true;
    write_rgb(folder / "a.exr", uniform_noise(64, 64));
    EXPECT_EQ(read_probe(folder / "a.exr", options).projection, Projection::octahedral);
    write_rgb(folder / "a.exr", latlong_sky(64));
    EXPECT_EQ(read_probe(folder / "a.exr", options).projection, Projection::latlong);
    write_rgb(folder / "a.exr", render_sky(angular_reference, 64, 64));
    EXPECT_THROW(read_probe(folder / "a.exr", options), Error);
}

/// Two lenses that see half a sphere each, in discs of `size`, and `around` beside them.
Reference fisheyes_reference(double size) {
    return [size](double u, double v, Vec& d) {
        const bool right = u >= 0.5;
        const double a = (4.0 * u - (right ? 3.0 : 1.0)) / size, b = (1.0 - 2.0 * v) / size, r = std::hypot(a, b);
        if (r >= 1.0) return false;
        const double angle = 0.5 * pi * r, s = r > 0.0 ? std::sin(angle) / r : 0.5 * pi, front = right ? -1.0 : 1.0;
        d = {front * std::cos(angle), -front * s * a, s * b};
        return true;
    };
}

TEST(InputDetect, TwoFisheyesAreNoLatLongMap) {
    const Folder folder;
    for (const double size : {1.0, 0.93, 0.85})
        for (const float around : {0.0f, 0.5f})
            for (const int width : {64, 600}) { // more rows than are looked at
                if (width == 600 && size != 0.93) continue;
                SCOPED_TRACE(size);
                Pixels pixels = render_sky(fisheyes_reference(size), width, width / 2);
                for (float& value : pixels.rgb)
                    if (value == 0.0f) value = around;
                for (const auto policy : {acdf::build::BadPixels::zero, acdf::build::BadPixels::clamp}) {
                    write_rgb(folder / "a.exr", pixels);
                    ProbeOptions options;
                    options.bad_pixels = policy; // whether rows are taken in bands
                    try {
                        read_probe(folder / "a.exr", options);
                        ADD_FAILURE() << "read";
                    } catch (const Error& error) {
                        const std::string text = error.what();
                        EXPECT_CONTAINS(text, "two discs");
                        EXPECT_CONTAINS(text, "--projection latlong");
                    }
                }
                EXPECT_EQ(read(folder, pixels, Projection::latlong).width, width);
            }
}

/// Grain over a slow wave that has so many periods from side to side.
Pixels grainy(double periods) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    return picture(256, 128, [&](double u, double v) {
        return std::exp(1.5 * std::sin(2.0 * pi * periods * u + 1.0 + 0.5 * v) + 0.3 * normal(random));
    });
}

TEST(InputDetect, PicturesWhoseSidesDoNotMeetAreNoLatLongMaps) {
    const Folder folder;
    EXPECT_CONTAINS(refused(folder, grainy(2.3)), "do not meet");
    EXPECT_EQ(read(folder, grainy(2.3), Projection::latlong).width, 256);
    EXPECT_EQ(read(folder, grainy(2.0)).projection_reason, "2:1 shape");
}

// Nothing speaks against what people make for tests, and what has sharp edges.
TEST(InputDetect, PlainLatLongMapsAreRead) {
    const Folder folder;
    const std::function<double(double, double)> maps[] = {
        [](double, double) { return 1.0; },
        [](double u, double) { return u; },
        [](double, double v) { return v; },
        [](double u, double v) { return u + v; },
        [](double u, double) { return u < 0.5 ? 1.0 : 0.0; },
        [](double u, double) { return u < 0.1 ? 1.0 : 0.01; },
        [](double u, double) { return u > 0.98 ? 1e6 : u; },
        [](double, double v) { return v < 0.02 ? 1.0 : 0.0; },
        [](double u, double v) { return u > 0.98 && v > 0.98 ? 1.0 : 0.0; },
        [](double u, double v) { return std::abs(u - 0.5) < 0.36 && std::abs(v - 0.5) < 0.33 ? 1.0 : 0.0; },
        [](double u, double v) { return std::hypot(2.0 * (u - 0.3), v - 0.4) < 0.2 ? 1.0 : 0.0; },
        [](double u, double v) {
            return static_cast<int>(8.0 * u) % 2 == static_cast<int>(4.0 * v) % 2 ? 1.0 : 0.1;
        }};
    for (std::size_t i = 0; i < std::size(maps); ++i)
        for (const int width : {32, 64, 512})
            EXPECT_EQ(read(folder, picture(width, width / 2, maps[i])).projection, Projection::latlong) << i;
    EXPECT_EQ(read(folder, uniform_noise(64, 32)).projection, Projection::latlong);
}

TEST(InputDetect, ShapesThatAreNearlyKnownAreAdvisedOn) {
    const Folder folder;
    const std::string nearly = refused(folder, uniform_noise(192, 94));
    EXPECT_CONTAINS(nearly, "nearly 2:1");
    EXPECT_CONTAINS(nearly, "--projection latlong");
    EXPECT_CONTAINS(refused(folder, uniform_noise(97, 128)), "nearly that of a cube");
    EXPECT_CONTAINS(refused(folder, uniform_noise(65, 64)), "nearly 1:1");
    EXPECT_CONTAINS(refused(folder, uniform_noise(96, 16)), "--faces");
    for (const auto& [width, height] : {std::pair{192, 94}, {97, 128}, {65, 64}, {96, 16}, {100, 70}})
        EXPECT_EQ(refused(folder, uniform_noise(width, height)).find("crop"), std::string::npos);
}

TEST(InputDetect, UnknownShapesAreRefused) {
    const Folder folder;
    const std::string text = refused(folder, uniform_noise(100, 70));
    EXPECT_CONTAINS(text, "100x70");
    EXPECT_CONTAINS(text, "2:1");
    EXPECT_CONTAINS(refused(folder, uniform_noise(16, 96)), "--projection cube-cross");
    EXPECT_EQ(read(folder, uniform_noise(100, 70), Projection::latlong).width, 100);
    EXPECT_EQ(read(folder, uniform_noise(16, 96), Projection::cube_cross).width, 64);
}

TEST(InputDetect, ShapesThatCannotBeWhatTheUserSaysAreRefused) {
    const Folder folder;
    for (const Projection projection : {Projection::angular, Projection::mirrorball, Projection::octahedral}) {
        const std::string text = refused(folder, uniform_noise(64, 32), projection);
        EXPECT_CONTAINS(text, "not square");
        EXPECT_CONTAINS(text, to_string(projection));
    }
    EXPECT_CONTAINS(refused(folder, uniform_noise(64, 64), Projection::cube_cross), "neither a cube cross");
    EXPECT_CONTAINS(refused(folder, uniform_noise(64, 32), Projection::cube_cross), "3:4");
}

TEST(InputDetect, AttributesWinOverShape) {
    const Folder folder;
    const Pixels noise = uniform_noise(60, 32);
    OIIO::ImageSpec spec = rgb_spec(noise);
    spec.attribute("textureformat", "LatLong Environment");
    write_image(folder / "latlong.exr", spec, noise.rgb);
    EXPECT_EQ(read_probe(folder / "latlong.exr").projection, Projection::latlong);
    spec.attribute("textureformat", "CubeFace Environment");
    write_image(folder / "cube.exr", spec, noise.rgb);
    EXPECT_CONTAINS(refusal(folder / "cube.exr"), "1:6");
}

TEST(InputDetect, ReasonNamesTheOption) {
    const Folder folder;
    EXPECT_EQ(read(folder, latlong_sky(16), Projection::latlong).projection_reason, "--projection latlong");
    EXPECT_STREQ(to_string(Projection::automatic), "auto");
    EXPECT_STREQ(to_string(Projection::cube_cross), "cube-cross");
}

} // namespace
