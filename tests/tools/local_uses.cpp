// acdf info, validate, sample, pdf and plot of local environments, as a user runs them.
#include "build/accuracy/cells.h"
#include "tests/inputs/local_maps.h"
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"
#include "tools/plot/local.h"

#include <acdf/curves/curves.h>
#include <nlohmann/json.hpp>

#include <sstream>

namespace acdf::test {
namespace {

using acdf_test::length;
using nlohmann::json;

const std::string shared = ACDF_TEST_DIR "/golden/v1.0/local.acdf",
                  grid = ACDF_TEST_DIR "/golden/v1.0/local_grid.acdf",
                  environment = ACDF_TEST_DIR "/golden/v1.0/one_texel.acdf";

class LocalCommands : public testing::Test {
protected:
    Folder folder;
    File file;

    void SetUp() override {
        const Status status = File::open(shared.c_str(), file);
        ASSERT_TRUE(status.ok()) << status.message;
    }

    void expect_refused(const std::vector<std::string>& arguments, int code, const std::string& part) {
        const Result result = run_acdf(arguments, "0 0 1\n");
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_EQ(folder.entries(), 0u);
    }
};

std::vector<std::vector<double>> rows_of(const std::string& csv) {
    std::vector<std::vector<double>> rows;
    std::istringstream in(csv);
    std::string line, field;
    std::getline(in, line); // names
    while (std::getline(in, line)) {
        rows.emplace_back();
        for (std::istringstream fields(line); std::getline(fields, field, ',');)
            rows.back().push_back(std::stod(field));
    }
    return rows;
}

TEST_F(LocalCommands, ListsEndWithTheirWord) {
    const Result last = run_acdf({"sample", shared, "-n", "3", "--normal", "0,0.6,0.8"});
    EXPECT_EQ(last.code, 0) << last.err;
    for (const std::vector<std::string>& list : std::vector<std::vector<std::string>>{
             {"--normal", "0,0.6,0.8"}, {"--normal=0,0.6,0.8"}, {"--normal", "0", "0.6", "0.8"}}) {
        std::vector<std::string> arguments = {"sample", "-n", "3"};
        arguments.insert(arguments.end(), list.begin(), list.end());
        arguments.push_back(shared);
        EXPECT_EQ(run_acdf(arguments).out, last.out) << list.back();
    }
    expect_refused({"sample", "-n", "1", "--normal", "0,1", shared}, 2, "--normal");
    expect_refused({"table", "--names", "a,b", shared, "-o", folder / "out.acdf"}, 1, shared); // is no array
}

TEST_F(LocalCommands, InfoReportsWhatBinsShare) {
    const json report = json::parse(run_acdf({"info", "--json", shared}).out);
    EXPECT_EQ(report["kind"], "local");
    EXPECT_EQ(report["bins"], 18);
    EXPECT_EQ(report["local"],
              (json{{"normals", "2"}, {"bins_stored", 17}, {"tiles", 15}, {"rows", 5}, {"cosine_share", 0.0}}));
    ASSERT_EQ(report["axes"].size(), 3u);
    EXPECT_EQ(report["axes"][2]["name"], "normal");
    EXPECT_EQ(report["axes"][2]["role"], "indexed");
    const std::string text = run_acdf({"info", shared}).out;
    for (const char* part : {"local, format", "17 stored; 15 tiles shared by 5 rows; cosine share 0"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST_F(LocalCommands, InfoOfBinsWithTreesOfTheirOwn) {
    const json report = json::parse(run_acdf({"info", "--json", grid}).out);
    EXPECT_EQ(report["local"]["normals"], "3x2");
    EXPECT_EQ(report["local"]["bins_stored"], 5);
    EXPECT_EQ(report["local"]["tiles"], 0);
    EXPECT_NE(run_acdf({"info", grid}).out.find("--normals 3x2, 5 stored; a tree each"), std::string::npos);
    EXPECT_FALSE(json::parse(run_acdf({"info", "--json", environment}).out).contains("local"));
}

TEST_F(LocalCommands, ValidateFindsWhatIsWrongWithRows) {
    EXPECT_EQ(run_acdf({"validate", shared, grid}).code, 0);
    std::string bytes = read_text(shared);
    const auto* chunks = reinterpret_cast<const AcdfChunk*>(&file.header() + 1);
    for (std::uint32_t i = 0; i < file.header().chunk_count; ++i)
        if (chunks[i].type == ACDF_CHUNK_NORMALS) bytes[chunks[i].offset + 12] = 9; // what is reserved
    const Result result = run_acdf({"validate", "-"}, bytes);
    EXPECT_EQ(result.code, 3);
    EXPECT_NE(result.out.find("error 4001"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("error 6039"), std::string::npos) << result.out;
}

TEST_F(LocalCommands, SamplesAreThoseOfTheReader) {
    for (const char* sequence : {"random", "stratified", "sobol"}) {
        const Result result =
            run_acdf({"sample", shared, "-n", "50", "--normal", "-1,2,0.5", "--sequence", sequence});
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.out.rfind("u0,u1,x,y,z,pdf\n", 0), 0u);
        const auto rows = rows_of(result.out);
        ASSERT_EQ(rows.size(), 50u);
        const float n[3] = {-1.0f, 2.0f, 0.5f};
        for (const auto& row : rows) {
            const DirectionSample s = file.local().sample(n, row[0], row[1]);
            for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(static_cast<float>(row[2 + k]), s.direction[k]);
            EXPECT_EQ(static_cast<float>(row[5]), s.pdf);
        }
    }
}

TEST_F(LocalCommands, PdfOfSamplesIsTheirPdf) {
    const Result samples = run_acdf({"sample", shared, "-n", "40", "--normal", "0.1,0.2,0.3"});
    const Result csv = run_acdf({"pdf", shared, "--normal", "0.1,0.2,0.3", "--csv"}, samples.out);
    ASSERT_EQ(csv.code, 0) << csv.err;
    EXPECT_EQ(csv.out.rfind("x,y,z,pdf\n", 0), 0u);
    const auto sampled = rows_of(samples.out), told = rows_of(csv.out);
    ASSERT_EQ(sampled.size(), told.size());
    for (std::size_t i = 0; i < sampled.size(); ++i) EXPECT_EQ(sampled[i][5], told[i][3]);
}

TEST_F(LocalCommands, PdfReadsANormalFromEachLine) {
    const Result result = run_acdf({"pdf", shared}, "0 0 1  0 0 1\n1,0,0,-2,1,1 # and a remark\n0 0 1 0 0 0\n");
    ASSERT_EQ(result.code, 0) << result.err;
    std::istringstream lines(result.out);
    const float up[3] = {0, 0, 1}, x[3] = {1, 0, 0}, side[3] = {-2, 1, 1};
    for (const float expected : {file.local().pdf(up, up), file.local().pdf(side, x), 0.0f}) {
        std::string line;
        ASSERT_TRUE(std::getline(lines, line));
        EXPECT_EQ(std::stof(line), expected);
    }
    const Result named = run_acdf({"pdf", shared, "--csv"}, "nx,ny,nz,weight,x,y,z\n-2,1,1,7,1,0,0\n");
    ASSERT_EQ(named.code, 0) << named.err;
    EXPECT_EQ(named.out.rfind("x,y,z,nx,ny,nz,pdf\n1,0,0,-2,1,1,", 0), 0u) << named.out;
    EXPECT_EQ(run_acdf({"pdf", shared, "--normalize"}, "0 0 5 0 0 1\n").out,
              run_acdf({"pdf", shared}, "0 0 1 0 0 1\n").out);
    const Result bad = run_acdf({"pdf", shared}, "0 0 1\n");
    EXPECT_EQ(bad.code, 1);
    EXPECT_NE(bad.err.find("line 1: expected 6 numbers x y z nx ny nz, found 3"), std::string::npos) << bad.err;
}

TEST_F(LocalCommands, WhatDoesNotFitIsRefused) {
    expect_refused({"sample", shared, "-n", "1"}, 1, "--normal X,Y,Z");
    expect_refused({"sample", shared, "-n", "1", "--normal", "0,0,0"}, 1, "zero or not finite");
    expect_refused({"sample", shared, "-n", "1", "--normal", "nan,0,1"}, 1, "zero or not finite");
    expect_refused({"sample", shared, "-n", "1", "--normal", "0,1"}, 2, "--normal");
    expect_refused({"sample", shared, "-n", "1", "--normal", "0,0,1", "--at", "1"}, 1, "--at");
    expect_refused({"sample", grid, "-n", "1", "--normal", "1,0,-0.1"}, 1, "no light reaches this normal");
    expect_refused({"sample", environment, "-n", "1", "--normal", "0,0,1"}, 1, "not a local environment");
    expect_refused({"pdf", environment, "--normal", "0,0,1"}, 1, "not a local environment");
    expect_refused({"plot", shared, "-o", folder / "x.exr"}, 1, "--normal X,Y,Z");
    expect_refused({"plot", shared, "-o", folder / "x.png", "--projection", "hemisphere"}, 2, "BRDF");
    expect_refused({"plot", environment, "-o", folder / "x.png", "--normal", "0,0,1"}, 1,
                   "not a local environment");
}

// ---- plots ---------------------------------------------------------------------------------------------

TEST_F(LocalCommands, PlotHoldsTheReadersPdfs) {
    const std::string exr = folder / "up.exr";
    for (const std::string& path : {shared, grid}) {
        const Result result = run_acdf({"plot", path, "-f", "-o", exr, "--width", "60", "--normal", "-1,2,0.5"});
        ASSERT_EQ(result.code, 0) << result.err;
        const LoadedImage image = load_image(exr);
        File plotted;
        ASSERT_TRUE(File::open(path.c_str(), plotted, acdf::with_curves()).ok());
        const float n[3] = {-1.0f, 2.0f, 0.5f};
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 60; ++x) {
                float d[3];
                latlong_direction(60, 30, x, y, d);
                EXPECT_NEAR(image.at(x, y)[0], plotted.local().pdf(n, d), 1e-5 * image.at(x, y)[0])
                    << x << ' ' << y;
            }
    }
}

// Without a normal: those of six axes, as pictures of their own show them in the same range.
TEST_F(LocalCommands, PlotShowsSeveralNormals) {
    const std::string all = folder / "all.png", one = folder / "one.png";
    const std::vector<std::string> same = {"--width", "64", "--no-legend", "--range", "1e-4:10", "-q"};
    const auto plot = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), same.begin(), same.end());
        const Result result = run_acdf(arguments);
        ASSERT_EQ(result.code, 0) << result.err;
    };
    plot({"plot", shared, "-o", all});
    const LoadedImage six = load_image(all);
    constexpr int width = 64, height = 32, gap = 12, label = 24;
    ASSERT_EQ(six.width, 3 * width + 2 * gap);
    ASSERT_EQ(six.height, 2 * (height + label));
    const char* normals[] = {"0,0,1", "1,0,0", "0,1,0", "0,0,-1", "-1,0,0", "0,-1,0"};
    for (int i = 0; i < 6; ++i) {
        plot({"plot", shared, "-f", "-o", one, "--normal", normals[i]});
        const LoadedImage image = load_image(one);
        const int x = i % 3 * (width + gap), y = i / 3 * (height + label) + label;
        for (int row = 0; row < height; ++row)
            EXPECT_TRUE(std::equal(image.at(0, row), image.at(0, row) + 3 * width, six.at(x, y + row))) << i;
    }
}

TEST_F(LocalCommands, PlotShowsTheHorizon) {
    const std::string png = folder / "up.png";
    const Result result =
        run_acdf({"plot", shared, "-o", png, "--width", "64", "--no-legend", "--no-knots", "--normal", "0,0,3"});
    ASSERT_EQ(result.code, 0) << result.err;
    const LoadedImage image = load_image(png);
    ASSERT_EQ(image.height, 32);
    for (int x = 0; x < 64; ++x)
        for (int c = 0; c < 3; ++c) {
            EXPECT_GT(image.at(x, 15)[c], 0.95f); // the equator runs between rows 15 and 16
            EXPECT_GT(image.at(x, 16)[c], 0.95f);
        }
    EXPECT_LT(image.at(5, 8)[2], 0.95f);
}

TEST(PlotLocal, HorizonIsWhereTheCosineVanishes) {
    for (const auto layout : {build::Layout::latlong, build::Layout::angular}) {
        const build::Map map = tools::plot_map(layout, 120);
        const tools::Normal n = {0.5f, -1.0f, 0.7f};
        const std::vector<float> opacity = tools::horizon_opacity(n, map);
        int on = 0;
        for (int y = 0; y < map.height; ++y)
            for (int x = 0; x < map.width; ++x) {
                float d[3];
                if (!tools::pixel_direction(map, x + 0.5, y + 0.5, d)) continue;
                const double cosine = acdf_test::dot(n.data(), d) / length(n.data());
                const float sampled = opacity[std::size_t(y * map.width + x)];
                EXPECT_TRUE(sampled == 0.0f || std::abs(cosine) < 0.25) << x << ' ' << y;
                EXPECT_TRUE(sampled > 0.5f || std::abs(cosine) >= 0.005) << x << ' ' << y;
                on += sampled > 0.5f;
            }
        EXPECT_GT(on, 100);
        EXPECT_LT(on, 600);
    }
}

// Twenty pixels a grid step: each cell's first column and row of pixels, but for the edges of the picture.
TEST(PlotLocal, KnotsAreTheBordersOfCells) {
    constexpr int scale = 20;
    File file;
    ASSERT_TRUE(File::open(shared.c_str(), file).ok());
    const AcdfEnvironment env = file.local().data().environment;
    const build::Map map = tools::plot_map(build::Layout::latlong, static_cast<int>(env.columns) * scale);
    const auto opacity = tools::knot_opacity({VisibleLocalView(file.local()), {0.0f, 0.0f, 1.0f}}, map);
    const double stretch = map.height / (double(env.rows) * scale);
    std::uint32_t borders = 0;
    const std::uint32_t tiles = static_cast<std::uint32_t>(build::tile_boxes(file).size());
    for (std::uint32_t t = 0; t < tiles; ++t)
        build::for_each_tile_cell(file, t, [&](const build::Cell& cell) {
            const int x = static_cast<int>(cell.range[0].low) * scale;
            const int y = static_cast<int>(stretch * scale * (0.5 * (cell.range[1].low + cell.range[1].high)));
            const std::size_t at = std::size_t(y) * std::size_t(map.width) + std::size_t(x);
            EXPECT_GE(opacity[at], x > 0 ? 0.9f : 0.0f) << x << ' ' << y;
            EXPECT_EQ(opacity[at + scale / 2], 0.0f) << x << ' ' << y; // inside
            borders += x > 0;
        });
    EXPECT_GT(borders, 40u);
}

} // namespace
} // namespace acdf::test
