// What --projection auto decides, and what is refused.
#include "tests/lib/input/write.h"

#include <gtest/gtest.h>

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
    EXPECT_CONTAINS(refused(folder, uniform_noise(64, 64), Projection::cube_cross), "no cube cross");
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
