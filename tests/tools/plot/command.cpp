// `acdf plot` as a user runs it.
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"
#include "tools/plot/legend.h"

#include <algorithm>
#include <cmath>

namespace acdf::test {
namespace {

class PlotCommand : public testing::Test {
protected:
    Folder folder;
    std::string file = folder / "sky.acdf", png = folder / "sky.png", exr = folder / "sky.exr";

    void SetUp() override { write_bytes(file, small_environment()); }

    Result plot(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "plot");
        return run_acdf(arguments);
    }
    void expect_refused(const std::vector<std::string>& arguments, int code, const std::string& part) {
        const std::size_t entries = folder.entries();
        const Result result = plot(arguments);
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(folder.entries(), entries); // neither an output nor a temporary file
    }
};

TEST_F(PlotCommand, WritesAPictureOfTheSizeAskedFor) {
    ASSERT_EQ(plot({file, "-o", png, "--width", "120", "--no-legend"}).code, 0);
    LoadedImage image = load_image(png);
    EXPECT_EQ(image.width, 120);
    EXPECT_EQ(image.height, 60);
    EXPECT_EQ(image.channels, 3);
    EXPECT_TRUE(!image.floating && image.sample_bytes == 1);

    ASSERT_EQ(plot({file, "-o", png, "-f", "--width", "120", "--no-legend", "--projection", "angular"}).code, 0);
    image = load_image(png);
    EXPECT_EQ(image.width, 120);
    EXPECT_EQ(image.height, 120);
    EXPECT_EQ(image.at(0, 0)[0], 1.0f); // outside of the disc

    ASSERT_EQ(plot({file, "-o", png, "-f", "--width", "120"}).code, 0);
    image = load_image(png);
    const tools::LegendLayout layout = tools::legend_layout(120, 60);
    EXPECT_EQ(image.width, layout.width);
    EXPECT_EQ(image.height, layout.height);

    ASSERT_EQ(plot({file, "-o", png, "-f", "--no-legend"}).code, 0); // a grid of 8 x 4 is enlarged
    EXPECT_EQ(load_image(png).width, 512);
}

TEST_F(PlotCommand, ExrHoldsTheReadersPdfs) {
    ASSERT_EQ(plot({file, "-o", exr, "--width", "50", "--projection", "latlong"}).code, 0);
    const StoredEnvironment stored(small_environment());
    LoadedImage image = load_image(exr);
    ASSERT_EQ(image.width, 50);
    ASSERT_EQ(image.height, 25);
    ASSERT_EQ(image.channels, 1);
    for (int y = 0; y < 25; ++y)
        for (int x = 0; x < 50; ++x) {
            float direction[3];
            latlong_direction(50, 25, x, y, direction);
            if (y == 12) continue; // theta = pi / 2 is a knot
            ASSERT_EQ(*image.at(x, y), stored.view().pdf(direction)) << x << "," << y;
        }
    ASSERT_EQ(plot({file, "-o", exr, "-f", "--width", "50", "--projection", "angular"}).code, 0);
    image = load_image(exr);
    ASSERT_EQ(image.height, 50);
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 50; ++x) {
            float direction[3];
            const bool shown = angular_direction(50, x, y, direction);
            ASSERT_EQ(*image.at(x, y), shown ? stored.view().pdf(direction) : 0.0f) << x << "," << y;
        }
}

TEST_F(PlotCommand, ExrDependsOnNothingButThePdf) {
    ASSERT_EQ(plot({file, "-o", exr, "--width", "32"}).code, 0);
    EXPECT_EQ(load_image(exr).date, "");
    const std::string first = read_text(exr);
    ASSERT_EQ(plot({file, "-o", exr, "-f", "--width", "32"}).code, 0);
    EXPECT_EQ(read_text(exr), first);
}

// 60,000 rows that share one curve of 60,000 columns: half a megabyte, and too many cells to visit one by one.
TEST_F(PlotCommand, CountsTheCellsOfSharedCurvesWithoutVisitingThem) {
    constexpr std::uint32_t n = 60000;
    compress::Curve curve;
    for (std::uint32_t i = 1; i < n; ++i) curve.knots.push_back(i);
    curve.probability.assign(n, 1.0 / n);
    compress::Cascade cascade;
    cascade.curves = {curve, curve};
    cascade.curves[0].axis = 1;
    cascade.curves[0].children.assign(n, 1);
    cascade.roots = {0};
    write_bytes(file, compress::store(compress::encode_tree(cascade), compress::environment_description(n, n)));
    const Result result = plot({file, "-o", png, "--width", "64"});
    ASSERT_EQ(result.code, 0) << result.err;
    const std::string note = load_image(png).description;
    EXPECT_NE(note.find("3600000000 cells"), std::string::npos) << note;
}

TEST_F(PlotCommand, OfAProbeShowsItsOwnPdf) {
    std::vector<float> rgb(16 * 8 * 3);
    for (std::size_t i = 0; i < 16 * 8; ++i)
        for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = static_cast<float>(1 + (i * 37) % 23);
    const std::string probe = folder / "probe.exr";
    write_rgb(probe, 16, 8, rgb);
    const Result result = plot({probe, "--probe-projection", "latlong", "-o", exr, "--width", "16"});
    ASSERT_EQ(result.code, 0) << result.err;
    const compress::Target target = compress::environment_target(rgb.data(), 16, 8, {});
    const double total = compress::integral(target);
    const LoadedImage image = load_image(exr);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
            const auto row = static_cast<std::uint32_t>(y), column = static_cast<std::uint32_t>(x);
            const double expected = static_cast<double>(target.row(row)[column]) / total;
            ASSERT_NEAR(*image.at(x, y), expected, 1e-5 * expected) << x << "," << y;
        }
}

TEST_F(PlotCommand, ShowsKnotsUnlessSwitchedOff) {
    ASSERT_EQ(plot({file, "-o", png, "--width", "128", "--no-legend", "--no-knots"}).code, 0);
    const LoadedImage plain = load_image(png);
    ASSERT_EQ(plot({file, "-o", png, "-f", "--width", "128", "--no-legend"}).code, 0);
    const LoadedImage knots = load_image(png);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x) {
            const bool same = std::equal(plain.at(x, y), plain.at(x, y) + 3, knots.at(x, y));
            const bool border = y == 32 || (x == 64 && y < 32);
            ASSERT_EQ(same, !border) << x << "," << y;
        }
}

TEST_F(PlotCommand, RangeSetsTheColours) {
    const auto corner = [&](const char* range) {
        EXPECT_EQ(plot({file, "-o", png, "-f", "--width", "64", "--no-legend", "--range", range}).code, 0);
        const LoadedImage image = load_image(png);
        return std::vector<float>(image.at(3, 3), image.at(3, 3) + 3);
    };
    const std::vector<float> low = corner("10:100"), high = corner("1e-6:1e-5");
    EXPECT_GT(low[2], low[0]); // violet: below the range
    EXPECT_GT(high[0], 0.7f);  // red: above it
    EXPECT_LT(high[2], 0.2f);
}

TEST_F(PlotCommand, SaysTheRangeItChose) {
    const Result result = plot({file, "-o", png});
    EXPECT_EQ(result.code, 0);
    EXPECT_NE(result.err.find("colours span 0.02:0.5 sr^-1"), std::string::npos) << result.err;
    const std::string note = load_image(png).description;
    EXPECT_NE(note.find("sky.acdf, variance fit, 3 cells"), std::string::npos) << note;
    EXPECT_NE(note.find("relative variance 0.125"), std::string::npos) << note;
    EXPECT_EQ(plot({file, "-o", png, "-f", "-q"}).err, "");
}

TEST_F(PlotCommand, WritesTheSameBytesToStdoutAndFromStdin) {
    ASSERT_EQ(plot({file, "-o", png, "--no-legend"}).code, 0);
    const std::vector<std::uint8_t> bytes = small_environment();
    const Result piped = run_acdf({"plot", "-", "-o", "-", "--no-legend", "-q"}, {bytes.begin(), bytes.end()});
    ASSERT_EQ(piped.code, 0) << piped.err;
    EXPECT_EQ(piped.out.compare(1, 3, "PNG"), 0);
    const LoadedImage a = load_image(png);
    write_text(png, piped.out);
    EXPECT_EQ(load_image(png).values, a.values);
    const Result again = run_acdf({"plot", "-", "-o", "-", "--no-legend", "-q"}, {bytes.begin(), bytes.end()});
    EXPECT_EQ(again.out, piped.out);
}

TEST_F(PlotCommand, RecognisesAFileByItsFirstBytes) {
    const std::string renamed = folder / "sky.bin";
    write_bytes(renamed, small_environment());
    EXPECT_EQ(plot({renamed, "-o", png, "--width", "64"}).code, 0);
}

TEST_F(PlotCommand, OverwritesOnlyWhenForced) {
    write_text(png, "precious");
    expect_refused({file, "-o", png}, 1, "--force");
    EXPECT_EQ(read_text(png), "precious");
    EXPECT_EQ(plot({file, "-o", png, "--force", "--width", "64"}).code, 0);
    EXPECT_EQ(load_image(png).sample_bytes, 1);
    expect_refused({png, "-o", png, "--force"}, 1, "same file");
}

TEST_F(PlotCommand, RefusesHostileInputs) {
    const std::vector<std::uint8_t> good = small_environment();
    expect_refused({folder / "absent.acdf", "-o", png}, 1, "absent.acdf");
    expect_refused({folder / "absent.hdr", "-o", png}, 1, "absent.hdr");
    expect_refused({folder / "", "-o", png}, 1, "folder");
    const std::string bad = folder / "bad.acdf";
    for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{64}, good.size() - 1}) {
        write_bytes(bad, {good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)});
        expect_refused({bad, "-o", png}, 1, "bad.acdf");
    }
    const std::string text = folder / "text.hdr";
    write_text(text, "#?RADIANCE\nthis is not a picture\n");
    expect_refused({text, "-o", png}, 1, "text.hdr");
    write_text(text, "");
    expect_refused({text, "-o", png}, 1, "text.hdr");
    const std::string black = folder / "black.exr";
    write_rgb(black, 16, 8, std::vector<float>(16 * 8 * 3, 0.0f));
    expect_refused({black, "--probe-projection", "latlong", "-q", "-o", png}, 1, "black");
    expect_refused({file, "-o", folder / "none/sky.png"}, 1, "does not exist");
}

TEST_F(PlotCommand, RefusesWrongUsage) {
    expect_refused({"-o", png}, 2, "FILE");
    expect_refused({file, "-o", folder / "sky.jpg"}, 2, ".png");
    expect_refused({file, "-o", folder / "sky"}, 2, ".png");
    expect_refused({file, "-o", png, "--range", "1:0"}, 2, "--range");
    expect_refused({file, "-o", png, "--range", "abc"}, 2, "--range");
    expect_refused({file, "-o", png, "--width", "0"}, 2, "--width");
    expect_refused({file, "-o", png, "--width", "-64"}, 2, "--width");
    expect_refused({file, "-o", png, "--width", "1000000"}, 2, "--width");
    expect_refused({file, "-o", png, "--projection", "mercator"}, 2, "--projection");
}

} // namespace
} // namespace acdf::test
