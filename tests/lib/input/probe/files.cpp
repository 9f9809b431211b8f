// What files may look like: formats, channels, data windows, tiles, mip levels, integers, and bad texels.
#include "tests/lib/input/write.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace acdf::build;
using namespace acdf::input;
using namespace acdf::test;

// `relative` to the largest channel of a texel.
void expect_same(const Probe& probe, const Pixels& pixels, double relative, const std::string& what) {
    ASSERT_EQ(probe.width, pixels.width) << what;
    ASSERT_EQ(probe.height, pixels.height) << what;
    ASSERT_EQ(probe.rgb.size(), pixels.rgb.size()) << what;
    for (std::size_t i = 0; i < pixels.rgb.size(); ++i) {
        const float* texel = pixels.rgb.data() + i / 3 * 3;
        const double largest = std::max({texel[0], texel[1], texel[2]});
        ASSERT_NEAR(probe.rgb[i], pixels.rgb[i], relative * largest) << what << " value " << i;
    }
}

TEST(InputFiles, FormatsHoldTheSameSky) {
    const Folder folder;
    const Pixels sky = latlong_sky();
    const struct {
        const char* name;
        OIIO::TypeDesc type;
        double relative;
    } files[] = {{"float.exr", OIIO::TypeDesc::FLOAT, 0.0},
                 {"half.exr", OIIO::TypeDesc::HALF, 1e-3},
                 {"float.tif", OIIO::TypeDesc::FLOAT, 0.0},
                 {"double.tif", OIIO::TypeDesc::DOUBLE, 0.0},
                 {"shared_exponent.hdr", OIIO::TypeDesc::FLOAT, 0.008}}; // 8 bits in the largest channel
    for (const auto& f : files) {
        write_rgb(folder / (f.name), sky, f.type);
        const Probe probe = read_probe(folder / (f.name));
        expect_same(probe, sky, f.relative, f.name);
        EXPECT_EQ(probe.projection, Projection::latlong);
        EXPECT_EQ(probe.projection_reason, "2:1 shape");
        EXPECT_EQ(probe.source_name, f.name);
        EXPECT_EQ(probe.source_width, 64);
        EXPECT_EQ(probe.source_height, 32);
        EXPECT_EQ(probe.bad.x, -1);
        EXPECT_TRUE(probe.warnings.empty()) << f.name << ": " << probe.warnings[0];
    }
}

TEST(InputFiles, CompressionAndTiles) {
    const Folder folder;
    const Pixels sky = latlong_sky();
    for (const char* compression : {"none", "rle", "zip", "zips", "piz"})
        for (const int tile : {0, 16, 20}) {
            OIIO::ImageSpec spec = rgb_spec(sky);
            spec.attribute("compression", compression);
            if (tile) spec.tile_width = spec.tile_height = tile;
            write_image(folder / "a.exr", spec, sky.rgb);
            expect_same(read_probe(folder / "a.exr"), sky, 0.0, compression);
        }
}

TEST(InputFiles, Channels) {
    const Folder folder;
    const Pixels sky = latlong_sky(16);
    const std::size_t texels = sky.rgb.size() / 3;
    const struct {
        std::vector<std::string> names;
        int rgb[3]; // where the test puts R, G and B
    } layouts[] = {{{"Y"}, {0, 0, 0}},
                   {{"Y", "A"}, {0, 0, 0}},
                   {{"R", "G", "B"}, {0, 1, 2}},
                   {{"R", "G", "B", "A"}, {0, 1, 2}},
                   {{"A", "B", "G", "R"}, {3, 2, 1}},
                   {{"R", "G", "B", "A", "Z"}, {0, 1, 2}},
                   {{"beauty.R", "beauty.G", "beauty.B", "N.x", "N.y", "N.z"}, {0, 1, 2}}};
    for (const auto& layout : layouts)
        for (const char* name : {"c.exr", "c.tif"}) {
            const std::size_t n = layout.names.size();
            if (std::string(name) == "c.tif" && (n > 4 || layout.names[0] == "A")) continue; // TIFF has no names
            OIIO::ImageSpec spec(sky.width, sky.height, static_cast<int>(n), OIIO::TypeDesc::FLOAT);
            spec.channelnames = layout.names;
            std::vector<float> pixels(texels * n, 0.25f); // alpha and the rest
            Pixels expected = sky;
            for (std::size_t i = 0; i < texels; ++i)
                for (std::size_t c = 0; c < 3; ++c) {
                    pixels[i * n + static_cast<std::size_t>(layout.rgb[c])] = sky.rgb[3 * i + c];
                    if (n < 3) expected.rgb[3 * i + c] = sky.rgb[3 * i + 2];
                }
            write_image(folder / name, spec, pixels);
            expect_same(read_probe(folder / name), expected, 0.0,
                        std::string(name) + " " + layout.names[0] + " " + std::to_string(n));
        }
}

TEST(InputFiles, ChannelsThatAreNoColourAreRefused) {
    const Folder folder;
    OIIO::ImageSpec spec(8, 4, 3, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"N.x", "N.y", "N.z"};
    write_image(folder / "normals.exr", spec, std::vector<float>(96, 1.0f));
    const std::string text = refusal(folder / "normals.exr");
    EXPECT_CONTAINS(text, "N.x, N.y, N.z");
    EXPECT_CONTAINS(text, "oiiotool");
    spec.nchannels = 1;
    for (const char* name : {"A", "Z"}) {
        spec.channelnames = {name};
        write_image(folder / "one.exr", spec, std::vector<float>(32, 1.0f));
        EXPECT_CONTAINS(refusal(folder / "one.exr"), std::string("its channels are ") + name);
    }
}

// Nuke and others store only the part that is not black, or more than the image.
TEST(InputFiles, DataWindowIsPlacedInTheDisplayWindow) {
    const Folder folder;
    const Pixels sky = latlong_sky(32);
    const struct {
        const char* name;
        int x, y, width, height;
        std::vector<const char*> warnings;
    } windows[] = {{"crop.exr", 5, 3, 20, 10, {"20x10 of 32x16 pixels; the rest is black"}},
                   {"overscan.exr", -4, -2, 40, 20, {"not used"}},
                   {"shifted.exr", 8, -3, 32, 16, {"not used", "24x13 of 32x16 pixels; the rest is black"}}};
    for (const auto& w : windows) {
        OIIO::ImageSpec spec(w.width, w.height, 3, OIIO::TypeDesc::FLOAT);
        spec.x = w.x;
        spec.y = w.y;
        spec.full_width = 32;
        spec.full_height = 16;
        std::vector<float> pixels(static_cast<std::size_t>(3 * w.width * w.height), 7.0f);
        Pixels expected{32, 16, std::vector<float>(sky.rgb.size(), 0.0f)};
        for (int y = std::max(0, w.y); y < std::min(16, w.y + w.height); ++y)
            for (int x = std::max(0, w.x); x < std::min(32, w.x + w.width); ++x) {
                std::copy_n(sky.at(x, y), 3, pixels.data() + 3 * ((y - w.y) * w.width + x - w.x));
                std::copy_n(sky.at(x, y), 3, expected.at(x, y));
            }
        write_image(folder / (w.name), spec, pixels);
        const Probe probe = read_probe(folder / (w.name));
        expect_same(probe, expected, 0.0, w.name);
        ASSERT_EQ(probe.warnings.size(), w.warnings.size()) << w.name;
        for (std::size_t i = 0; i < w.warnings.size(); ++i) EXPECT_CONTAINS(probe.warnings[i], w.warnings[i]);
    }
}

TEST(InputFiles, TexturesOfMaketx) {
    const Folder folder;
    Pixels sky = latlong_sky(64);
    OIIO::ImageBuf buffer(rgb_spec(sky), sky.rgb.data());
    for (const char* name : {"sky.tx", "sky.exr"}) {
        OIIO::ImageSpec config;
        ASSERT_TRUE(
            OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxEnvLatl, buffer, folder / name, config))
            << OIIO::geterror();
        const auto in = OIIO::ImageInput::open(folder / name);
        ASSERT_TRUE(in && in->spec().tile_width > 0 && in->seek_subimage(0, 1))
            << name << " is not tiled and mipmapped";
        const Probe probe = read_probe(folder / name);
        EXPECT_EQ(probe.width, 64);
        EXPECT_EQ(probe.projection, Projection::latlong);
        EXPECT_CONTAINS(probe.projection_reason, "the file says so");
        EXPECT_EQ(probe.warnings.size(), name == std::string("sky.exr") ? 1u : 0u); // texel centres on the borders
        // maketx evens out the rows at the poles; the others are the full-resolution image.
        for (int y = 2; y < 30; ++y)
            for (int x = 0; x < 64; ++x)
                ASSERT_NEAR(probe.rgb[3 * static_cast<std::size_t>(64 * y + x)], sky.at(x, y)[0],
                            name == std::string("sky.tx") ? 1e-5 : 0.1 * sky.at(x, y)[0]) // half a texel off
                    << name << " " << x << " " << y;
    }
}

TEST(InputFiles, OpenExrCubeMap) {
    const Folder folder;
    const int n = 64;
    // The faces by ImfEnvmap.h's picture: +X -X +Y -Y +Z -Z, texel centres on the cube's edges; its (X, Y, Z) is
    // our (y, z, x). Columns: centre, right, down, in OpenEXR's frame.
    const Vec faces[6][3] = {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},  {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                             {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},  {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                             {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}, {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}};
    Pixels cube{n, 6 * n, std::vector<float>(static_cast<std::size_t>(18 * n * n))};
    for (int y = 0; y < 6 * n; ++y)
        for (int x = 0; x < n; ++x) {
            const auto& [centre, right, down] = faces[y / n];
            const double s = 2.0 * x / (n - 1) - 1.0, t = 2.0 * (y % n) / (n - 1) - 1.0;
            const Vec exr = normalized(centre + s * right + t * down);
            const std::array<double, 3> value = sky({exr.z, exr.x, exr.y});
            for (std::size_t c = 0; c < 3; ++c) cube.at(x, y)[c] = static_cast<float>(value[c]);
        }
    OIIO::ImageSpec spec = rgb_spec(cube);
    spec.attribute("textureformat", "CubeFace Environment");
    write_image(folder / "cube.exr", spec, cube.rgb);
    const Probe probe = read_probe(folder / "cube.exr");
    EXPECT_EQ(probe.projection, Projection::cube_cross);
    EXPECT_CONTAINS(probe.projection_reason, "envmap attribute");
    const Pixels expected = latlong_sky(256);
    ASSERT_EQ(probe.width, 256);
    double squares = 0.0;
    for (std::size_t i = 0; i < expected.rgb.size(); ++i) {
        const double error = (probe.rgb[i] - expected.rgb[i]) / expected.rgb[i];
        squares += error * error;
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(expected.rgb.size())), 0.012);
}

TEST(InputFiles, IntegersAreLinearizedAndWarnedOf) {
    const Folder folder;
    Pixels ramp{32, 16, std::vector<float>(32 * 16 * 3)};
    for (std::size_t i = 0; i < ramp.rgb.size(); ++i) ramp.rgb[i] = static_cast<float>(i / 3 % 32) / 31.0f;
    const auto srgb = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
    for (const auto& [name, type] :
         {std::pair{"a.png", OIIO::TypeDesc::UINT8}, std::pair{"a.tif", OIIO::TypeDesc::UINT16}}) {
        write_rgb(folder / name, ramp, type);
        const Probe probe = read_probe(folder / name);
        for (std::size_t i = 0; i < ramp.rgb.size(); ++i)
            ASSERT_NEAR(probe.rgb[i], srgb(ramp.rgb[i]), 0.005) << name;
        ASSERT_EQ(probe.warnings.size(), 1u) << name;
        EXPECT_CONTAINS(probe.warnings[0], "integer");
        EXPECT_CONTAINS(probe.warnings[0], "sRGB");
    }
    OIIO::ImageSpec spec = rgb_spec(ramp, OIIO::TypeDesc::UINT16);
    spec.attribute("oiio:ColorSpace", "Linear");
    write_image(folder / "linear.png", spec, ramp.rgb);
    const Probe probe = read_probe(folder / "linear.png");
    for (std::size_t i = 0; i < ramp.rgb.size(); ++i) ASSERT_NEAR(probe.rgb[i], ramp.rgb[i], 1e-4);
}

TEST(InputFiles, AlphaIsIgnored) {
    const Folder folder;
    std::vector<float> rgba;
    for (std::size_t i = 0; i < 32 * 16; ++i) rgba.insert(rgba.end(), {0.5f, 0.5f, 0.5f, i < 256 ? 0.0f : 0.5f});
    write_rgb(folder / "plain.png", {32, 16, std::vector<float>(32 * 16 * 3, 0.5f)}, OIIO::TypeDesc::UINT8);
    OIIO::ImageSpec spec(32, 16, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1); // pixels are written without multiplication by it
    for (const char* name : {"a.png", "a.tif"}) {
        write_image(folder / name, spec, rgba);
        EXPECT_EQ(read_probe(folder / name).rgb, read_probe(folder / "plain.png").rgb) << name;
    }
}

TEST(InputFiles, BadTexelsAreCountedAndZeroed) {
    const Folder folder;
    Pixels sky = latlong_sky(32);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    sky.at(20, 3)[1] = -inf; // the first
    sky.at(4, 5)[0] = nan;
    sky.at(4, 5)[1] = -1.0f; // the same texel: counted once, as NaN
    sky.at(5, 5)[2] = inf;
    sky.at(31, 15)[0] = -0.5f;
    sky.at(30, 15)[2] = -1e-30f;
    sky.at(29, 15)[2] = -0.0f; // zero is radiance
    write_rgb(folder / "bad.exr", sky);
    const Probe probe = read_probe(folder / "bad.exr");
    EXPECT_EQ(probe.bad.nan, 1u);
    EXPECT_EQ(probe.bad.infinite, 2u);
    EXPECT_EQ(probe.bad.negative, 2u);
    EXPECT_EQ(probe.bad.x, 20);
    EXPECT_EQ(probe.bad.y, 3);
    for (std::size_t i = 0; i < sky.rgb.size(); ++i) {
        const float expected = sky.rgb[i] >= 0.0f && std::isfinite(sky.rgb[i]) ? sky.rgb[i] : 0.0f;
        ASSERT_EQ(probe.rgb[i], expected) << i; // the other channels of a bad texel are kept
    }
}

TEST(InputFiles, BadPixelsAreClampedOrRefusedWhereAsked) {
    const Folder folder;
    Pixels sky = latlong_sky(32);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    sky.at(7, 2)[0] = 900.0f; // the largest red
    sky.at(20, 3)[0] = inf;
    sky.at(20, 3)[1] = -inf;
    sky.at(4, 5)[1] = nan;
    sky.at(31, 15)[2] = -0.5f;
    write_rgb(folder / "bad.exr", sky);
    ProbeOptions options;
    options.bad_pixels = BadPixels::clamp;
    const Probe probe = read_probe(folder / "bad.exr", options);
    EXPECT_EQ(probe.bad.count(), 3u);
    for (std::size_t i = 0; i < sky.rgb.size(); ++i) {
        const float v = sky.rgb[i], expected = v == inf ? 900.0f : v >= 0.0f ? v : 0.0f;
        ASSERT_EQ(probe.rgb[i], expected) << i;
    }
    options.bad_pixels = BadPixels::error;
    try {
        read_probe(folder / "bad.exr", options);
        FAIL() << "accepted";
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("1 NaN, 1 infinite and 1 negative texels, the first at 20,3"), std::string::npos)
            << text;
    }
    write_rgb(folder / "good.exr", latlong_sky(32));
    EXPECT_EQ(read_probe(folder / "good.exr", options).bad.count(), 0u);
}

TEST(InputFiles, BlackIsUniformWhereAsked) {
    const Folder folder;
    Pixels black = latlong_sky(16);
    std::fill(black.rgb.begin(), black.rgb.end(), 0.0f);
    write_rgb(folder / "black.exr", black);
    for (const float v : read_probe(folder / "black.exr").rgb) ASSERT_EQ(v, 0.0f);
    ProbeOptions options;
    options.uniform_if_black = true;
    const Probe probe = read_probe(folder / "black.exr", options);
    for (const float v : probe.rgb) ASSERT_EQ(v, std::numeric_limits<float>::min());
    EXPECT_EQ(probe.warnings.size(), 1u);
}

TEST(InputFiles, BadTexelsOfTheSourceAreLocatedThereAlsoWhenResampled) {
    const Folder folder;
    Pixels ball = render_sky(angular_reference, 64, 64);
    ball.at(33, 40)[0] = std::numeric_limits<float>::quiet_NaN();
    write_rgb(folder / "ball.exr", ball);
    ProbeOptions options;
    options.projection = Projection::angular;
    const Probe probe = read_probe(folder / "ball.exr", options);
    EXPECT_EQ(probe.bad.nan, 1u);
    EXPECT_EQ(probe.bad.x, 33);
    EXPECT_EQ(probe.bad.y, 40);
    EXPECT_EQ(probe.source_width, 64);
    EXPECT_EQ(probe.width, 64);
    for (const float v : probe.rgb) ASSERT_TRUE(std::isfinite(v) && v >= 0.0f);
}

TEST(InputFiles, DeepIsRefusedAndSoArePartsThatAreAlike) {
    const Folder folder;
    const Pixels sky = latlong_sky(16);
    OIIO::ImageSpec specs[2] = {rgb_spec(sky), rgb_spec(sky)};
    const auto write_parts = [&] {
        const auto out = OIIO::ImageOutput::create("parts.exr");
        ASSERT_TRUE(out->open(folder / "parts.exr", 2, specs)) << out->geterror();
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, sky.rgb.data()));
        ASSERT_TRUE(out->open(folder / "parts.exr", specs[1], OIIO::ImageOutput::AppendSubimage));
        const std::vector<float> other(sky.rgb.size(), 9.0f);
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, other.data()));
        ASSERT_TRUE(out->close());
    };
    write_parts();
    EXPECT_CONTAINS(refusal(folder / "parts.exr"), "may be the light");
    specs[1].channelnames = {"N.X", "N.Y", "N.Z"};
    write_parts();
    const Probe probe = read_probe(folder / "parts.exr");
    expect_same(probe, sky, 0.0, "first part");
    EXPECT_TRUE(probe.warnings.empty());

    OIIO::ImageSpec deep = rgb_spec(sky);
    deep.deep = true;
    {
        const auto out = OIIO::ImageOutput::create("deep.exr");
        ASSERT_TRUE(out->open(folder / "deep.exr", deep)) << out->geterror();
        OIIO::DeepData data(deep);
        ASSERT_TRUE(out->write_deep_image(data)) << out->geterror();
        ASSERT_TRUE(out->close());
    }
    EXPECT_CONTAINS(refusal(folder / "deep.exr"), "deep");
}

// FIPS 180-2: the digest of "abc" is known; of an image, that of its bytes, whatever it holds.
TEST(InputFiles, Sha256IsOfTheFilesBytes) {
    const Folder folder;
    // A plain PPM is text, so its digest can be had with any tool: printf ... | sha256sum
    const std::string ppm = "P3\n2 1\n255\n255 255 255 0 0 0\n";
    write_text(folder / "two.ppm", ppm);
    const Probe probe = read_probe(folder / "two.ppm");
    EXPECT_EQ(probe.source_sha256, "981d91bf6e5ded606784b30e2dd51109afe4138c9a95ff05187b1655efb236c9");
    EXPECT_EQ(probe.rgb, (std::vector<float>{1, 1, 1, 0, 0, 0}));
}

} // namespace
