// The test vectors of format/vectors against the reader, number by number: it made them, and it has to stay as it
// was.
#include "visibility/visible_view.h"

#include <acdf/curves/curves.h>
#include <acdf/indexed/views.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kVectors = fs::path(ACDF_TEST_DIR) / ".." / "format" / "vectors";
const fs::path kGolden = fs::path(ACDF_TEST_DIR) / "golden" / "v1.0";

using Row = std::map<std::string, std::string>;

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line + ',');
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
}

std::vector<Row> rows_of(const fs::path& path) {
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    const auto names = split(line);
    std::vector<Row> rows;
    while (std::getline(in, line)) {
        const auto cells = split(line);
        EXPECT_EQ(cells.size(), names.size()) << line;
        rows.emplace_back();
        for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i) rows.back()[names[i]] = cells[i];
    }
    return rows;
}

double number(const Row& row, const std::string& name) { return std::strtod(row.at(name).c_str(), nullptr); }

/// Three floats whose names differ in the last letter.
std::vector<float> direction(const Row& row, const std::string& prefix) {
    std::vector<float> out;
    for (const char* axis : {"x", "y", "z"}) out.push_back(std::strtof(row.at(prefix + axis).c_str(), nullptr));
    return out;
}

std::vector<double> numbered(const Row& row, const std::string& prefix) {
    std::vector<double> out;
    for (int i = 0; row.count(prefix + std::to_string(i)); ++i)
        out.push_back(number(row, prefix + std::to_string(i)));
    return out;
}

template <class Sample, class Pdf>
void check_direction(const Row& row, Sample sample, Pdf pdf) {
    const auto wanted = direction(row, "");
    const float density = std::strtof(row.at("pdf").c_str(), nullptr);
    if (row.at("call") == "pdf") {
        EXPECT_EQ(pdf(wanted.data()), density);
        return;
    }
    const acdf::DirectionSample s = sample(number(row, "u0"), number(row, "u1"));
    EXPECT_EQ(std::memcmp(s.direction, wanted.data(), sizeof s.direction), 0);
    EXPECT_EQ(s.pdf, density);
}

template <class View>
void check_conditional(const Row& row, const View& view, const char* prefix) {
    const auto given = direction(row, prefix);
    check_direction(
        row, [&](double u0, double u1) { return view.sample(given.data(), u0, u1); },
        [&](const float* d) { return view.pdf(given.data(), d); });
}

void check_place(const Row& row, const acdf::VisibleLocalView& view) {
    const AcdfVisiblePoint point = view.at(direction(row, "p").data(), direction(row, "n").data());
    check_direction(
        row, [&](double u0, double u1) { return view.sample(point, u0, u1); },
        [&](const float* d) { return view.pdf(point, d); });
}

void check_maps(const Row& row, const acdf::File& file) {
    acdf::IndexedEnvironment view;
    ASSERT_TRUE(acdf::IndexedEnvironment::open(file, view).ok());
    const acdf::MixedEnvironment sky = view.at(numbered(row, "t").data());
    check_direction(
        row, [&](double u0, double u1) { return sky.sample(u0, u1); }, [&](const float* d) { return sky.pdf(d); });
}

void check_table(const Row& row, const acdf::TableView& view) {
    std::vector<std::uint32_t> index;
    for (const double i : numbered(row, "i")) index.push_back(static_cast<std::uint32_t>(i));
    const auto wanted = numbered(row, "x");
    if (row.at("call") == "pdf") {
        EXPECT_EQ(view.pdf(index.data(), wanted.data()), number(row, "pdf"));
        return;
    }
    std::vector<double> x(wanted.size(), 0.0);
    EXPECT_EQ(view.sample(index.data(), numbered(row, "u").data(), x.data()), number(row, "pdf"));
    EXPECT_EQ(x, wanted);
}

void check_row(const Row& row, const acdf::File& file) {
    switch (file.kind()) {
    case ACDF_KIND_LOCAL:
        if (row.count("px")) return check_place(row, acdf::visible_view(file));
        return check_conditional(row, file.local(), "n");
    case ACDF_KIND_BRDF:
        return check_conditional(row, file.brdf(), "o");
    case ACDF_KIND_TABLE:
        return check_table(row, file.table());
    case ACDF_KIND_INDEXED:
        return check_maps(row, file);
    default:
        return check_direction(
            row, [&](double u0, double u1) { return file.environment().sample(u0, u1); },
            [&](const float* d) { return file.environment().pdf(d); });
    }
}

TEST(Vectors, areWhatTheReaderGives) {
    std::size_t rows = 0;
    std::map<int, int> kinds;
    for (const auto& entry : fs::directory_iterator(kVectors)) {
        if (entry.path().extension() != ".csv") continue;
        fs::path path = fs::path(entry.path()).replace_extension(".acdf");
        if (!fs::exists(path)) path = kGolden / path.filename();
        acdf::File file;
        acdf::LoadOptions walked; // as SPEC.md says it, to the last bit
        walked.tables = false;
        const acdf::Status status = acdf::File::open(path.c_str(), file, acdf::with_curves(walked));
        ASSERT_TRUE(status.ok()) << status.message;
        ++kinds[file.kind()];
        int line = 1;
        for (const Row& row : rows_of(entry.path())) {
            SCOPED_TRACE(entry.path().filename().string() + ":" + std::to_string(++line));
            check_row(row, file);
            ++rows;
        }
    }
    EXPECT_GT(rows, 1800u);
    EXPECT_EQ(kinds.size(), 5u);
}

/// No golden file goes without vectors.
TEST(Vectors, standForEachGoldenFile) {
    for (const auto& entry : fs::directory_iterator(kGolden))
        if (entry.path().extension() == ".acdf") {
            const fs::path name = fs::path(entry.path().filename()).replace_extension(".csv");
            EXPECT_TRUE(fs::exists(kVectors / name)) << name;
        }
}

} // namespace
