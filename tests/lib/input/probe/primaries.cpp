// Luminance by the primaries that files declare, luminance beside chroma, and what half floats end at.
#include "input/probe/primaries.h"
#include "build/builder/sources.h"
#include "tests/lib/input/write.h"

#include <OpenEXR/ImfRgbaFile.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace {

using namespace acdf::input;
using namespace acdf::test;
namespace builder = acdf::builder;

const std::vector<float> kAcesCg = {0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
const std::vector<float> kXyz = {1, 0, 0, 1, 0, 0, 1.0f / 3, 1.0f / 3};
const std::vector<float> kRec709 = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
const std::vector<float> kAces2065 = {0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.077f, 0.32168f, 0.33767f};

void expect_weights(const std::vector<float>& chromaticities, double r, double g, double b) {
    const auto found = luminance_of(chromaticities);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->r, r, 2e-4);
    EXPECT_NEAR(found->g, g, 2e-4);
    EXPECT_NEAR(found->b, b, 2e-4);
}

// SMPTE ST 2065-1 and the Academy's S-2014-004 have these sums.
TEST(Primaries, LuminanceIsThatOfTheStandards) {
    expect_weights(kAcesCg, 0.2722, 0.6741, 0.0537);
    expect_weights(kXyz, 0.0, 1.0, 0.0);
    expect_weights({0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f}, 0.2627, 0.6780, 0.0593);
    // Blue is less than no light there: 0.3440 R + 0.7282 G - 0.0721 B.
    expect_weights(kAces2065, 0.3440 / 1.0722, 0.7282 / 1.0722, 0.0);
    EXPECT_FALSE(luminance_of(kRec709));
    EXPECT_FALSE(luminance_of({}));
    EXPECT_FALSE(luminance_of(std::vector<float>(8, 0.0f)));
    EXPECT_FALSE(luminance_of(std::vector<float>(8, std::numeric_limits<float>::quiet_NaN())));
    EXPECT_FALSE(luminance_of({0.1f, 0.1f, 0.2f, 0.2f, 0.3f, 0.3f, 0.3f, 0.3f})); // on a line
}

OIIO::ImageSpec with(const std::vector<float>& chromaticities, int channels, OIIO::TypeDesc type) {
    OIIO::ImageSpec spec(32, 16, channels, type);
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities.data());
    return spec;
}

/// The weights of a target of a probe.
builder::ChannelWeights fitted(const std::string& path, const builder::TargetOptions& options) {
    builder::TargetRows rows(options);
    read_probe(path, {}, rows);
    const auto w = rows.finish().data()->options.weights;
    return {w.r, w.g, w.b};
}

// By both libraries: tiles are read by OpenImageIO.
TEST(Primaries, FilesAreFittedByTheirOwnLuminance) {
    const Folder folder;
    const std::string path = folder / "a.exr";
    for (const int tile : {0, 16}) {
        OIIO::ImageSpec spec = with(kAcesCg, 3, OIIO::TypeDesc::HALF);
        spec.tile_width = spec.tile_height = tile;
        write_image(path, spec, latlong_sky(32).rgb);
        const Probe probe = read_probe(path);
        ASSERT_TRUE(probe.luminance);
        EXPECT_NEAR(probe.luminance->r, 0.2722, 2e-4);
        ASSERT_EQ(probe.warnings.size(), 1u);
        EXPECT_CONTAINS(probe.warnings[0], "luminance is 0.272 R + 0.674 G + 0.0537 B");
        EXPECT_NEAR(fitted(path, {}).g, 0.6741, 2e-4);
        builder::TargetOptions red;
        red.channels.weights = {1.0, 0.0, 0.0};
        EXPECT_EQ(fitted(path, red).r, 1.0) << "what is asked for stays";
        write_image(path, with(kRec709, 3, OIIO::TypeDesc::HALF), latlong_sky(32).rgb);
        EXPECT_TRUE(read_probe(path).warnings.empty());
        EXPECT_EQ(fitted(path, {}).r, builder::ChannelWeights().r);
    }
}

/// A half image of n x m texels with an overflowing one.
void write_bright(const std::string& path, const std::vector<float>& chromaticities, int width, int height) {
    OIIO::ImageSpec spec = with(chromaticities, 3, OIIO::TypeDesc::HALF);
    spec.width = spec.full_width = width;
    spec.height = spec.full_height = height;
    std::vector<float> rgb(3 * static_cast<std::size_t>(width * height), 0.5f);
    rgb[0] = rgb[1] = rgb[2] = std::numeric_limits<float>::infinity();
    write_image(path, spec, rgb);
}

// Six files or a strip of six squares: one luminance, and the largest half where texels overflowed.
TEST(Primaries, FacesOfCubesKeepTheirLuminanceAndTheirHalfs) {
    const Folder folder;
    std::string six;
    for (const char* name : {"0.exr", "1.exr", "2.exr", "3.exr", "4.exr", "5.exr"}) {
        write_bright(folder / name, kAcesCg, 8, 8);
        six += (six.empty() ? "" : ",") + (folder / name);
    }
    write_bright(folder / "strip.exr", kAcesCg, 48, 8);
    ProbeOptions options;
    options.bad_pixels = acdf::build::BadPixels::clamp;
    ASSERT_TRUE(parse_faces("directx", options.faces.emplace()));
    for (const std::string& source : {six, folder / "strip.exr"}) {
        const Probe probe = read_probe(source, options);
        ASSERT_TRUE(probe.luminance) << source;
        EXPECT_NEAR(probe.luminance->r, 0.2722, 2e-4);
        // Resampled; 0.5 if the largest finite texel stood for it.
        EXPECT_GT(*std::max_element(probe.rgb.begin(), probe.rgb.end()), 1e4f) << source;
    }
    write_bright(folder / "3.exr", kRec709, 8, 8);
    try {
        read_probe(six, options);
        ADD_FAILURE() << "was read";
    } catch (const Error& error) {
        EXPECT_CONTAINS(std::string(error.what()), "3.exr: its primaries are not those of the first");
    }
}

TEST(Primaries, XyzMayBeNamedSo) {
    const Folder folder;
    OIIO::ImageSpec spec = with(kXyz, 3, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"X", "Y", "Z"};
    const Pixels sky = latlong_sky(32);
    write_image(folder / "a.exr", spec, sky.rgb);
    const Probe probe = read_probe(folder / "a.exr");
    EXPECT_EQ(probe.rgb, sky.rgb);
    ASSERT_TRUE(probe.luminance);
    EXPECT_NEAR(probe.luminance->g, 1.0, 1e-6);
}

/// As OpenEXR writes it: Y for each pixel, rounded to eight bits, RY and BY for every other one.
void write_luminance_chroma(const std::string& path, const Pixels& sky, Imf::RgbaChannels channels) {
    std::vector<Imf::Rgba> pixels;
    for (std::size_t i = 0; i < sky.rgb.size(); i += 3)
        pixels.emplace_back(Imf::Rgba(sky.rgb[i], sky.rgb[i + 1], sky.rgb[i + 2]));
    Imf::RgbaOutputFile file(path.c_str(), sky.width, sky.height, channels);
    file.setFrameBuffer(pixels.data(), 1, static_cast<std::size_t>(sky.width));
    file.writePixels(sky.height);
}

TEST(Primaries, LuminanceBesideChromaIsReadAlone) {
    const Folder folder;
    const Pixels sky = latlong_sky(64);
    for (const Imf::RgbaChannels channels : {Imf::WRITE_YC, Imf::WRITE_YCA, Imf::WRITE_Y}) {
        write_luminance_chroma(folder / "a.exr", sky, channels);
        const Probe probe = read_probe(folder / "a.exr");
        ASSERT_EQ(probe.rgb.size(), sky.rgb.size());
        for (std::size_t i = 0; i < sky.rgb.size(); i += 3) {
            const double y = 0.2126 * static_cast<double>(sky.rgb[i]) +
                             0.7152 * static_cast<double>(sky.rgb[i + 1]) +
                             0.0722 * static_cast<double>(sky.rgb[i + 2]);
            ASSERT_NEAR(probe.rgb[i], y, 0.006 * y);
            ASSERT_EQ(probe.rgb[i], probe.rgb[i + 2]);
        }
        EXPECT_TRUE(probe.warnings.empty());
    }
}

// A sun above 65504 is infinite in half floats, whatever else the file holds.
TEST(Primaries, HalfFloatsAreClampedToWhereTheyEnd) {
    const Folder folder;
    const std::string path = folder / "a.exr";
    Pixels sky = latlong_sky(32);
    std::fill_n(sky.at(20, 4), 3, std::numeric_limits<float>::infinity());
    ProbeOptions options;
    options.bad_pixels = acdf::build::BadPixels::clamp;
    const auto sun = [&] {
        const Probe probe = read_probe(path, options);
        EXPECT_EQ(probe.bad.infinite, 1u);
        return probe.rgb[3 * (4 * 32 + 20) + 1];
    };
    for (const int tile : {0, 16}) {
        OIIO::ImageSpec spec(32, 16, 3, OIIO::TypeDesc::HALF);
        spec.tile_width = spec.tile_height = tile;
        write_image(path, spec, sky.rgb);
        EXPECT_EQ(sun(), 65504.0f);
        spec.format = OIIO::TypeDesc::FLOAT;
        write_image(path, spec, sky.rgb);
        EXPECT_LT(sun(), 65504.0f);
    }
    // Colours in half floats beside a depth in single ones, as Blender writes both.
    OIIO::ImageSpec depth(32, 16, 4, OIIO::TypeDesc::FLOAT);
    depth.channelnames = {"R", "G", "B", "Z"};
    depth.channelformats = {OIIO::TypeDesc::HALF, OIIO::TypeDesc::HALF, OIIO::TypeDesc::HALF,
                            OIIO::TypeDesc::FLOAT};
    std::vector<float> pixels;
    for (std::size_t i = 0; i < sky.rgb.size(); ++i) {
        pixels.push_back(sky.rgb[i]);
        if (i % 3 == 2) pixels.push_back(1e9f);
    }
    write_image(path, depth, pixels);
    EXPECT_EQ(sun(), 65504.0f);
    // As a disc, which is mended as a whole.
    Pixels ball = render_sky(angular_reference, 64, 64);
    ball.at(33, 40)[0] = std::numeric_limits<float>::infinity();
    write_rgb(path, ball, OIIO::TypeDesc::HALF);
    options.projection = Projection::angular;
    const Probe probe = read_probe(path, options);
    EXPECT_GT(*std::max_element(probe.rgb.begin(), probe.rgb.end()), 3000.0f);
}

// The same of pixels in memory.
TEST(Primaries, HalfFloatsInMemoryAreClampedToWhereTheyEnd) {
    std::vector<std::uint16_t> half(3 * 16 * 8, 0x3C00);         // 1
    half[3 * 20] = half[3 * 20 + 1] = half[3 * 20 + 2] = 0x7C00; // infinity
    builder::Pixels pixels;
    pixels.data = half.data();
    pixels.width = 16, pixels.height = 8;
    pixels.number = builder::Number::float16;
    builder::TargetOptions options;
    options.bad_texels = builder::BadTexelPolicy::clamp;
    builder::Target target;
    ASSERT_TRUE(builder::Target::from(pixels, options, target).ok());
    EXPECT_GT(target.total(), 65504.0 * 4.0 * 3.14159 / (16.0 * 8.0 * 2.0));
}

} // namespace
