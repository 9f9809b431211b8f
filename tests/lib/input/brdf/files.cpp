// Opening BRDFs by name: how kinds of files are recognised, tables of numbers, and real measurements.
#include "input/brdf/table.h"
#include "tests/inputs/folder.h"
#include "tests/inputs/paths.h"
#include "tests/lib/input/brdf/brdf.h"

#include <algorithm>
#include <filesystem>

namespace {

using namespace acdf::input;
using acdf::test::at_angles;
using acdf::test::Bytes;
using acdf::test::Direction;
using acdf::test::Folder;
using acdf::test::kPi;
using acdf::test::mean_of;
using acdf::test::random_direction;
using acdf::test::RglParts;
using acdf::test::rho;
using acdf::test::turned;
using acdf::test::write_text;

std::string text_of(const Bytes& bytes) { return std::string(bytes.begin(), bytes.end()); }

NpyArray table_of(const std::vector<std::uint32_t>& shape) {
    NpyArray table;
    table.shape = shape;
    std::size_t count = 1;
    for (const std::uint32_t n : shape) count *= n;
    for (std::size_t i = 0; i < count; ++i) table.values.push_back(static_cast<float>(1 + i * 7919 % 101));
    return table;
}

Direction reflected(const Direction& wo, const Direction& h) {
    const double dot = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2];
    return {2.0 * dot * h[0] - wo[0], 2.0 * dot * h[1] - wo[1], 2.0 * dot * h[2] - wo[2]};
}

TEST(InputBrdfNpy, CentresAndWhatLiesBetween) {
    const NpyArray table = table_of({3, 4, 5, 8});
    const auto brdf = brdf_of_table("t", table);
    EXPECT_FALSE(brdf->isotropic);
    const auto value = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
        return double(table.values[((i * 4 + j) * 5 + k) * 8 + l]);
    };
    // view at the centre (0, j), half-vector at the centre (0, l): 15 and 9 degrees
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t l = 0; l < 8; ++l) {
            const Direction wo = at_angles(kPi / 12.0, (double(j) + 0.5) * kPi / 2.0);
            const Direction h = at_angles(kPi / 20.0, (double(l) + 0.5) * kPi / 4.0);
            EXPECT_NEAR(rho(*brdf, wo, reflected(wo, h))[1], value(0, j, 0, l), 1e-9);
        }
    // Halfway between columns 7 and 0, and between views 0 and 1.
    const Direction wo = at_angles(kPi / 6.0, kPi / 4.0), h = at_angles(kPi / 20.0, 0.0);
    EXPECT_NEAR(rho(*brdf, wo, reflected(wo, h))[0],
                0.25 * (value(0, 0, 0, 7) + value(0, 0, 0, 0) + value(1, 0, 0, 7) + value(1, 0, 0, 0)), 1e-9);
    // Beyond the first centre of theta_o and theta_h: constant.
    const Direction steep = at_angles(0.01, kPi / 4.0), pole = at_angles(0.02, kPi / 8.0);
    EXPECT_NEAR(rho(*brdf, steep, reflected(steep, pole))[0], value(0, 0, 0, 0), 1e-9);
}

TEST(InputBrdfNpy, OnePhiMeansIsotropic) {
    const auto brdf = brdf_of_table("t", table_of({3, 1, 5, 8}));
    EXPECT_TRUE(brdf->isotropic);
    EXPECT_FALSE(brdf->mirror);
    std::mt19937_64 random(1);
    for (int i = 0; i < 200; ++i) {
        const Direction wo = random_direction(random), wi = random_direction(random);
        const double a = rho(*brdf, wo, wi)[2];
        EXPECT_NEAR(rho(*brdf, turned(wo, 2.2), turned(wi, 2.2))[2], a, 1e-9 * a);
    }
    NpyArray same = table_of({3, 1, 5, 8});
    for (std::size_t i = 0; i < same.values.size(); ++i)
        same.values[i] = same.values[i / 8 * 8 + std::min(i % 8, 7 - i % 8)];
    EXPECT_TRUE(brdf_of_table("t", same)->mirror);
}

std::string npy(const std::string& shape, const std::vector<float>& values) {
    std::string dict = "{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + ", }";
    while ((10 + dict.size() + 1) % 64 != 0) dict += ' ';
    dict += '\n';
    std::string file("\x93NUMPY\x01\x00", 8);
    file += static_cast<char>(dict.size() & 0xFF);
    file += static_cast<char>(dict.size() >> 8);
    file += dict;
    file.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    return file;
}

TEST(InputBrdfNpy, FilesWithBadNumbers) {
    const Folder folder;
    const std::string path = folder / "a.npy";
    write_text(path, npy("(1, 1, 2, 2)", {1.0f, -2.0f, -3.0f, 4.0f}));
    const auto brdf = open_brdf(path);
    EXPECT_EQ(brdf->notes, std::vector<std::string>{"2 of 4 numbers are negative and taken as 0"});
    EXPECT_EQ(brdf->name, "a.npy");
    write_text(path, npy("(1, 1, 2, 2)", {1.0f, -2.0f, std::nanf(""), 4.0f}));
    EXPECT_REFUSED(open_brdf(path), "1 of its numbers are NaN or infinite");
    write_text(path, npy("(2, 2)", {1.0f, 2.0f, 3.0f, 4.0f}));
    EXPECT_REFUSED(open_brdf(path), "2 axes");
    write_text(path, npy("(1, 1, 2, 3)", {1.0f, 2.0f, 3.0f, 4.0f}));
    EXPECT_REFUSED(open_brdf(path), "cut short");
}

TEST(InputBrdfFiles, AreRecognisedByWhatTheyHold) {
    const Folder folder;
    RglParts parts;
    parts.fill(1);
    for (const char* name : {"a.bsdf", "a.dat", "binary"}) {
        write_text(folder / name, text_of(parts.bytes()));
        const auto brdf = open_brdf(folder / name);
        EXPECT_EQ(brdf->name, name);
        EXPECT_EQ(brdf->sha256.size(), 64u);
    }
    EXPECT_EQ(open_brdf("lambert")->sha256, "");
    write_text(folder / "text.binary", "Dear sir,\nthis is not a BRDF.\n");
    EXPECT_REFUSED(open_brdf(folder / "text.binary"), "a MERL file has 90 x 90 x 180");
    write_text(folder / "text.bsdf", "Dear sir");
    EXPECT_REFUSED(open_brdf(folder / "text.bsdf"), "not a tensor file");
    write_text(folder / "text.npy", "Dear sir");
    EXPECT_REFUSED(open_brdf(folder / "text.npy"), "text.npy");
    write_text(folder / "text.txt", "Dear sir");
    EXPECT_REFUSED(open_brdf(folder / "text.txt"), "not a BRDF file of a known kind");
    write_text(folder / "a", "\xab\x41\x43\x44\x46" + std::string(100, ' '));
    EXPECT_REFUSED(open_brdf(folder / "a"), "it is an .acdf file; give the BRDF");
    write_text(folder / "a", "\x76\x2f\x31\x01" + std::string(100, ' '));
    EXPECT_REFUSED(open_brdf(folder / "a"), "OpenEXR image, which acdf env takes");
    write_text(folder / "a", "#?RADIANCE\n");
    EXPECT_REFUSED(open_brdf(folder / "a"), "Radiance image, which acdf env takes");
    write_text(folder / "empty.bsdf", "");
    EXPECT_REFUSED(open_brdf(folder / "empty.bsdf"), "empty");
    EXPECT_REFUSED(open_brdf(folder / "missing.bsdf"), "no such file");
    EXPECT_REFUSED(open_brdf(folder / ""), "folder");
    EXPECT_REFUSED(open_brdf(""), "no such file");
    EXPECT_REFUSED(open_brdf("lamber"), "no model of this name");
}

std::string data_file(const std::string& name) { return std::string(acdf_test::kTestData) + "/brdfs/" + name; }

struct Real {
    const char* name;
    double low, high; // of the mean albedo of three channels, 25 degrees
    bool mirror;
};

// The satin film reflects 1.1 times what it receives at normal incidence: the measurement's, not the reader's.
constexpr Real real_files[] = {
    {"nickel.binary", 0.1, 0.3, false},           {"blue-metallic-paint.binary", 0.03, 0.2, false},
    {"cc_ibiza_sunset_rgb.bsdf", 0.1, 0.7, true}, {"cg_sunflower_rgb.bsdf", 0.1, 0.7, true},
    {"paper_white_rgb.bsdf", 0.6, 1.0, true},     {"satin_rosaline_rgb.bsdf", 0.4, 1.2, true},
};

TEST(InputBrdfFiles, RealMeasurements) {
    if (!std::filesystem::exists(data_file(""))) GTEST_SKIP() << "no real BRDFs: set ACDF_TEST_DATA";
    std::mt19937_64 random(1);
    for (const Real& real : real_files) {
        const auto brdf = open_brdf(data_file(real.name));
        EXPECT_EQ(brdf->name, real.name);
        EXPECT_TRUE(brdf->isotropic);
        EXPECT_EQ(brdf->mirror, real.mirror) << real.name << ' ' << brdf->asymmetry;
        for (int i = 0; i < 5000; ++i) {
            const Direction wo = random_direction(random), wi = random_direction(random);
            for (const double v : rho(*brdf, wo, wi)) ASSERT_TRUE(std::isfinite(v) && v >= 0.0) << real.name;
        }
        const double share = mean_of(acdf::test::albedo(*brdf, at_angles(0.44, 0.3), 150));
        EXPECT_GT(share, real.low) << real.name;
        EXPECT_LT(share, real.high) << real.name;
    }
    EXPECT_REFUSED(open_brdf(data_file("spectralon_lowres.pbsdf")), "polarised");
}

} // namespace
