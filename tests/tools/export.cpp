// acdf export: what each target writes, and what is refused with one line. What the texts compute is tested on
// devices (tests/shaders).
#include "tests/tools/run.h"

#include <acdf/curves/curves.h>
#include <acdf/shader/tables.h>

#include <nlohmann/json.hpp>

#include <cstring>

namespace acdf::test {
namespace {

using nlohmann::json;

class Export : public testing::Test {
protected:
    Folder folder;
    const std::string file = folder / "sky.acdf", text = folder / "sky.txt", tables = folder / "sky.bin";
    void SetUp() override { write_bytes(file, small_halvings()); }

    std::vector<std::uint32_t> words() const {
        File opened;
        ShaderTables made;
        EXPECT_TRUE(File::open(file.c_str(), opened, acdf::with_curves()).ok());
        EXPECT_TRUE(ShaderTables::make(opened, made).ok());
        return {made.words(), made.words() + made.size()};
    }
    void expect_failure(const std::vector<std::string>& command, int code, const std::string& part) {
        const Result result = run_acdf(command);
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    }
};

TEST_F(Export, TablesAreThoseOfTheReader) {
    for (const char* target : {"c", "glsl", "hlsl", "wgsl", "json"}) {
        const Result result = run_acdf({"export", file, "--target", target, "--tables", tables, "-o", text, "-f"});
        ASSERT_EQ(result.code, 0) << result.err;
        const std::string bytes = read_text(tables);
        const std::vector<std::uint32_t> expected = words();
        ASSERT_EQ(bytes.size(), 4 * expected.size());
        EXPECT_EQ(std::memcmp(bytes.data(), expected.data(), bytes.size()), 0);
    }
}

TEST_F(Export, FunctionsAreTheSameForAllFiles) {
    for (const char* target : {"glsl", "hlsl", "wgsl"}) {
        const Result result = run_acdf({"export", file, "--target", target});
        ASSERT_EQ(result.code, 0) << result.err;
        for (const char* name : {"acdf_sample(", "acdf_pdf(", "acdf_tables"})
            EXPECT_NE(result.out.find(name), std::string::npos) << target << ' ' << name;
        EXPECT_EQ(result.out.find("double"), std::string::npos) << target;
        EXPECT_EQ(result.out.find("ACDF_U32"), std::string::npos) << target;
        EXPECT_EQ(result.out.find("#include"), std::string::npos) << target;
        EXPECT_EQ(run_acdf({"export", file, "--target", target}).out, result.out);
    }
}

TEST_F(Export, WithoutTablesCAndJsonHoldThem) {
    const std::vector<std::uint32_t> expected = words();
    const json told = json::parse(run_acdf({"export", file, "--target", "json"}).out);
    EXPECT_EQ(told["tables"].get<std::vector<std::uint32_t>>(), expected);
    EXPECT_EQ(told["words"], expected.size());
    EXPECT_EQ(told["total"], 2.5);
    EXPECT_EQ(told["resolution"], json({8, 4}));
    EXPECT_EQ(told["texture"]["height"], (expected.size() + 2047) / 2048);
    const json apart = json::parse(run_acdf({"export", file, "--target", "json", "--tables", tables}).out);
    EXPECT_FALSE(apart.contains("tables"));
    const std::string c = run_acdf({"export", file, "--target", "c"}).out;
    EXPECT_NE(c.find("acdf_tables[" + std::to_string(expected.size()) + "]"), std::string::npos);
    EXPECT_EQ(run_acdf({"export", file, "--target", "c", "--tables", tables, "-f"}).out.find("acdf_tables["),
              std::string::npos);
}

// One text serves local environments, environments on either grid and BRDFs.
TEST_F(Export, OneTextServesAllKinds) {
    const std::string golden = std::string(ACDF_TEST_DIR) + "/golden/v1.0/";
    const std::string functions = run_acdf({"export", file, "--target", "glsl"}).out;
    for (const char* name : {"local.acdf", "halvings_octahedral.acdf", "visibility.acdf", "brdf_mirrored.acdf",
                             "halvings_zlib.acdf"}) {
        const Result result = run_acdf({"export", golden + name, "--target", "glsl", "--tables", tables, "-f"});
        EXPECT_EQ(result.out, functions) << name;
        ASSERT_EQ(result.code, 0) << result.err;
        for (const char* function : {"AcdfShaderPoint acdf_at(vec3 normal)", "AcdfShaderView acdf_view(vec3 wo)"})
            EXPECT_NE(result.out.find(function), std::string::npos) << name;
        File opened;
        ShaderTables made;
        ASSERT_TRUE(File::open((golden + name).c_str(), opened, acdf::with_curves()).ok());
        ASSERT_TRUE(ShaderTables::make(opened, made).ok());
        const std::string bytes = read_text(tables);
        ASSERT_EQ(bytes.size(), 4 * made.size()) << name;
        EXPECT_EQ(std::memcmp(bytes.data(), made.words(), bytes.size()), 0) << name;
    }
}

TEST_F(Export, HalvingsHaveTables) {
    write_bytes(file, small_halvings());
    const Result result = run_acdf({"export", file, "--target", "glsl", "--tables", tables});
    ASSERT_EQ(result.code, 0) << result.err;
    const std::string bytes = read_text(tables);
    const std::vector<std::uint32_t> expected = words();
    ASSERT_EQ(bytes.size(), 4 * expected.size());
    EXPECT_EQ(std::memcmp(bytes.data(), expected.data(), bytes.size()), 0);
    EXPECT_EQ(expected[ACDF_WALK_BIN_COUNT], 0u);
    EXPECT_NE(expected[ACDF_WALK_ENVIRONMENT], ACDF_WALK_NONE);
}

// What `--walk` and its kinds of tables were: gone.
TEST_F(Export, HasOneKindOfTables) {
    expect_failure({"export", file, "--target", "c", "--walk"}, 2, "--walk");
    const json told = json::parse(run_acdf({"export", file, "--target", "json"}).out);
    EXPECT_FALSE(told.contains("functions"));
    EXPECT_FALSE(told.contains("pieces"));
}

TEST_F(Export, RefusesWithOneLine) {
    expect_failure({"export", file}, 2, "--target");
    expect_failure({"export", file, "--target", "metal"}, 2, "'metal' is none of c, glsl, hlsl, json, wgsl");
    expect_failure({"export", file, "--target", "glsl", "--tables", "-"}, 2, "stdout takes one of the two");
    expect_failure({"export", folder / "none.acdf", "--target", "c"}, 1, "cannot open");
    expect_failure({"export", file, "--target", "c", "-o", file, "-f"}, 1, file);
    expect_failure({"export", file, "--target", "c", "--tables", file, "-f"}, 1, file);
    expect_failure({"export", file, "--target", "c", "-o", text, "--tables", text}, 1, "both");
    const std::filesystem::path same =
        std::filesystem::path(text).parent_path() / "." / std::filesystem::path(text).filename();
    expect_failure({"export", file, "--target", "c", "-o", text, "--tables", same.string()}, 1, "both");
    write_text(tables, "mine");
    expect_failure({"export", file, "--target", "c", "--tables", tables, "-o", text}, 1, "--force");
    EXPECT_EQ(read_text(tables), "mine");
    EXPECT_FALSE(std::filesystem::exists(text)) << "neither of the two, or both";
    write_text(text, "no file");
    expect_failure({"export", text, "--target", "c"}, 1, "not an .acdf file");
}

TEST_F(Export, RefusesWhatHasNoTables) {
    compress::Cascade tilted;
    tilted.curves.push_back({1, {2}, {0.75, 0.25}, {}, {0.5, -0.5}});
    tilted.roots = {0};
    compress::Description description = compress::environment_description(8, 4);
    description.total = 1.0;
    write_bytes(file, compress::store(compress::encode_tree(tilted), description));
    expect_failure({"export", file, "--target", "glsl", "--tables", tables, "-o", text}, 1, "--fit variance");
    EXPECT_FALSE(std::filesystem::exists(tables));
    EXPECT_FALSE(std::filesystem::exists(text));
    const std::string golden = std::string(ACDF_TEST_DIR) + "/golden/v1.0/";
    for (const auto& entry : std::filesystem::directory_iterator(golden)) {
        if (entry.path().extension() != ".acdf") continue;
        File opened;
        ASSERT_TRUE(File::open(entry.path().c_str(), opened, acdf::with_curves()).ok());
        ShaderTables made;
        if (opened.kind() == ACDF_KIND_ENVIRONMENT || opened.kind() == ACDF_KIND_LOCAL) continue;
        if (ShaderTables::make(opened, made).ok()) continue; // of a BRDF of halvings
        expect_failure({"export", entry.path(), "--target", "c"}, 1, "no tables for shaders");
    }
}

} // namespace
} // namespace acdf::test
