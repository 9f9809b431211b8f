// Environments that change: a rebuilt frame is as good as one that is built, regions give the bytes of whole
// frames, no memory is taken once it runs, and what is refused or cancelled leaves the last frame as it was.
#include "tests/lib/build/builder/builder.h"
#include "tests/lib/reader/count_allocations.h"

#include "build/accuracy/environment.h"
#include "build/builder/sources.h"

#include <acdf/curves/curves.h>
#include <acdf/rebuild_c.h>

#include <new>
#include <random>

// What the library takes through operator new: the linker catches malloc in its objects alone.
[[gnu::noinline]] void* operator new(std::size_t size) {
    count(size);
    if (void* data = __real_malloc(size ? size : 1)) return data;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    count(size);
    return __real_malloc(size ? size : 1);
}
[[gnu::noinline]] void operator delete(void* data) noexcept { std::free(data); }
[[gnu::noinline]] void operator delete(void* data, std::size_t) noexcept { std::free(data); }

namespace {

using namespace acdf;
using namespace acdf::builder;
using namespace acdf::test;

/// A sky with clouds of about the size of `scale` texels, noise and a small sun.
std::vector<float> moving_sky(std::uint32_t width, std::uint32_t height, unsigned frame = 0) {
    std::mt19937 random(7 + frame);
    std::vector<float> rgb;
    const std::uint32_t sun_x = width / 3 + frame, sun_y = height / 4;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const double phi = 6.2831853 * (x + 0.5) / width, theta = 3.1415927 * (y + 0.5) / height;
            const double cloud =
                std::sin(8.0 * phi + 3.0 * std::sin(4.0 * theta) + 0.1 * frame) * std::cos(9.0 * theta);
            double light = theta < 1.6 ? 0.6 + 0.4 * std::cos(theta) + (cloud > 0.3 ? 2.0 * cloud : 0.0) : 0.1;
            light *= 0.8 + 0.4 * double(random() & 0xFFFF) / 65536.0;
            if (x == sun_x && y == sun_y) light = 5000.0;
            for (const double channel : {1.0, 0.9, 1.2}) rgb.push_back(static_cast<float>(light * channel));
        }
    return rgb;
}

struct Case {
    std::uint32_t width, height;
    AcdfFilter filter;
    Projection projection = Projection::latlong;
    AcdfChannels channels = ACDF_CHANNELS_WEIGHTED;
    Wrap wrap = Wrap::clamp;
};

const Case kCases[] = {
    {128, 64, ACDF_FILTER_NEAREST},
    {128, 64, ACDF_FILTER_BILINEAR},
    {97, 61, ACDF_FILTER_NEAREST},
    {97, 61, ACDF_FILTER_BILINEAR, Projection::latlong, ACDF_CHANNELS_WEIGHTED, Wrap::repeat},
    {64, 64, ACDF_FILTER_NEAREST, Projection::octahedral},
    {65, 65, ACDF_FILTER_BILINEAR, Projection::octahedral, ACDF_CHANNELS_SEPARATE},
    {96, 50, ACDF_FILTER_BILINEAR, Projection::latlong, ACDF_CHANNELS_SEPARATE},
    {96, 50, ACDF_FILTER_NEAREST, Projection::latlong, ACDF_CHANNELS_LARGEST},
    {1200, 900, ACDF_FILTER_BILINEAR}, // larger than tables of all levels are made for
    {1500, 701, ACDF_FILTER_NEAREST},
};

EnvironmentOptions options_of(const Case& of, std::uint64_t budget) {
    EnvironmentOptions options;
    options.goal = Goal::of_budget(budget);
    options.target.filter = of.filter;
    options.target.wrap = of.wrap;
    options.target.channels.mode = of.channels;
    if (of.channels != ACDF_CHANNELS_WEIGHTED) options.target.channels.weights = {1.0, 1.0, 1.0};
    return options;
}

Pixels pixels_of(const Case& of, const std::vector<float>& rgb) {
    Pixels pixels = test::pixels_of(rgb, of.width, of.height);
    pixels.projection = of.projection;
    return pixels;
}

EnvironmentRebuilder made(const Case& of, const EnvironmentOptions& options, Quality quality = Quality::fast) {
    EnvironmentRebuilder out;
    const builder::Status status =
        EnvironmentRebuilder::make(of.width, of.height, options, out, quality, of.projection);
    EXPECT_TRUE(status.ok()) << status.message;
    return out;
}

Control one_thread() {
    Control control;
    control.threads = 1;
    return control;
}

Bytes bytes_of(const EnvironmentRebuilder& of) { return {of.data(), of.data() + of.size()}; }

void require(const builder::Status& status) { ASSERT_TRUE(status.ok()) << status.message; }

TEST(Rebuild, IsAsGoodAsWhatIsBuilt) {
    for (const Case& of : kCases) {
        SCOPED_TRACE(std::to_string(of.width) + " columns, filter " + std::to_string(of.filter));
        const std::vector<float> rgb = moving_sky(of.width, of.height);
        const std::uint64_t budget = 3 << 10;
        EnvironmentRebuilder fast = made(of, options_of(of, budget));
        require(fast.rebuild(pixels_of(of, rgb), one_thread()));
        Environment best;
        require(environment(pixels_of(of, rgb), options_of(of, budget), best));
        EXPECT_LE(fast.size(), budget);
        EXPECT_NEAR(fast.view().total(), best.accuracy.total, 2e-6 * best.accuracy.total);
        // As the builder measures its own files.
        Target target;
        require(Target::from(pixels_of(of, rgb), options_of(of, budget).target, target));
        File file;
        ASSERT_TRUE(File::from_memory(fast.data(), fast.size(), file, acdf::with_curves()).ok());
        const EnvironmentAccuracy accuracy = build::measure_environment(file, target.data()->grid);
        EXPECT_EQ(accuracy.support_violations, 0u);
        EXPECT_NEAR(fast.relative_variance(), accuracy.relative_variance, 1e-4 + 1e-3 * accuracy.relative_variance);
        const double least = best.accuracy.least_variance;
        EXPECT_LE(accuracy.relative_variance - least, 1.25 * (best.accuracy.relative_variance - least) + 1e-5);
    }
}

/// E[(f/p)^2] over the square of the mean, of a map that is looked up by its texels, by adding texels up.
TEST(Rebuild, ReportsTheVarianceThatTexelsHave) {
    const Case of{128, 64, ACDF_FILTER_NEAREST};
    const std::vector<float> rgb = moving_sky(of.width, of.height);
    EnvironmentRebuilder sky = made(of, options_of(of, 2 << 10));
    require(sky.rebuild(pixels_of(of, rgb), one_thread()));
    double total = 0.0, square = 0.0, covered = 0.0;
    for (std::uint32_t y = 0; y < of.height; ++y)
        for (std::uint32_t x = 0; x < of.width; ++x) {
            const double theta = ACDF_PI * (y + 0.5) / of.height,
                         phi = ACDF_PI - 2.0 * ACDF_PI * (x + 0.5) / of.width;
            const float direction[3] = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                                        static_cast<float>(std::sin(theta) * std::sin(phi)),
                                        static_cast<float>(std::cos(theta))};
            const double omega = 2.0 * ACDF_PI / of.width *
                                 (std::cos(ACDF_PI * y / of.height) - std::cos(ACDF_PI * (y + 1) / of.height));
            const float* texel = &rgb[3 * (y * of.width + x)];
            const double f = 0.2126 * double{texel[0]} + 0.7152 * double{texel[1]} + 0.0722 * double{texel[2]};
            const double p = double{sky.view().pdf(direction)};
            ASSERT_GT(p, 0.0);
            total += f * omega;
            square += f * f / p * omega;
            covered += p * omega;
        }
    EXPECT_NEAR(covered, 1.0, 1e-5);
    EXPECT_NEAR(sky.view().total(), total, 1e-5 * total);
    EXPECT_NEAR(sky.relative_variance(), square / (total * total) - 1.0, 1e-4);
}

TEST(Rebuild, ViewsAreThoseOfTheFile) {
    const Case of{97, 61, ACDF_FILTER_BILINEAR};
    const std::vector<float> rgb = moving_sky(of.width, of.height);
    EnvironmentRebuilder sky = made(of, options_of(of, 4 << 10));
    require(sky.rebuild(pixels_of(of, rgb), one_thread()));
    const Bytes bytes = bytes_of(sky);
    File file;
    ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
    EXPECT_EQ(file.environment().total(), sky.view().total());
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 20000; ++i) {
        const double u0 = unit(random), u1 = unit(random);
        const DirectionSample a = sky.view().sample(u0, u1), b = file.environment().sample(u0, u1);
        ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0);
        ASSERT_EQ(sky.view().pdf(b.direction), file.environment().pdf(b.direction));
    }
}

TEST(Rebuild, BestMakesTheBytesOfTheBuilder) {
    const Case of{96, 50, ACDF_FILTER_BILINEAR};
    const std::vector<float> rgb = moving_sky(of.width, of.height), next = moving_sky(of.width, of.height, 1);
    EnvironmentRebuilder best = made(of, options_of(of, 3 << 10), Quality::best);
    require(best.rebuild(pixels_of(of, rgb)));
    EXPECT_EQ(bytes_of(best), test::bytes_of(pixels_of(of, rgb), options_of(of, 3 << 10)));
    require(best.update(pixels_of(of, next), {1, 1, 2, 2}));
    EXPECT_EQ(bytes_of(best), test::bytes_of(pixels_of(of, next), options_of(of, 3 << 10)));
}

TEST(Rebuild, RegionsGiveTheBytesOfWholeFrames) {
    for (const Case& of : kCases) {
        SCOPED_TRACE(std::to_string(of.width) + " columns, filter " + std::to_string(of.filter));
        std::vector<float> rgb = moving_sky(of.width, of.height);
        EnvironmentRebuilder whole = made(of, options_of(of, 3 << 10)), part = made(of, options_of(of, 3 << 10));
        require(part.rebuild(pixels_of(of, rgb), one_thread()));
        const Bytes first = bytes_of(part);
        const std::uint32_t w = of.width, h = of.height;
        const Region regions[] = {{0, 0, 3, 2},     {w - 5, h / 3, 5, 7}, {w / 2, h - 1, 9, 1},
                                  {0, h / 2, w, 1}, {7, 0, 1, h},         {w / 3, h / 4, 1, 1}};
        std::mt19937 random(1);
        for (const Region& region : regions) {
            for (std::uint32_t y = region.y; y < region.y + region.height; ++y)
                for (std::uint32_t x = region.x; x < region.x + region.width; ++x)
                    for (std::size_t k = 0; k < 3; ++k)
                        rgb[3 * (std::size_t{y} * w + x) + k] = static_cast<float>(random() & 0xFF) / 16.0f;
            require(whole.rebuild(pixels_of(of, rgb), one_thread()));
            require(part.update(pixels_of(of, rgb), region, one_thread()));
            ASSERT_EQ(bytes_of(part), bytes_of(whole));
        }
        EXPECT_NE(bytes_of(part), first);
    }
}

TEST(Rebuild, ARegionIsAllThatIsRead) {
    const Case of{64, 32, ACDF_FILTER_BILINEAR};
    std::vector<float> rgb = moving_sky(of.width, of.height);
    EnvironmentRebuilder sky = made(of, options_of(of, 2 << 10));
    require(sky.rebuild(pixels_of(of, rgb), one_thread()));
    const Bytes first = bytes_of(sky);
    std::vector<float> other(rgb.size(), 77.0f);
    for (std::uint32_t y = 4; y < 9; ++y)
        std::copy_n(&rgb[3 * (y * of.width + 5)], 3 * 6, &other[3 * (y * of.width + 5)]);
    require(sky.update(pixels_of(of, other), {5, 4, 6, 5}, one_thread()));
    EXPECT_EQ(bytes_of(sky), first);
}

TEST(Rebuild, MuchBrighterPixelsInARegionAreRight) {
    const Case of{128, 64, ACDF_FILTER_BILINEAR};
    std::vector<float> rgb = moving_sky(of.width, of.height);
    EnvironmentRebuilder whole = made(of, options_of(of, 3 << 10)), part = made(of, options_of(of, 3 << 10));
    require(part.rebuild(pixels_of(of, rgb), one_thread()));
    for (const float sun : {1e12f, 1e30f, 1e-6f}) {
        rgb[3 * (20 * of.width + 100)] = sun;
        require(part.update(pixels_of(of, rgb), {100, 20, 1, 1}, one_thread()));
        require(whole.rebuild(pixels_of(of, rgb), one_thread()));
        EXPECT_EQ(bytes_of(part), bytes_of(whole));
    }
}

TEST(Rebuild, TakesNoMemoryOnceItRuns) {
    for (const Case& of : kCases) {
        SCOPED_TRACE(std::to_string(of.width) + " columns, filter " + std::to_string(of.filter));
        std::vector<std::vector<float>> frames;
        for (unsigned frame = 0; frame < 4; ++frame) frames.push_back(moving_sky(of.width, of.height, 3 * frame));
        EnvironmentRebuilder sky = made(of, options_of(of, 6 << 10));
        const Control control = one_thread();
        require(sky.rebuild(pixels_of(of, frames[0]), control));
        const Bytes first = bytes_of(sky);
        builder::Status status[5];
        std::size_t taken;
        {
            const Counted counted;
            for (std::size_t i = 0; i < 4; ++i) status[i] = sky.rebuild(pixels_of(of, frames[3 - i]), control);
            status[4] = sky.update(pixels_of(of, frames[0]), {3, 3, 20, 10}, control);
            taken = calls;
        }
        for (const builder::Status& each : status) require(each);
        EXPECT_EQ(taken, 0u) << bytes_taken << " bytes";
        EXPECT_EQ(bytes_of(sky), first);
    }
}

TEST(Rebuild, TheCountOfMemorySeesBuilds) {
    const Case of{64, 32, ACDF_FILTER_NEAREST};
    const std::vector<float> rgb = moving_sky(of.width, of.height);
    const Counted counted;
    Environment result;
    require(environment(pixels_of(of, rgb), options_of(of, 2 << 10), result));
    EXPECT_GT(calls, 10u);
}

TEST(Rebuild, ThreadsChangeNothing) {
    for (const Case& of : kCases) {
        const std::vector<float> rgb = moving_sky(of.width, of.height), next = moving_sky(of.width, of.height, 2);
        EnvironmentRebuilder one = made(of, options_of(of, 6 << 10)), many = made(of, options_of(of, 6 << 10));
        for (const auto* frame : {&rgb, &next}) {
            require(one.rebuild(pixels_of(of, *frame), one_thread()));
            for (const int threads : {0, 2, 3}) {
                Control control;
                control.threads = threads;
                require(many.rebuild(pixels_of(of, *frame), control));
                ASSERT_EQ(bytes_of(many), bytes_of(one));
            }
        }
    }
}

TEST(Rebuild, AViewStaysWhileTheNextIsMade) {
    const Case of{128, 64, ACDF_FILTER_NEAREST};
    const std::vector<float> rgb = moving_sky(of.width, of.height), next = moving_sky(of.width, of.height, 5);
    EnvironmentRebuilder sky = made(of, options_of(of, 4 << 10));
    require(sky.rebuild(pixels_of(of, rgb), one_thread()));
    const EnvironmentView view = sky.view();
    const Bytes bytes = bytes_of(sky);
    const std::uint8_t* const data = sky.data();
    const DirectionSample before = view.sample(0.3, 0.2);
    Control control = one_thread();
    control.progress = [&](double, const char*) {
        const DirectionSample during = view.sample(0.3, 0.2);
        return std::memcmp(&during, &before, sizeof before) == 0;
    };
    require(sky.rebuild(pixels_of(of, next), control));
    const DirectionSample after = view.sample(0.3, 0.2);
    EXPECT_EQ(std::memcmp(&after, &before, sizeof before), 0);
    EXPECT_EQ(std::memcmp(data, bytes.data(), bytes.size()), 0);
    EXPECT_NE(bytes_of(sky), bytes);
}

TEST(Rebuild, IsCancelledAtAnyTime) {
    const Case of{128, 64, ACDF_FILTER_BILINEAR};
    const std::vector<float> rgb = moving_sky(of.width, of.height), next = moving_sky(of.width, of.height, 1);
    EnvironmentRebuilder whole = made(of, options_of(of, 4 << 10));
    require(whole.rebuild(pixels_of(of, next), one_thread()));
    for (const int threads : {1, 2}) {
        EnvironmentRebuilder sky = made(of, options_of(of, 4 << 10));
        require(sky.rebuild(pixels_of(of, rgb), one_thread()));
        const Bytes last = bytes_of(sky);
        int cancelled = 0;
        for (int after = 0;; ++after) {
            Control control;
            control.threads = threads;
            int calls_left = after;
            double told = 0.0;
            control.progress = [&](double share, const char*) {
                EXPECT_GE(share, told);
                told = share;
                return calls_left-- > 0;
            };
            const builder::Status status = sky.rebuild(pixels_of(of, next), control);
            if (status.ok()) break;
            ++cancelled;
            ASSERT_EQ(status.code, builder::ErrorCode::cancelled);
            ASSERT_EQ(bytes_of(sky), told == 1.0 ? bytes_of(whole) : last);
        }
        EXPECT_GT(cancelled, 10);
        EXPECT_EQ(bytes_of(sky), bytes_of(whole));
    }
    // What follows a cancelled frame is whole.
    EnvironmentRebuilder sky = made(of, options_of(of, 4 << 10));
    require(sky.rebuild(pixels_of(of, rgb), one_thread()));
    Control control = one_thread();
    int left = 2;
    control.progress = [&](double, const char*) { return left-- > 0; };
    EXPECT_EQ(sky.rebuild(pixels_of(of, next), control).code, builder::ErrorCode::cancelled);
    require(sky.update(pixels_of(of, next), {0, 0, 1, 1}, one_thread()));
    EXPECT_EQ(bytes_of(sky), bytes_of(whole));
    // And what follows one that was refused.
    EXPECT_FALSE(sky.update(pixels_of(of, rgb), {of.width, 0, 1, 1}, one_thread()).ok());
    require(sky.update(pixels_of(of, rgb), {0, 0, 1, 1}, one_thread()));
    require(whole.rebuild(pixels_of(of, rgb), one_thread()));
    EXPECT_EQ(bytes_of(sky), bytes_of(whole));
}

TEST(Rebuild, BadTexelsAreMendedAndCounted) {
    const Case of{64, 32, ACDF_FILTER_BILINEAR};
    std::vector<float> rgb = moving_sky(of.width, of.height);
    const auto texel = [&](std::uint32_t x, std::uint32_t y) { return &rgb[3 * (y * of.width + x)]; };
    texel(5, 7)[1] = std::numeric_limits<float>::quiet_NaN();
    texel(5, 7)[2] = -1.0f;
    texel(9, 7)[0] = std::numeric_limits<float>::infinity();
    texel(60, 30)[2] = -0.5f;
    EnvironmentOptions options = options_of(of, 2 << 10);
    EnvironmentRebuilder sky = made(of, options);
    require(sky.rebuild(pixels_of(of, rgb), one_thread()));
    Environment built;
    require(environment(pixels_of(of, rgb), options, built));
    const BadTexels &bad = sky.bad_texels(), &other = built.bad_texels;
    EXPECT_EQ(bad.nan, 1u);
    EXPECT_EQ(bad.infinite, 1u);
    EXPECT_EQ(bad.negative, 1u);
    EXPECT_EQ(other.count(), bad.count());
    EXPECT_EQ(bad.x, other.x);
    EXPECT_EQ(bad.y, other.y);
    EXPECT_NEAR(sky.view().total(), built.accuracy.total, 2e-6 * built.accuracy.total);
    // Regions count anew.
    texel(5, 7)[1] = texel(5, 7)[2] = 1.0f;
    require(sky.update(pixels_of(of, rgb), {5, 7, 1, 1}, one_thread()));
    EXPECT_EQ(sky.bad_texels().count(), 2u);
    EXPECT_EQ(sky.bad_texels().x, 9);
    options.target.bad_texels = BadTexelPolicy::error;
    EnvironmentRebuilder strict = made(of, options);
    EXPECT_EQ(strict.rebuild(pixels_of(of, rgb), one_thread()).code, builder::ErrorCode::bad_source);
    EXPECT_TRUE(strict.empty());
    texel(9, 7)[0] = texel(60, 30)[2] = 1.0f;
    require(strict.rebuild(pixels_of(of, rgb), one_thread()));
    require(sky.update(pixels_of(of, rgb), {9, 7, 52, 24}, one_thread()));
    EXPECT_EQ(sky.bad_texels().count(), 0u);
    EXPECT_EQ(sky.bad_texels().x, -1);
}

TEST(Rebuild, BlackMaps) {
    const Case of{64, 32, ACDF_FILTER_BILINEAR};
    const std::vector<float> black(3 * 64 * 32, 0.0f), rgb = moving_sky(of.width, of.height);
    EnvironmentOptions options = options_of(of, 2 << 10);
    EnvironmentRebuilder sky = made(of, options);
    EXPECT_EQ(sky.rebuild(pixels_of(of, black), one_thread()).code, builder::ErrorCode::no_energy);
    EXPECT_TRUE(sky.empty());
    require(sky.rebuild(pixels_of(of, rgb), one_thread()));
    const Bytes last = bytes_of(sky);
    EXPECT_EQ(sky.rebuild(pixels_of(of, black), one_thread()).code, builder::ErrorCode::no_energy);
    EXPECT_EQ(bytes_of(sky), last);
    options.target.uniform_if_black = true;
    EnvironmentRebuilder even = made(of, options);
    require(even.rebuild(pixels_of(of, black), one_thread()));
    Environment built;
    require(environment(pixels_of(of, black), options, built));
    EXPECT_NEAR(even.view().total() / built.accuracy.total, 1.0, 1e-5);
    const float up[3] = {0.0f, 0.0f, 1.0f};
    EXPECT_NEAR(double{even.view().pdf(up)}, 0.25 / ACDF_PI, 1e-6);
    require(even.update(pixels_of(of, rgb), {0, 0, 64, 32}, one_thread()));
    EXPECT_EQ(even.view().total(), sky.view().total());
}

TEST(Rebuild, NoLightIsWithoutAPdf) {
    for (const AcdfFilter filter : {ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR}) {
        const Case of{64, 32, filter};
        std::vector<float> rgb(3 * 64 * 32, 1e-30f);
        rgb[3 * (10 * 64 + 20)] = 1e30f;
        EnvironmentRebuilder sky = made(of, options_of(of, 2 << 10));
        require(sky.rebuild(pixels_of(of, rgb), one_thread()));
        for (std::uint32_t y = 0; y < 32; ++y)
            for (std::uint32_t x = 0; x < 64; ++x) {
                const double theta = ACDF_PI * (y + 0.5) / 32, phi = ACDF_PI - 2.0 * ACDF_PI * (x + 0.5) / 64;
                const float direction[3] = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                                            static_cast<float>(std::sin(theta) * std::sin(phi)),
                                            static_cast<float>(std::cos(theta))};
                ASSERT_GT(sky.view().pdf(direction), 0.0f);
            }
    }
}

TEST(Rebuild, ReadsHalfFloatsAndStrides) {
    const Case of{kSkyWidth, kSkyHeight, ACDF_FILTER_NEAREST};
    const std::vector<float> rgb = sky();
    EnvironmentRebuilder packed = made(of, options_of(of, 2 << 10)), other = made(of, options_of(of, 2 << 10));
    require(packed.rebuild(pixels_of(of, rgb), one_thread()));
    // Rows from the foot, four channels, half floats.
    std::vector<std::uint16_t> halves(4 * rgb.size() / 3, 0x7E00);
    for (std::uint32_t y = 0; y < of.height; ++y)
        for (std::uint32_t x = 0; x < of.width; ++x)
            for (std::uint32_t k = 0; k < 3; ++k) {
                std::uint32_t bits;
                std::memcpy(&bits, &rgb[3 * (y * of.width + x) + k], sizeof bits);
                halves[4 * ((of.height - 1 - y) * of.width + x) + k] =
                    static_cast<std::uint16_t>(((bits >> 23 & 0xFFu) - 112u) << 10 | (bits >> 13 & 0x3FFu));
            }
    Pixels pixels = pixels_of(of, rgb);
    pixels.data = &halves[4 * (of.height - 1) * of.width];
    pixels.number = Number::float16;
    pixels.channels = 4;
    pixels.row_stride = -std::ptrdiff_t{8} * of.width;
    require(other.rebuild(pixels, one_thread()));
    EXPECT_EQ(bytes_of(other), bytes_of(packed));
    // Doubles, at an odd address.
    std::vector<unsigned char> doubles(8 * rgb.size() + 1);
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        const double value = double{rgb[i]};
        std::memcpy(&doubles[8 * i + 1], &value, sizeof value);
    }
    pixels = pixels_of(of, rgb);
    pixels.data = &doubles[1];
    pixels.number = Number::float64;
    require(other.rebuild(pixels, one_thread()));
    EXPECT_EQ(bytes_of(other), bytes_of(packed));
}

TEST(Rebuild, SmallMapsAndManyCells) {
    for (const auto& size :
         {std::pair<std::uint32_t, std::uint32_t>{1, 1}, {1, 7}, {5, 1}, {2, 1}, {3, 2}, {17, 5}})
        for (const AcdfFilter filter : {ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR}) {
            const Case of{size.first, size.second, filter};
            std::vector<float> rgb(std::size_t{3} * of.width * of.height);
            std::mt19937 random(4);
            for (float& value : rgb) value = static_cast<float>(1 + random() % 100);
            EnvironmentOptions options = options_of(of, 64 << 10);
            for (const Goal& goal : {Goal::of_budget(64 << 10), Goal::of_cells(1), Goal::of_cells(1000000)}) {
                options.goal = goal;
                EnvironmentRebuilder sky = made(of, options);
                require(sky.rebuild(pixels_of(of, rgb), one_thread()));
                Environment built;
                require(environment(pixels_of(of, rgb), options, built));
                EXPECT_NEAR(sky.view().total(), built.accuracy.total, 2e-6 * built.accuracy.total);
                EXPECT_NEAR(sky.relative_variance(), built.accuracy.relative_variance,
                            1e-4 + 0.02 * built.accuracy.relative_variance);
            }
        }
}

TEST(Rebuild, RefusesWhatItDoesNotMake) {
    EnvironmentOptions options;
    options.goal = Goal::of_budget(4096);
    EnvironmentRebuilder sky;
    const auto code = [&](Quality quality = Quality::fast, Projection projection = Projection::latlong,
                          std::uint32_t width = 64) {
        return EnvironmentRebuilder::make(width, 32, options, sky, quality, projection).code;
    };
    constexpr auto refused = builder::ErrorCode::invalid_argument;
    EXPECT_EQ(code(), builder::ErrorCode::none);
    EXPECT_EQ(code(Quality::fast, Projection::angular), refused);
    EXPECT_FALSE(sky.ready());
    EXPECT_EQ(code(Quality::fast, Projection::octahedral), refused); // not square
    EXPECT_EQ(code(Quality::fast, Projection::latlong, 0), refused);
    options.goal = Goal::of_variance(0.1);
    EXPECT_EQ(code(), refused);
    EXPECT_EQ(code(Quality::best), builder::ErrorCode::none);
    options.goal = Goal::of_budget(100);
    EXPECT_EQ(code(), builder::ErrorCode::out_of_reach);
    options.goal = Goal::of_budget(4096);
    options.target.bad_texels = BadTexelPolicy::clamp;
    EXPECT_EQ(code(), refused);
    options.target.bad_texels = BadTexelPolicy::zero;
    options.fit.fit = ACDF_FIT_CDF;
    EXPECT_EQ(code(), refused);
    options.fit.fit = ACDF_FIT_VARIANCE;
    options.codec = ACDF_CODEC_ZLIB;
    EXPECT_EQ(code(), refused);
    options.codec = ACDF_CODEC_NONE;
    const std::vector<float> rgb = moving_sky(64, 32);
    EXPECT_EQ(sky.rebuild(test::pixels_of(rgb, 64, 32)).code, refused); // empty
    EXPECT_EQ(code(), builder::ErrorCode::none);
    EXPECT_EQ(sky.rebuild(test::pixels_of(rgb, 32, 64)).code, refused);
    const Pixels right = test::pixels_of(rgb, 64, 32);
    for (const Region& region : {Region{0, 0, 0, 1}, Region{0, 0, 65, 1}, Region{64, 0, 1, 1}, Region{1, 31, 1, 2},
                                 Region{0xFFFFFFFF, 0, 2, 1}})
        EXPECT_EQ(sky.update(right, region).code, refused);
    Control control;
    control.threads = -1;
    EXPECT_EQ(sky.rebuild(right, control).code, refused);
    require(sky.rebuild(right));
    std::vector<float> large(rgb.size(), 3e38f);
    options.target.channels.weights = {1.0, 1.0, 1.0};
    EXPECT_EQ(code(), builder::ErrorCode::none);
    EXPECT_EQ(sky.rebuild(test::pixels_of(large, 64, 32)).code, builder::ErrorCode::bad_source);
}

TEST(Rebuild, InC) {
    const Case of{64, 32, ACDF_FILTER_BILINEAR};
    std::vector<float> rgb = moving_sky(of.width, of.height);
    EnvironmentRebuilder expected = made(of, options_of(of, 2 << 10));
    require(expected.rebuild(pixels_of(of, rgb), one_thread()));
    AcdfRebuildOptions options = {};
    options.width = of.width, options.height = of.height, options.budget = 2 << 10, options.bilinear = 1;
    AcdfRebuilder* sky = acdf_rebuilder_make(&options);
    ASSERT_NE(sky, nullptr);
    std::size_t size = 1;
    EXPECT_EQ(acdf_rebuilder_file(sky, &size), nullptr);
    EXPECT_EQ(size, 0u);
    EXPECT_EQ(acdf_rebuilder_view(sky).columns, 0u);
    AcdfFramePixels frame = {};
    frame.data = rgb.data(), frame.channels = 3;
    ASSERT_EQ(acdf_rebuilder_rebuild(sky, &frame, 1), 0) << acdf_rebuilder_message(sky);
    const std::uint8_t* file = acdf_rebuilder_file(sky, &size);
    EXPECT_EQ(Bytes(file, file + size), bytes_of(expected));
    EXPECT_EQ(acdf_rebuilder_relative_variance(sky), expected.relative_variance());
    const AcdfEnvironment view = acdf_rebuilder_view(sky);
    const AcdfDirectionSample a = acdf_environment_sample(&view, 0.4, 0.1), b = expected.view().sample(0.4, 0.1);
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    rgb[30] = 9.0f;
    require(expected.rebuild(pixels_of(of, rgb), one_thread()));
    const AcdfFrameRegion region = {10, 0, 1, 1}, wrong = {64, 0, 1, 1};
    ASSERT_EQ(acdf_rebuilder_update(sky, &frame, &region, 0), 0) << acdf_rebuilder_message(sky);
    file = acdf_rebuilder_file(sky, &size);
    EXPECT_EQ(Bytes(file, file + size), bytes_of(expected));
    EXPECT_EQ(acdf_rebuilder_update(sky, &frame, &wrong, 0), 1);
    EXPECT_NE(std::string(acdf_rebuilder_message(sky)), "");
    acdf_rebuilder_on_progress(
        sky, [](void*, double) { return 0; }, nullptr);
    EXPECT_EQ(acdf_rebuilder_rebuild(sky, &frame, 1), 5);
    acdf_rebuilder_on_progress(sky, nullptr, nullptr);
    EXPECT_EQ(acdf_rebuilder_rebuild(sky, &frame, 1), 0);
    acdf_rebuilder_free(sky);
    options.width = 0;
    sky = acdf_rebuilder_make(&options);
    EXPECT_EQ(acdf_rebuilder_rebuild(sky, &frame, 1), 1);
    EXPECT_NE(std::string(acdf_rebuilder_message(sky)), "");
    acdf_rebuilder_free(sky);
}

} // namespace
