// The frozen files of every version: format/make_golden.cpp makes those of the present one.
#include "tests/inputs/directions.h"
#include "tests/inputs/paths.h"
#include "tests/lib/curves/open.h"
#include "tests/lib/reader/golden_numbers.h"
#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kGolden = fs::path(ACDF_TEST_DIR) / "golden" / "v1.0";

std::vector<char> bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    EXPECT_TRUE(in) << path;
    return {std::istreambuf_iterator<char>(in), {}};
}

const char* const kNames[] = {
    "smallest", "one_texel",           "untilted",      "zlib",          "planes",       "tilted",
    "deep",     "shared_child",        "wide",          "many_segments", "octahedral",   "partner",
    "halvings", "halvings_octahedral", "halvings_dark", "halvings_zlib", "halvings_leaf"};
/// Whose maker is gone: curves of the variance fit, which now makes halvings. Readers go on reading them.
const std::set<std::string> kNotMade = {"untilted.acdf", "untilted.txt"};

/// A golden file and the samples beside it.
struct Line {
    double u[2];
    float direction[3], pdf;
};

class GoldenFile : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const fs::path path = kGolden / (std::string(GetParam()) + ".acdf");
        acdf::LoadOptions walked; // as SPEC.md says it, to the last bit
        walked.tables = false;
        const acdf::Status status = acdf::File::open(path.c_str(), file_, acdf::with_curves(walked));
        ASSERT_TRUE(status.ok()) << status.message;
        for (const auto& v : acdf_test::golden_numbers<6>(kGolden / (std::string(GetParam()) + ".txt")))
            lines_.push_back(parse(v));
        ASSERT_EQ(lines_.size(), 16u);
    }

    static Line parse(const std::array<double, 6>& v) {
        return {{v[0], v[1]}, {float(v[2]), float(v[3]), float(v[4])}, float(v[5])};
    }

    acdf::File file_;
    std::vector<Line> lines_;
};

TEST_P(GoldenFile, SamplesTheSameSamples) {
    for (const Line& line : lines_) {
        const auto s = file_.environment().sample(line.u[0], line.u[1]);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(s.direction[i], line.direction[i]);
        EXPECT_EQ(s.pdf, line.pdf);
    }
}

TEST_P(GoldenFile, HasThatPdfThere) {
    const bool tilted = file_.description().fit == ACDF_FIT_PDF;
    for (const Line& line : lines_) {
        const float pdf = file_.environment().pdf(line.direction);
        if (tilted) EXPECT_NEAR(pdf / line.pdf, 1.0, 1e-4);
        else EXPECT_EQ(pdf, line.pdf);
    }
}

TEST_P(GoldenFile, InvertsToTheRandomNumbers) {
    for (const Line& line : lines_) {
        double u[2];
        ASSERT_TRUE(file_.environment().invert(line.direction, u));
        const auto again = file_.environment().sample(u[0], u[1]);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(again.direction[i], line.direction[i], 2e-6);
        if (std::abs(line.direction[2]) > 0.999f) continue; // azimuth says little near the poles
        EXPECT_NEAR(u[0], line.u[0], 1e-4);
        EXPECT_NEAR(u[1], line.u[1], 1e-4);
    }
}

INSTANTIATE_TEST_SUITE_P(V1_0, GoldenFile, ::testing::ValuesIn(kNames),
                         [](const auto& info) { return std::string(info.param); });

// ---- directions derived by hand from the frame: right-handed, z up, phi = pi - 2 pi column / columns ------

struct HandMade {
    const char* name;
    double u[2];
    double direction[3];
    double pdf; ///< probability over (difference of phi x difference of cos theta)
};

using acdf_test::kPi;
const double kHalf = std::sqrt(0.5);
const double kSin22 = std::sin(kPi / 8), kCos22 = std::cos(kPi / 8);

// one_texel: phi falls from pi/2 (column 2 of 8) to pi/4, theta grows from pi/4 (row 1 of 4) to pi/2.
const double kTexelPdf = 1.0 / (kPi / 4 * kHalf);
const double kMiddleZ = kHalf / 2, kMiddleSin = std::sqrt(1.0 - kHalf * kHalf / 4);
// shared_child, 10 x 6: row 2 (theta from pi/3 to pi/2) has a quarter of all samples, all of them in columns 7
// to 10, where phi falls from pi - 2 pi 7/10 = -2 pi/5 to -pi. The random numbers that lead there, 1/8 to 3/8, are
// stored as 8192 and 24576 out of 65535.
const double kSharedPdf = 0.25 / (2 * kPi * 0.3 * 0.5);

// octahedral, 24 x 24: columns 9 to 20 are one cell with half of all samples. The random numbers that lead there,
// 3/8 to 7/8, are stored as 24576 and 57343 out of 65535; column 12, the middle of the square's width, lies 3/11
// across.
const double kMiddleColumn = (24576 + 32767 * 3.0 / 11) / 65535;

// halvings_dark, 8 x 6: code 300 of 4095 leads 25106309 of 2^31 steps to row 0, so that the others lead to rows 1
// to 3 (theta from pi/6 to pi/2); code 4094 leads the last 261 steps to column 7 (phi from -3 pi/4 to -pi).
const double kDarkRow = 25106309 / 2147483648.0;
const double kDarkPdf = 261 / 2147483648.0 * (1.0 - kDarkRow) / (kPi / 4 * std::sqrt(0.75));

const HandMade kHandMade[] = {
    {"smallest", {0.0, 0.0}, {0, 0, 1}, 1 / (4 * kPi)},
    {"smallest", {0.5, 0.5}, {1, 0, 0}, 1 / (4 * kPi)},   // the centre of the image is +x
    {"smallest", {0.25, 0.5}, {0, 1, 0}, 1 / (4 * kPi)},  // left of it is +y
    {"smallest", {0.75, 0.5}, {0, -1, 0}, 1 / (4 * kPi)}, // right of it -y
    {"smallest", {0.0, 0.5}, {-1, 0, 0}, 1 / (4 * kPi)},  // the seam is -x
    {"smallest", {1.0, 0.5}, {-1, 0, 0}, 1 / (4 * kPi)},
    {"smallest", {0.5, 1.0}, {0, 0, -1}, 1 / (4 * kPi)},
    {"one_texel", {0.0, 1.0}, {0, 1, 0}, kTexelPdf},
    {"one_texel", {0.0, 0.0}, {0, kHalf, kHalf}, kTexelPdf},
    {"one_texel", {1.0, 1.0}, {kHalf, kHalf, 0}, kTexelPdf},
    {"one_texel", {0.5, 0.5}, {kMiddleSin * kSin22, kMiddleSin* kCos22, kMiddleZ}, kTexelPdf},
    {"shared_child",
     {0.0, 8192.01 / 65535},
     {std::sqrt(0.75) * std::cos(-0.4 * kPi), std::sqrt(0.75) * std::sin(-0.4 * kPi), 0.5},
     kSharedPdf},
    // octahedral, 24 x 24: columns 9 to 20 are one cell with half of all samples. Its random numbers of axis 0 are
    // 3/8 to 7/8; at 3/8 + 1/2 * 3/11 lies column 12, the middle of the square's width.
    {"octahedral", {kMiddleColumn, 0.5}, {0, 0, 1}, 0.5 / (4 * kPi * 11 / 24)},
    {"octahedral", {kMiddleColumn, 0.0}, {0, -1, 0}, 0.5 / (4 * kPi * 11 / 24)},
    {"octahedral", {kMiddleColumn, 1.0}, {0, 1, 0}, 0.5 / (4 * kPi * 11 / 24)},
    // The first column's lower left: -z; v = 5/24 of columns 0 to 3 is crossed at half of its random numbers.
    {"octahedral", {0.0, 0.0}, {0, 0, -1}, 0.125 * 0.5 / (4 * kPi * 3 * 5 / 576)},
    {"shared_child", {1.0, 24575.99 / 65535}, {-1, 0, 0}, kSharedPdf},
    {"halvings_leaf", {0.25, 0.5}, {0, 1, 0}, 1 / (4 * kPi)},
    {"halvings_dark", {1.0, 1.0}, {-1, 0, 0}, kDarkPdf},
    {"halvings_dark", {1.0, kDarkRow + 1e-9}, {-0.5, 0, std::sqrt(0.75)}, kDarkPdf},
};

TEST(GoldenFrame, DirectionsDerivedByHand) {
    for (const HandMade& hand : kHandMade) {
        SCOPED_TRACE(std::string(hand.name) + " " + std::to_string(hand.u[0]) + " " + std::to_string(hand.u[1]));
        acdf::File file;
        ASSERT_TRUE(
            acdf::File::open((kGolden / (std::string(hand.name) + ".acdf")).c_str(), file, acdf::with_curves())
                .ok());
        const auto s = file.environment().sample(hand.u[0], hand.u[1]);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(s.direction[i], hand.direction[i], 1e-5);
        EXPECT_NEAR(s.pdf / hand.pdf, 1.0, 1e-4); // 16-bit probabilities
    }
}

TEST(GoldenFrame, PdfIsZeroInEveryMirrorImage) {
    acdf::File file;
    ASSERT_TRUE(acdf::File::open((kGolden / "one_texel.acdf").c_str(), file, acdf::with_curves()).ok());
    const double x = kMiddleSin * kSin22, y = kMiddleSin * kCos22, z = kMiddleZ;
    const double images[][3] = {{-x, y, z}, {x, -y, z}, {x, y, -z}, {-x, -y, z}, {y, x, z}, {x, z, y}, {z, x, y}};
    const float there[3] = {float(x), float(y), float(z)};
    EXPECT_NEAR(file.environment().pdf(there), kTexelPdf, 1e-5);
    for (const auto& image : images) {
        const float direction[3] = {float(image[0]), float(image[1]), float(image[2])};
        EXPECT_EQ(file.environment().pdf(direction), 0.0f) << image[0] << " " << image[1] << " " << image[2];
    }
}

/// Null where the file has none.
const AcdfChunk* chunk_of(const acdf::File& file, std::uint32_t type) {
    const auto* chunks = reinterpret_cast<const AcdfChunk*>(&file.header() + 1);
    for (std::uint32_t i = 0; i < file.header().chunk_count; ++i)
        if (chunks[i].type == type) return &chunks[i];
    return nullptr;
}
std::uint32_t codec_of_tree(const acdf::File& file) { return chunk_of(file, ACDF_CHUNK_TREE)->codec; }

TEST(GoldenContents, EachFileHasWhatItIsFor) {
    const auto open = [](const char* name, acdf::File& file) {
        const acdf::Status status =
            acdf::File::open((kGolden / (std::string(name) + ".acdf")).c_str(), file, acdf::with_curves());
        if (!status.ok()) throw std::runtime_error(status.message);
        return acdf_curve_at(acdf_test::TreeOf(file).data, file.bin(0).root);
    };
    acdf::File one_texel, many, wide, deep, tilted, shared, zlib, planes;
    const AcdfCurve narrow_root = open("one_texel", one_texel);
    EXPECT_EQ(ACDF_CURVE_CUMULATIVE_CODE(narrow_root.header), 0u);
    EXPECT_EQ(ACDF_CURVE_POSITION_CODE(narrow_root.header), 0u);
    EXPECT_EQ(ACDF_CURVE_LINK_CODE(narrow_root.header), 1u);
    const AcdfCurve wide_root = open("wide", wide);
    EXPECT_EQ(ACDF_CURVE_CUMULATIVE_CODE(wide_root.header), 2u);
    EXPECT_EQ(ACDF_CURVE_POSITION_CODE(wide_root.header), 1u);
    const AcdfCurve many_root = open("many_segments", many);
    EXPECT_EQ(ACDF_CURVE_LINK_CODE(many_root.header), 2u);
    const AcdfCurve many_child =
        acdf_curve_at(acdf_test::TreeOf(many).data, many.bin(0).root + acdf_curve_link(&many_root, 0));
    EXPECT_GT(many_child.segments, ACDF_CURVE_SHORT_SEGMENTS + 0u);
    EXPECT_EQ(ACDF_CURVE_CUMULATIVE_CODE(many_child.header), 1u);
    EXPECT_TRUE(open("tilted", tilted).tilts != nullptr);
    const AcdfCurve shared_root = open("shared_child", shared);
    EXPECT_EQ(acdf_curve_link(&shared_root, 0), acdf_curve_link(&shared_root, 2));
    const AcdfCurve deep_root = open("deep", deep);
    std::uint32_t at = deep.bin(0).root + acdf_curve_link(&deep_root, 1);
    const AcdfCurve second = acdf_curve_at(acdf_test::TreeOf(deep).data, at);
    const AcdfCurve third = acdf_curve_at(acdf_test::TreeOf(deep).data, at + acdf_curve_link(&second, 2));
    EXPECT_EQ(acdf_curve_axis(&third), acdf_curve_axis(&deep_root));
    open("zlib", zlib);
    open("planes", planes);
    EXPECT_EQ(codec_of_tree(zlib), ACDF_CODEC_ZLIB + 0u);
    EXPECT_EQ(codec_of_tree(planes), ACDF_CODEC_PLANES + 0u);
}

TEST(GoldenContents, EachTreeOfHalvingsHasWhatItIsFor) {
    struct Wanted {
        const char* name;
        std::uint32_t codec, code_bits, least_count;
    };
    for (const Wanted& wanted : {Wanted{"halvings", ACDF_CODEC_NONE, 8, 12},
                                 {"halvings_octahedral", ACDF_CODEC_NONE, 10, 20},
                                 {"halvings_dark", ACDF_CODEC_NONE, 12, 6},
                                 {"halvings_zlib", ACDF_CODEC_ZLIB, 8, 255},
                                 {"halvings_leaf", ACDF_CODEC_NONE, 8, 0}}) {
        SCOPED_TRACE(wanted.name);
        acdf::File file;
        ASSERT_TRUE(
            acdf::File::open((kGolden / (std::string(wanted.name) + ".acdf")).c_str(), file, acdf::with_curves())
                .ok());
        const AcdfChunk* chunk = chunk_of(file, ACDF_CHUNK_HALVINGS);
        ASSERT_NE(chunk, nullptr);
        EXPECT_EQ(chunk_of(file, ACDF_CHUNK_TREE), nullptr);
        EXPECT_EQ(chunk->codec, wanted.codec);
        ASSERT_NE(file.environment().data().halved, nullptr);
        EXPECT_GE(file.environment().data().halved->count, wanted.least_count);
        if (chunk->codec != ACDF_CODEC_NONE) continue;
        AcdfHalvingsHeader header;
        std::memcpy(&header, reinterpret_cast<const char*>(&file.header()) + chunk->offset, sizeof header);
        EXPECT_EQ(header.code_bits, wanted.code_bits);
        EXPECT_EQ(header.halving_count, file.environment().data().halved->count);
    }
}

// ---- the maker ------------------------------------------------------------------------------------------

/// What a file says once it is decompressed, as text.
std::string decoded(const fs::path& path) {
    acdf::File file;
    const acdf::Status status = acdf::File::open(path.c_str(), file, acdf::with_curves());
    EXPECT_TRUE(status.ok()) << path << ": " << status.message;
    if (!status.ok()) return {};
    const auto raw = [](const void* data, std::size_t size) {
        return std::string(static_cast<const char*>(data), size);
    };
    std::string text = raw(&file.description(), sizeof(AcdfDescription));
    for (std::uint32_t i = 0; i < file.description().axis_count; ++i) text += raw(&file.axis(i), sizeof(AcdfAxis));
    if (const AcdfHalvedTree* halved = file.environment().data().halved)
        return text + raw(acdf_halvings_nodes(halved), halved->count * sizeof(AcdfHalving));
    for (std::uint32_t i = 0; i < file.description().bin_count; ++i) text += raw(&file.bin(i), sizeof(AcdfBin));
    text += raw(acdf_test::TreeOf(file).data, std::size_t{2} * acdf_test::TreeOf(file).units);
    for (std::uint32_t i = 0; i < file.metadata_count(); ++i) {
        acdf::Text key, value;
        file.metadata(i, key, value);
        text += raw(key.data, key.size) + "=" + raw(value.data, value.size) + "\n";
    }
    return text;
}

TEST(MakeGolden, MakesTheFrozenFilesAgain) {
    const fs::path folder = fs::path(::testing::TempDir()) / "acdf_golden";
    fs::remove_all(folder);
    fs::create_directories(folder);
    const std::string command = std::string("\"") + acdf_test::kMakeGolden + "\" \"" + folder.string() + "\"";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const fs::path frozen = kGolden / entry.path().filename();
        const std::string name = entry.path().filename().string();
        if (name == "zlib.acdf" || name == "planes.acdf" ||
            name == "halvings_zlib.acdf") // as zlib's version deflates
            EXPECT_EQ(decoded(entry.path()), decoded(frozen));
        else EXPECT_EQ(bytes_of(entry.path()), bytes_of(frozen)) << entry.path().filename();
    }
    for (const auto& entry : fs::directory_iterator(kGolden)) {
        const std::string name = entry.path().filename().string();
        EXPECT_NE(fs::exists(folder / name), kNotMade.count(name) == 1) << name;
    }
    fs::remove_all(folder);
}

} // namespace
