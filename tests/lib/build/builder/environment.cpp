// Environments by the public library: every form of pixels, rows on demand, targets, and what the program makes.
#include "tests/inputs/write_rgb.h"
#include "tests/lib/build/builder/builder.h"

#include "input/sha256.h"

#include <acdf/curves/curves.h>
#include <acdf/renderers.h>

#include <algorithm>
#include <memory>

namespace {

using namespace acdf;
using namespace acdf::builder;
using namespace acdf::test;

std::uint16_t half_of(float value) { // normal numbers of at most 11 bits
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    EXPECT_EQ(bits & 0x1FFFu, 0u);
    return static_cast<std::uint16_t>((bits >> 16 & 0x8000u) | ((bits >> 23 & 0xFFu) - 112u) << 10 |
                                      (bits >> 13 & 0x3FFu));
}

/// Copies texels into memory of its own layout, as tight as the strides allow, with garbage between.
class Spread {
public:
    Spread(const std::vector<float>& rgb, Number number, std::uint32_t channels, std::ptrdiff_t channel,
           std::ptrdiff_t pixel, std::ptrdiff_t row) {
        const auto last = [](std::ptrdiff_t stride, std::uint32_t n) { return stride * std::ptrdiff_t(n - 1); };
        std::ptrdiff_t low = 0, high = 8;
        for (const std::ptrdiff_t reach : {last(channel, channels), last(pixel, kSkyWidth), last(row, kSkyHeight)})
            (reach < 0 ? low : high) += reach;
        memory_.assign(std::size_t(high - low), 0xFF);
        unsigned char* const first = memory_.data() - low;
        for (std::uint32_t y = 0; y < kSkyHeight; ++y)
            for (std::uint32_t x = 0; x < kSkyWidth; ++x)
                for (std::uint32_t k = 0; k < std::min(channels, 3u); ++k)
                    write(first + y * row + x * pixel + k * channel, number, rgb[3 * (y * kSkyWidth + x) + k]);
        pixels = {first, kSkyWidth, kSkyHeight, channels, number, channel, pixel, row, Projection::latlong};
    }

    Pixels pixels;

private:
    static void write(unsigned char* at, Number number, float value) {
        const double wide = double{value};
        const std::uint16_t half = number == Number::float16 ? half_of(value) : std::uint16_t{0};
        if (number == Number::float32) std::memcpy(at, &value, 4);
        else if (number == Number::float16) std::memcpy(at, &half, 2);
        else std::memcpy(at, &wide, 8);
    }

    std::vector<unsigned char> memory_;
};

TEST(Builder, TakesPixelsInEveryForm) {
    const std::vector<float> rgb = sky();
    const Bytes expected = bytes_of(pixels_of(rgb), cells(200));
    constexpr std::ptrdiff_t w = kSkyWidth, h = kSkyHeight;
    const struct {
        const char* what;
        Number number;
        std::uint32_t channels;
        std::ptrdiff_t channel, pixel, row;
    } forms[] = {
        {"RGBA", Number::float32, 4, 4, 16, 16 * w},
        {"half RGB", Number::float16, 3, 2, 6, 6 * w},
        {"half RGBA with padded rows", Number::float16, 4, 2, 8, 8 * w + 40},
        {"double", Number::float64, 3, 8, 24, 24 * w},
        {"rows from the bottom in memory", Number::float32, 3, 4, 12, -12 * w},
        {"mirrored in memory", Number::float32, 3, 4, -12, 12 * w},
        {"BGR", Number::float32, 3, -4, 12, 12 * w},
        {"planes", Number::float32, 3, 4 * w * h, 4, 4 * w},
        {"columns", Number::float32, 3, 4, 12 * h, 12},
        {"nothing aligned", Number::float32, 3, 5, 17, 17 * w + 3},
    };
    for (const auto& f : forms) {
        const Spread spread(rgb, f.number, f.channels, f.channel, f.pixel, f.row);
        EXPECT_EQ(bytes_of(spread.pixels, cells(200)), expected) << f.what;
    }
    Pixels defaults = pixels_of(rgb); // packed by default, in parts too
    defaults.pixel_stride = 12;
    EXPECT_EQ(bytes_of(defaults, cells(200)), expected);
    defaults.row_stride = 12 * w;
    EXPECT_EQ(bytes_of(defaults, cells(200)), expected);
}

TEST(Builder, OneChannelIsGrey) {
    const std::vector<float> rgb = sky();
    std::vector<float> grey, three;
    for (std::size_t i = 0; i < rgb.size(); i += 3) {
        grey.push_back(rgb[i]);
        three.insert(three.end(), 3, rgb[i]);
    }
    Pixels pixels = pixels_of(grey);
    pixels.channels = 1;
    for (const AcdfChannels mode : {ACDF_CHANNELS_WEIGHTED, ACDF_CHANNELS_SEPARATE, ACDF_CHANNELS_LARGEST}) {
        EnvironmentOptions options = cells(150);
        options.target.channels.mode = mode;
        if (mode != ACDF_CHANNELS_WEIGHTED) options.target.channels.weights = {1.0, 1.0, 1.0};
        EXPECT_EQ(bytes_of(pixels, options), bytes_of(pixels_of(three), options)) << mode;
    }
}

TEST(Builder, RowsOnDemandEqualPixels) {
    constexpr std::uint32_t width = 1024, height = 600; // of more than two bands
    std::vector<float> rgb = sky(width, height);
    rgb[5] = std::numeric_limits<float>::quiet_NaN();
    rgb[3 * (400 * width + 20)] = std::numeric_limits<float>::infinity();
    rgb[3 * (599 * width + 21) + 1] = -2.0f;
    for (const BadTexelPolicy policy : {BadTexelPolicy::zero, BadTexelPolicy::clamp}) {
        std::uint32_t next = 0, passes = 0, largest = 0;
        Rows rows;
        rows.width = width, rows.height = height;
        rows.read = [&](std::uint32_t first, std::uint32_t count, float* out) {
            if (first == 0) next = 0, ++passes;
            EXPECT_EQ(first, next);
            next = first + count;
            largest = std::max(largest, count);
            std::copy_n(rgb.begin() + 3 * first * width, 3 * count * width, out);
            return true;
        };
        EnvironmentOptions options = cells(300);
        options.target.bad_texels = policy;
        Environment by_rows, by_pixels;
        ASSERT_TRUE(environment(rows, options, by_rows).ok());
        ASSERT_TRUE(environment(pixels_of(rgb, width, height), options, by_pixels).ok());
        EXPECT_EQ(by_rows.bytes, by_pixels.bytes);
        EXPECT_EQ(next, height);
        EXPECT_EQ(passes, policy == BadTexelPolicy::clamp ? 2u : 1u);
        EXPECT_LT(largest, height / 2); // never all of them at once
        for (const Environment* made : {&by_rows, &by_pixels}) {
            const BadTexels& bad = made->bad_texels;
            EXPECT_EQ(bad.nan, 1u);
            EXPECT_EQ(bad.infinite, 1u);
            EXPECT_EQ(bad.negative, 1u);
            EXPECT_EQ(bad.x, 1);
            EXPECT_EQ(bad.y, 0);
        }
    }
}

TEST(Builder, ClampTakesTheLargestOfTheWholeMap) {
    constexpr std::uint32_t width = 1024, height = 600;
    std::vector<float> rgb = sky(width, height); // its sun, 1024, lies in another band
    const std::size_t at = 3 * (590 * width + 7);
    std::vector<float> mended = rgb;
    EnvironmentOptions options = cells(300);
    for (std::size_t k = 0; k < 3; ++k)
        rgb[at + k] = std::numeric_limits<float>::infinity(), mended[at + k] = 1024.0f;
    options.target.bad_texels = BadTexelPolicy::clamp;
    EXPECT_EQ(bytes_of(pixels_of(rgb, width, height), options),
              bytes_of(pixels_of(mended, width, height), options));
}

struct Layout {
    const char* name;
    Projection projection;
    std::uint32_t width, height;
};
constexpr Layout layouts[] = {
    {"latlong", Projection::latlong, 64, 32},
    {"latlong", Projection::latlong, 50, 40},
    {"angular", Projection::angular, 20, 20},
    {"mirrorball", Projection::mirrorball, 20, 20},
    {"octahedral", Projection::octahedral, 40, 40},
    {"cube-cross", Projection::vertical_cross, 18, 24},
    {"cube-cross", Projection::horizontal_cross, 24, 18},
    {"cube-cross", Projection::stacked_cube, 8, 48},
};

TEST(Builder, MakesWhatTheProgramMakesOfEveryProjection) {
    const Folder folder;
    for (const Layout& layout : layouts) {
        std::vector<float> rgb = sky(layout.width, layout.height);
        rgb[3 * (layout.height / 2 * layout.width + layout.width / 2)] = -1.0f;
        write_rgb(folder / "p.pfm", int(layout.width), int(layout.height), rgb);
        EnvironmentOptions options;
        options.goal = builder::Goal::of_budget(4000);
        options.codec = ACDF_CODEC_ZLIB;
        options.target.filter = ACDF_FILTER_NEAREST;
        options.source = {"p.pfm", input::file_sha256(folder / "p.pfm"), "",
                          std::string("--projection ") + layout.name + " "};
        Pixels pixels = pixels_of(rgb, layout.width, layout.height);
        pixels.projection = layout.projection;
        EXPECT_EQ(bytes_of(pixels, options),
                  program_bytes({"env", folder / "p.pfm", "--projection", layout.name, "--budget", "4000",
                                 "--compress", "zlib", "--filter", "nearest"},
                                folder / "p.acdf"))
            << layout.name << " " << layout.width;
        if (acdf_test::kSanitized) break; // test_build and test_projection resample the others
    }
}

TEST(Builder, MakesWhatTheProgramMakesOfEveryFit) {
    const Folder folder;
    const std::vector<float> rgb = sky();
    write_rgb(folder / "p.pfm", int(kSkyWidth), int(kSkyHeight), rgb);
    const auto expect_same = [&](EnvironmentOptions options, std::vector<std::string> arguments) {
        options.source = {"p.pfm", input::file_sha256(folder / "p.pfm"), "", ""};
        const std::string text = arguments.empty() ? "" : arguments.back();
        arguments.insert(arguments.begin(), {"env", folder / "p.pfm"});
        const Bytes made = bytes_of(pixels_of(rgb), options);
        EXPECT_EQ(made, program_bytes(arguments, folder / "p.acdf")) << text;
        File file;
        ASSERT_TRUE(File::from_memory(made.data(), made.size(), file, acdf::with_curves()).ok());
        const Text told = file.metadata("fit.options");
        EXPECT_EQ(std::string(told.data, told.size), option_text(options));
    };
    expect_same({}, {});
    EnvironmentOptions options;
    options.goal = builder::Goal::of_variance(0.02);
    options.fit.max_weight = 40.0;
    options.target.filter = ACDF_FILTER_NEAREST; // within texels interpolated light has more by itself
    expect_same(options, {"--target-variance", "0.02", "--max-weight", "40", "--filter", "nearest"});
    options = {};
    options.goal = builder::Goal::of_cells(300);
    options.target.channels = {ACDF_CHANNELS_SEPARATE, {1.0, 1.0, 1.0}};
    expect_same(options, {"--cells", "300", "--channel", "rgb"});
    options = {};
    options.fit.fit = ACDF_FIT_CDF;
    options.fit.phi_segments = 12, options.fit.theta_segments = 9;
    options.fit.order = Order::z;
    options.fit.gradient_knots = 3;
    options.fit.conditional = Conditional::mean;
    expect_same(options,
                {"--fit", "cdf", "--knots", "12x9", "--order", "z", "--gradient", "3", "--conditional", "mean"});
    options = {};
    options.fit.fit = ACDF_FIT_PDF;
    options.fit.epsilon = 0.05;
    expect_same(options, {"--fit", "pdf", "--eps", "0.05", "--knots", "64x64"});
    options.fit = {};
    options.fit.fit = ACDF_FIT_UNIFORM;
    expect_same(options, {"--fit", "uniform"});
    options = {};
    options.target.wrap = Wrap::repeat;
    expect_same(options, {"--wrap", "repeat"});
    options.target.filter = ACDF_FILTER_NEAREST; // whose lookup knows none
    expect_same(options, {"--filter", "nearest", "--wrap", "repeat"});
}

TEST(Builder, MakesWhatTheProgramMakesForARenderer) {
    const Folder folder;
    const std::vector<float> rgb = sky();
    write_rgb(folder / "p.pfm", int(kSkyWidth), int(kSkyHeight), rgb);
    for (const Renderer& renderer : renderers()) {
        EnvironmentOptions options;
        options.target = renderer.target;
        options.mis = renderer.partner(options);
        const bool square = renderer.target.domain == Domain::octahedral;
        options.source = {"p.pfm", input::file_sha256(folder / "p.pfm"), "",
                          std::string("--domain ") + (square ? "octahedral " : "latlong ")};
        EXPECT_EQ(bytes_of(pixels_of(rgb), options),
                  program_bytes({"env", folder / "p.pfm", "--for", renderer.name}, folder / "p.acdf"))
            << renderer.name;
        if (acdf_test::kSanitized) break;
    }
}

TEST(Builder, OneTargetMakesManyFiles) {
    const std::vector<float> rgb = sky();
    Target target;
    EXPECT_TRUE(target.empty());
    ASSERT_TRUE(Target::from(pixels_of(rgb), {}, target).ok());
    EXPECT_EQ(target.columns(), kSkyWidth);
    EXPECT_EQ(target.rows(), kSkyHeight);
    const Target copy = target;
    target = Target();
    for (const std::uint64_t budget : {2000u, 4000u, 8000u}) {
        EnvironmentOptions options;
        options.goal = builder::Goal::of_budget(budget);
        Environment made;
        ASSERT_TRUE(environment(copy, options, made).ok());
        EXPECT_LE(made.bytes.size(), budget);
        EXPECT_EQ(made.bytes, bytes_of(pixels_of(rgb), options));
        EXPECT_NEAR(made.accuracy.total, copy.total(), 1e-6 * copy.total());
    }
}

TEST(Builder, FilesAreReadInPlace) {
    const Bytes made = bytes_of(pixels_of(sky()), cells(200));
    File file;
    ASSERT_TRUE(File::from_memory(made.data(), made.size(), file, acdf::with_curves()).ok());
    EXPECT_EQ(static_cast<const void*>(&file.header()), made.data());
    EXPECT_GT(file.environment().sample(0.3, 0.4).pdf, 0.0f);
}

TEST(Builder, ThreadsDoNotMatter) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "tests/same_bytes.sh runs sanitized programs so";
    const std::vector<float> rgb = sky(60, 60);
    Pixels pixels = pixels_of(rgb, 60, 60);
    pixels.projection = Projection::angular;
    std::vector<Bytes> all;
    for (const int threads : {0, 1, 2, 7}) {
        Environment made;
        Control control;
        control.threads = threads;
        ASSERT_TRUE(environment(pixels, cells(500), made, control).ok());
        all.push_back(made.bytes);
    }
    for (const Bytes& bytes : all) EXPECT_EQ(bytes, all.front());
}

} // namespace
