// Cubes in six files, through the program: made, measured, and in batches.
#include "tests/inputs/synthetic.h"
#include "tests/inputs/write_rgb.h"
#include "tests/tools/run.h"

#include "build/probe/projection.h"

#include <nlohmann/json.hpp>

namespace acdf::test {
namespace {

using nlohmann::json;

constexpr int kSide = 16;

class CubeCommand : public testing::Test {
protected:
    Folder folder;
    const std::string output = folder / "out.acdf", strip = folder / "strip.pfm";
    std::vector<std::string> faces; ///< +X -X +Y -Y +Z -Z of Direct3D

    /// The cells of a horizontal cross that the faces are.
    void SetUp() override {
        const int cells[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
        const char* const names[6] = {"px", "nx", "py", "ny", "pz", "nz"};
        const build::Map map{build::Layout::horizontal_cross, 4 * kSide, 3 * kSide};
        std::vector<float> all;
        for (int i = 0; i < 6; ++i) {
            std::vector<float> rgb;
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x) {
                    build::Direction d;
                    EXPECT_TRUE(to_direction(map, (cells[i][0] * kSide + x + 0.5) / map.width,
                                             (cells[i][1] * kSide + y + 0.5) / map.height, d));
                    const double light =
                        d.x * 0.6 + d.z * 0.8 > 0.97 ? 300.0 : acdf_test::smooth_sky(std::atan2(d.y, d.x), d.z);
                    rgb.insert(rgb.end(), 3, static_cast<float>(light));
                }
            faces.push_back(folder / (std::string(names[i]) + ".pfm"));
            write_rgb(faces.back(), kSide, kSide, rgb);
            all.insert(all.end(), rgb.begin(), rgb.end());
        }
        write_rgb(strip, kSide, 6 * kSide, all);
    }

    std::string joined() const {
        std::string source;
        for (const std::string& face : faces) source += (source.empty() ? "" : ",") + face;
        return source;
    }

    Result env(const std::vector<std::string>& sources, std::vector<std::string> options) {
        options.insert(options.begin(), sources.begin(), sources.end());
        options.insert(options.begin(), "env");
        options.insert(options.end(), {"-o", output, "--force", "--json", "--cells", "200"});
        return run_acdf(options);
    }
};

TEST_F(CubeCommand, SixFilesAreOneMap) {
    const Result result = env(faces, {"--faces", "directx"});
    ASSERT_EQ(result.code, 0) << result.err;
    const json report = json::parse(result.out);
    EXPECT_EQ(report["projection"], "cube-cross");
    EXPECT_EQ(report["projection_reason"], "--faces directx");
    const std::string made = read_text(output);
    // One text with commas is the same source, and the order may be given face by face.
    ASSERT_EQ(env({joined()}, {"--faces", "directx"}).code, 0);
    EXPECT_EQ(read_text(output), made);
    // As is a strip, but for its name.
    const Result of_strip = env({strip}, {"--faces", "+x,-x,+y,-y,+z,-z"});
    ASSERT_EQ(of_strip.code, 0) << of_strip.err;
    EXPECT_EQ(json::parse(of_strip.out)["relative_variance"], report["relative_variance"]);
}

TEST_F(CubeCommand, IsMeasuredWithoutItsOptions) {
    const Result made = env(faces, {"--faces", "opengl"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Result result = run_acdf({"measure", output, "--against", joined(), "--json"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(json::parse(result.out)["relative_variance"], json::parse(made.out)["relative_variance"]);
}

TEST_F(CubeCommand, ReportsWhatIsMissing) {
    const Result unordered = env(faces, {});
    EXPECT_EQ(unordered.code, 2); // six maps, as it seems
    EXPECT_NE(unordered.err.find("--faces"), std::string::npos) << unordered.err;
    EXPECT_EQ(env(faces, {"--faces", "vulkan"}).code, 2);
    EXPECT_EQ(env({faces[0], faces[1]}, {"--faces", "directx"}).code, 2);
    std::filesystem::remove(faces[3]);
    const Result missing = env(faces, {"--faces", "directx"});
    EXPECT_EQ(missing.code, 1);
    EXPECT_NE(missing.err.find(faces[3]), std::string::npos) << missing.err;
    // No face may be written over.
    const std::string named = folder / "face.acdf";
    std::filesystem::copy_file(faces[5], named);
    const Result over = run_acdf({"env", faces[0], faces[1], faces[2], faces[2], faces[4], named, "-o", named,
                                  "--force", "--faces", "directx"});
    EXPECT_EQ(over.code, 1) << over.err;
}

TEST_F(CubeCommand, IsAJobOfABatch) {
    const std::string manifest = folder / "library.jsonl", out = folder / "out";
    write_text(manifest, "{\"source\": \"px.pfm,nx.pfm,py.pfm,ny.pfm,pz.pfm,nz.pfm\", \"options\": {\"faces\": "
                         "\"directx\", \"cells\": 200}}\n");
    const Result result = run_acdf({"batch", manifest, "-o", out});
    ASSERT_EQ(result.code, 0) << result.err;
    ASSERT_EQ(env(faces, {"--faces", "directx"}).code, 0);
    EXPECT_EQ(read_text(out + "/px.acdf"), read_text(output));
    const Result again = run_acdf({"batch", manifest, "-o", out, "--json"});
    EXPECT_EQ(json::parse(again.out)["up_to_date"], 1) << again.out;
    std::filesystem::resize_file(faces[4], 10); // one of them changed
    EXPECT_EQ(run_acdf({"batch", manifest, "-o", out}).code, 1);
    std::filesystem::remove(faces[4]);
    const Result missing = run_acdf({"batch", manifest, "-o", out});
    EXPECT_NE(missing.err.find("there is no file"), std::string::npos) << missing.err;
}

TEST_F(CubeCommand, IsNamedInJsonByItsSixFiles) {
    const json six = {"px.pfm", "nx.pfm", "py.pfm", "ny.pfm", "pz.pfm", "nz.pfm"};
    const std::string manifest = folder / "library.jsonl", out = folder / "out";
    write_text(manifest, json{{"source", six}, {"options", {{"faces", "directx"}, {"cells", 200}}}}.dump() + "\n");
    const Result batch = run_acdf({"batch", manifest, "-o", out});
    ASSERT_EQ(batch.code, 0) << batch.err;
    ASSERT_EQ(env(faces, {"--faces", "directx"}).code, 0);
    EXPECT_EQ(read_text(out + "/px.acdf"), read_text(output));
    for (const json& source :
         {json{"px.pfm", "nx.pfm"}, json{"a", "b", "c", "d", "e", "f,g"}, json{1, 2, 3, 4, 5, 6}}) {
        write_text(manifest, json{{"source", source}}.dump() + "\n");
        const Result refused = run_acdf({"batch", manifest, "-o", out});
        EXPECT_EQ(refused.code, 1) << source;
        EXPECT_NE(refused.err.find("library.jsonl:1: 'source'"), std::string::npos) << refused.err;
    }

    const json scene = {{"camera", {{"from", {4, -1, 2}}, {"to", {0, 0, 0.5}}, {"fov", 35}}},
                        {"image", {{"width", 4}, {"height", 3}}},
                        {"light", {{"probe", six}, {"faces", "directx"}}},
                        {"objects", {{{"plane", {{"z", 0}}}, {"brdf", "lambert"}}}},
                        {"samples", 2},
                        {"samplers", {"full-cdf"}}};
    write_text(folder / "scene.json", scene.dump());
    const Result render =
        run_acdf({"render", "--scene", folder / "scene.json", "--data", folder / "", "-o", folder / "pictures",
                  "--seeds", "3", "--no-timing", "--no-reference", "--json"});
    ASSERT_EQ(render.code, 0) << render.err;
    EXPECT_EQ(json::parse(render.out).at("light"), "px.pfm,nx.pfm,py.pfm,ny.pfm,pz.pfm,nz.pfm");
}

} // namespace
} // namespace acdf::test
