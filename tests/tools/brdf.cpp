// acdf brdf and what else reads its files, as a user calls them.
#include "tests/inputs/sanitized.h"
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>

using namespace acdf;
using namespace acdf::test;
using Json = nlohmann::json;

namespace {

/// The report when small_file() is made.
std::string told;

/// A small file of a model, made once.
const std::string& small_file() {
    static const Folder folder;
    static const std::string path = folder / "ggx.acdf";
    static const Result made = run_acdf({"brdf", "ggx:alpha=0.4", "-o", path, "--budget", "12KiB", "--json"});
    told = made.out;
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_LT(Json::parse(made.out).at("relative_variance").get<double>(), 0.02);
    EXPECT_LE(Json::parse(made.out).at("bytes").get<std::size_t>(), 12u << 10);
    return path;
}

TEST(BrdfCommand, fileIsValidAndDescribesItself) {
    EXPECT_EQ(run_acdf({"validate", small_file()}).code, 0);
    const Json info = Json::parse(run_acdf({"info", "--json", small_file()}).out);
    EXPECT_EQ(info.at("kind"), "brdf");
    EXPECT_EQ(info.at("axes").size(), 4u);
    EXPECT_EQ(info.at("source").at("name"), "ggx:alpha=0.4");
    EXPECT_GT(info.at("cells").get<int>(), 100);
    EXPECT_EQ(info.at("axes")[2].at("resolution"), info.at("bins"));
}

// The budget holds for the stored bytes.
TEST(BrdfCommand, compressedFilesFillTheirBudget) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "the same code as with trees of their own";
    const Folder folder;
    const std::string path = folder / "a.acdf";
    const Result made =
        run_acdf({"brdf", "ggx:alpha=0.4", "-o", path, "--views", "8", "--budget", "9000", "--compress", "zlib"});
    ASSERT_EQ(made.code, 0) << made.err;
    const auto bytes = std::filesystem::file_size(path);
    EXPECT_LE(bytes, 9000u);
    EXPECT_GE(bytes, 8100u);
    EXPECT_NE(run_acdf({"info", path}).out.find("--budget 9000"), std::string::npos);
}

TEST(BrdfCommand, measureComparesWithOtherSamplers) {
    const Result measured = run_acdf({"measure", small_file(), "--against", "ggx:alpha=0.4", "--json"});
    ASSERT_EQ(measured.code, 0) << measured.err;
    const Json j = Json::parse(measured.out);
    for (const char* key : {"relative_variance", "relative_variance_median", "relative_variance_worst",
                            "relative_variance_full_cdf", "rms_pdf_error", "kl_divergence", "max_weight",
                            "support_violations", "bytes", "cells", "bins", "share_above_horizon"})
        EXPECT_TRUE(j.contains(key)) << key;
    EXPECT_EQ(j.at("support_violations"), 0);
    EXPECT_EQ(j.at("views"), 64);
    EXPECT_LT(j.at("relative_variance").get<double>(), 0.1 * j.at("relative_variance_cosine").get<double>());
    EXPECT_LE(j.at("relative_variance_median"), j.at("relative_variance_worst"));
    EXPECT_GT(j.at("share_above_horizon").get<double>(), 0.98);

    // One definition, one figure: the report when a file is made, the file's metadata, and the measurement agree.
    const Json made = Json::parse(told), held = Json::parse(run_acdf({"info", small_file(), "--json"}).out);
    for (const char* key : {"relative_variance", "relative_variance_median", "relative_variance_worst",
                            "rms_pdf_error", "kl_divergence", "max_weight", "share_above_horizon"}) {
        EXPECT_EQ(made.at(key), j.at(key)) << key;
        const double number = j.at(key);
        EXPECT_NEAR(held.at("accuracy").at(key).get<double>(), number, 1e-5 * number) << key;
    }
    const double noise = 100.0 * std::sqrt(j.at("relative_variance").get<double>() / 64.0);
    EXPECT_NEAR(j.at("noise_percent").at("64").get<double>(), noise, 1e-3 * noise);
}

// The hemisphere seen from the normal: every pixel of the disc is the reader's pdf of the direction above it.
TEST(BrdfCommand, plotsAHemisphere) {
    const Folder folder;
    constexpr int width = 48;
    const Result plotted = run_acdf(
        {"plot", small_file(), "-o", folder / "a.exr", "--view", "60,30", "--width", std::to_string(width)});
    ASSERT_EQ(plotted.code, 0) << plotted.err;
    const LoadedImage image = load_image(folder / "a.exr");
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(image.height, width);
    File file;
    ASSERT_TRUE(File::open(small_file().c_str(), file, acdf::with_curves()).ok());
    const auto radians = [](double degrees) { return degrees * ACDF_PI / 180.0; };
    const float wo[3] = {float(std::sin(radians(60)) * std::cos(radians(30))),
                         float(std::sin(radians(60)) * std::sin(radians(30))), float(std::cos(radians(60)))};
    double whole = 0.0;
    for (int y = 0; y < width; ++y)
        for (int x = 0; x < width; ++x) {
            const double a = 2.0 * (x + 0.5) / width - 1.0, b = 1.0 - 2.0 * (y + 0.5) / width, r = std::hypot(a, b);
            if (r >= 1.0) {
                EXPECT_EQ(*image.at(x, y), 0.0f);
                continue;
            }
            const double cosine = 1.0 - r * r, sine = std::sqrt(1.0 - cosine * cosine);
            const float wi[3] = {float(sine * a / r), float(sine * b / r), float(cosine)};
            const double p = file.brdf().pdf(wo, wi);
            EXPECT_NEAR(*image.at(x, y), p, 1e-4 * p) << x << ' ' << y;
            whole += p * 8.0 / (width * width);
        }
    EXPECT_NEAR(whole, 1.0, 0.1); // areas are as they are
    EXPECT_EQ(run_acdf({"plot", small_file(), "-o", folder / "b.png", "-q", "--width", "96"}).code, 0);
    EXPECT_GT(load_image(folder / "b.png").width, 96 + 2 * 20); // with its axes, and the legend
}

TEST(BrdfCommand, plotsAView) {
    const Folder folder;
    const Result plotted =
        run_acdf({"plot", small_file(), "-o", folder / "a.png", "--view", "60,30", "--width", "128"});
    ASSERT_EQ(plotted.code, 0) << plotted.err;
    EXPECT_GT(read_text(folder / "a.png").size(), 1000u);
    EXPECT_EQ(run_acdf({"plot", small_file(), "-o", folder / "b.png", "--view", "95"}).code, 2);
    EXPECT_EQ(run_acdf({"plot", small_file(), "-o", folder / "b.png", "--view", "10,"}).code, 2);
    write_bytes(folder / "sky.acdf", small_environment());
    EXPECT_EQ(run_acdf({"plot", folder / "sky.acdf", "-o", folder / "b.png", "--view", "10"}).code, 2);
}

TEST(BrdfCommand, samplesAndPdfsAreThoseOfTheReader) {
    acdf::File file;
    ASSERT_TRUE(acdf::File::open(small_file().c_str(), file, acdf::with_curves()).ok());
    const Result sampled = run_acdf({"sample", small_file(), "-n", "40", "--view", "50,20", "--sequence", "sobol"});
    ASSERT_EQ(sampled.code, 0) << sampled.err;
    const Result evaluated = run_acdf({"pdf", small_file(), "--view", "50,20"}, sampled.out);
    ASSERT_EQ(evaluated.code, 0) << evaluated.err;
    const double degree = std::acos(-1.0) / 180.0;
    const float wo[3] = {static_cast<float>(std::sin(50 * degree) * std::cos(20 * degree)),
                         static_cast<float>(std::sin(50 * degree) * std::sin(20 * degree)),
                         static_cast<float>(std::cos(50 * degree))};
    std::istringstream samples(sampled.out), pdfs(evaluated.out);
    std::string line;
    std::getline(samples, line);
    EXPECT_EQ(line, "u0,u1,x,y,z,pdf");
    int count = 0;
    for (; std::getline(samples, line); ++count) {
        double u0, u1, x, y, z, pdf, evaluated;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &u0, &u1, &x, &y, &z, &pdf), 6) << line;
        const acdf::DirectionSample s = file.brdf().sample(wo, u0, u1);
        EXPECT_EQ(static_cast<float>(x), s.direction[0]);
        EXPECT_EQ(static_cast<float>(pdf), s.pdf);
        ASSERT_TRUE(pdfs >> evaluated);
        EXPECT_EQ(static_cast<float>(evaluated), s.pdf);
    }
    EXPECT_EQ(count, 40);
    EXPECT_EQ(run_acdf({"sample", small_file(), "-n", "1"}).code, 1);
    EXPECT_EQ(run_acdf({"sample", small_file(), "-n", "1", "--view", "90"}).code, 2);
    EXPECT_EQ(run_acdf({"pdf", small_file(), "--normal", "0,0,1"}, "0 0 1\n").code, 1);
}

/// A BRDF of 6 x 8 x 12 x 16 (theta_o, phi_o, theta_h, phi_h): a highlight of other widths along x and y.
std::string anisotropic_npy() {
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (6, 8, 12, 16), }";
    header.resize(117, ' ');
    header += '\n';
    std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + std::string("\x76\x00", 2) + header;
    for (int view = 0; view < 6 * 8; ++view)
        for (int i = 0; i < 12; ++i)
            for (int k = 0; k < 16; ++k) {
                const double theta = (i + 0.5) / 12 * 1.5708, phi = (k + 0.5) / 16 * 6.2832, t = std::tan(theta);
                const double x = t * std::cos(phi) / 0.5, y = t * std::sin(phi) / 0.2;
                const auto value = static_cast<float>(0.05 + 2.0 * std::exp(-x * x - y * y));
                bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
            }
    return bytes;
}

TEST(BrdfCommand, curvesOfTwoSegmentsAreTaken) {
    const Folder folder;
    const Result made = run_acdf({"brdf", "lambert", "-o", folder / "a.acdf", "--views", "4", "--fit", "uniform",
                                  "--knots", "10x2", "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(Json::parse(made.out).at("cells"), 4 * 10 * 2);
}

TEST(BrdfCommand, anisotropicTablesAreFollowed) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "test_brdf and test_builder make such files";
    const Folder folder;
    write_text(folder / "a.npy", anisotropic_npy());
    const Result made = run_acdf({"brdf", folder / "a.npy", "-o", folder / "a.acdf", "--views", "4x8", "--budget",
                                  "128KiB", "--json", "-q"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Json report = Json::parse(made.out);
    EXPECT_LT(report.at("relative_variance").get<double>(), 0.05);
    acdf::File file;
    ASSERT_TRUE(acdf::File::open((folder / "a.acdf").c_str(), file, acdf::with_curves()).ok());
    EXPECT_EQ(file.axis(3).resolution, 8u);
    const float up[3] = {0.0f, 0.0f, 1.0f};
    const float along[3] = {std::sin(0.6f), 0.0f, std::cos(0.6f)},
                across[3] = {0.0f, std::sin(0.6f), std::cos(0.6f)};
    EXPECT_GT(file.brdf().pdf(up, along), 1.5f * file.brdf().pdf(up, across)); // the highlight is wider along x
}

TEST(BrdfCommand, sameInputGivesTheSameBytes) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "tests/same_bytes.sh runs sanitized programs so";
    const Folder folder;
    for (const char* name : {"a.acdf", "b.acdf"})
        ASSERT_EQ(run_acdf({"brdf", "lambert", "-o", folder / name, "--cells", "64", "--views", "6"}).code, 0);
    EXPECT_EQ(read_text(folder / "a.acdf"), read_text(folder / "b.acdf"));
}

TEST(BrdfCommand, mistakesAreReportedInOneLine) {
    const Folder folder;
    const std::string out = folder / "out.acdf";
    write_text(folder / "bad.binary", "not a BRDF");
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"brdf", folder / "bad.binary", "-o", out},
          {"brdf", folder / "missing.bsdf", "-o", out},
          {"brdf", "ggx:alpha=nothing", "-o", out},
          {"brdf", "ggx:alpha=0.4", "-o", out, "--budget", "900"}}) {
        const Result result = run_acdf(arguments);
        EXPECT_EQ(result.code, 1) << arguments[1];
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
    }
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--views", "1"},
                                                 {"--views", "8x2"},
                                                 {"--views", "eight"},
                                                 {"--fit", "cdf", "--budget", "64KiB"},
                                                 {"--knots", "10x30"},
                                                 {"--fit=cdf", "--knots=10"},
                                                 {"--cells", "64", "--budget", "64KiB"},
                                                 {"--diffuse-floor", "1"}}) {
        std::vector<std::string> arguments{"brdf", "lambert", "-o", out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(run_acdf(arguments).code, 2) << more[0] << " " << more[1];
    }
    EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
