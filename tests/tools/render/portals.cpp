// Portals of files with visibility cells: given by --portal and --portals, and sampled in pictures.
#include "tests/inputs/sanitized.h"
#include "tests/tools/render/scenes.h"
#include "visibility/visible_view.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <nlohmann/json.hpp>

namespace acdf::test {
namespace {

using Json = nlohmann::json;

/// The opening in the roof of room(), in its own coordinates.
constexpr const char* kOpening = "-2,0,2 2,0,2 2,2,2";
constexpr const char* kOpeningYUp = "0,2,-2 0,2,2 2,2,2";

struct PortalFolder : SceneFolder {
    PortalFolder() : SceneFolder(mesh_scene("room.obj")) { write_text(*this / "room.obj", room()); }

    Result local(const std::string& output, const std::vector<std::string>& more, const char* mesh = "room.obj") {
        std::vector<std::string> arguments{"local", *this / "probe.pfm", "-o",        *this / output, "--budget",
                                           "48KiB", "--scene",           *this / mesh};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_acdf(arguments);
    }
};

struct Opened {
    File file;

    explicit Opened(const std::string& path) { EXPECT_TRUE(File::open(path.c_str(), file).ok()) << path; }
    VisibleLocalView view() const { return visible_view(file); }
    AcdfVisibleLocal data() const { return view().data(); }
};

TEST(MeshPortals, AreGivenByCornersAndByAScene) {
    PortalFolder folder;
    const Result one = folder.local("one.acdf", {"--visibility", "--portal", kOpening}),
                 two = folder.local("two.acdf", {"--visibility", "--portals", folder / "scene.json"});
    ASSERT_EQ(one.code, 0) << one.err;
    ASSERT_EQ(two.code, 0) << two.err;
    write_text(folder / "y.obj", room(true));
    const Result y_up =
        folder.local("y.acdf", {"--scene-up", "y", "--visibility", "--portal", kOpeningYUp}, "y.obj");
    ASSERT_EQ(y_up.code, 0) << y_up.err;
    const Opened a(folder / "one.acdf"), b(folder / "two.acdf"), c(folder / "y.acdf");
    ASSERT_TRUE(a.view().has_portals());
    for (const Opened* other : {&b, &c}) {
        ASSERT_TRUE(other->view().has_portals());
        ASSERT_EQ(other->data().portals.header->portal_count, 1u);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(a.data().portals.portals->corner[k], other->data().portals.portals->corner[k], 1e-5);
        for (int k = 0; k < 2; ++k)
            EXPECT_NEAR(a.data().portals.portals->sides[k], other->data().portals.portals->sides[k], 1e-5);
    }
    const float x[3] = {0.5f, -1, 0.1f}, y[3] = {-1, 0.1f, 0.5f}, up[3] = {0, 0, 1};
    EXPECT_EQ(a.view().at(x, up).portals, 1);
    EXPECT_EQ(c.view().at(y, up).portals, 1);

    const Json info = Json::parse(run_acdf({"info", "--json", folder / "one.acdf"}).out);
    EXPECT_EQ(info.at("local").at("portals").at("count"), 1);
    EXPECT_NE(std::string(info.at("options")).find("--visibility --portal \"-2,0,2 2,0,2 2,2,2\""),
              std::string::npos);
    const Result text = run_acdf({"info", folder / "one.acdf"});
    EXPECT_NE(text.out.find("1 portals, 1 maps"), std::string::npos) << text.out;
    EXPECT_EQ(run_acdf({"validate", folder / "one.acdf"}).code, 0);
    EXPECT_EQ(run_acdf({"plot", folder / "one.acdf", "-o", folder / "plot.png", "--position", "0,-1,0.1",
                        "--normal", "0,0,1"})
                  .code,
              0);

    const Result measured = run_acdf({"measure", folder / "one.acdf", "--against", folder / "probe.pfm", "--scene",
                                      folder / "room.obj", "--json"});
    ASSERT_EQ(measured.code, 0) << measured.err;
    EXPECT_EQ(Json::parse(measured.out).at("visibility").at("support_violations"), 0);
}

TEST(MeshPortals, EitherWindingServesInMirroredFramesToo) {
    PortalFolder folder;
    constexpr const char* windings[] = {kOpening, "2,2,2 2,0,2 -2,0,2"};
    for (const char* axes : {"(X, Y, Z)", "(-X, Y, Z)"})
        for (const char* winding : windings) {
            const Result made =
                folder.local("a.acdf", {"--scene-axes", axes, "--visibility", "--portal", winding, "--force"});
            ASSERT_EQ(made.code, 0) << axes << ", " << winding << ": " << made.err;
            EXPECT_EQ(made.err.find("portal 1"), std::string::npos) << made.err;
            const Opened file(folder / "a.acdf");
            ASSERT_TRUE(file.view().has_portals());
            const float* outside = file.data().portals.maps->axis[2];
            EXPECT_NEAR(outside[2], 1.0, 1e-5) << axes << ", " << winding;
            if (acdf_test::kSanitized) return;
        }
}

TEST(MeshPortals, ThoseThatDoNotFitTheirWindowsAreRemarkedOn) {
    PortalFolder folder;
    const auto remarks = [&](const std::string& portal) {
        const Result made = folder.local("a.acdf", {"--visibility", "--portal", portal, "--force"});
        EXPECT_EQ(made.code, 0) << made.err;
        return made.err;
    };
    EXPECT_EQ(remarks(kOpening).find("portal 1"), std::string::npos);
    const std::string larger = remarks("-2,-2,2 2,-2,2 2,2,2"); // half of it is roof
    EXPECT_NE(larger.find("portal 1 is larger than its opening: no light comes through 50 % of it"),
              std::string::npos)
        << larger;
    const std::string past = remarks("-4,0,2 4,0,2 4,2,2"); // half of it is beside the room
    EXPECT_NE(past.find("portal 1 is larger than its opening"), std::string::npos) << past;
    const std::string far = remarks("-2,0,9 2,0,9 2,2,9");
    EXPECT_NE(far.find("portal 1 lies outside of the box around the scene"), std::string::npos) << far;

    write_text(folder / "y.obj", room(true));
    const Result y_up =
        folder.local("y.acdf", {"--scene-up", "y", "--visibility", "--portal", "-2,2,-2 -2,2,2 2,2,2"}, "y.obj");
    EXPECT_NE(y_up.err.find("through 50 % of it"), std::string::npos) << y_up.err;
}

TEST(MeshPortals, AreSampledInPictures) {
    PortalFolder folder;
    const Result result = run_acdf({"render", "--scene", folder / "scene.json", "--data", folder.data(), "-o",
                                    folder / "out", "--seeds", "40", "--no-timing", "--json", "--no-reference",
                                    "--sampler", "visibility-portals:48KiB", "--sequence", "independent"});
    ASSERT_EQ(result.code, 0) << result.err;
    const Json json = Json::parse(result.out);
    ASSERT_EQ(json.at("samplers").size(), 1u);
    EXPECT_LT(std::fabs(double(json.at("samplers").at(0).at("bias_standard_errors"))), 4.5);
}

TEST(MeshPortals, MistakesAreOneLine) {
    PortalFolder folder;
    const auto refused = [&](const std::vector<std::string>& options, int code, const std::string& part) {
        const Result result = folder.local("no.acdf", options);
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "no.acdf"));
    };
    refused({"--portal", kOpening}, 2, "is for --visibility");
    refused({"--visibility", "--portal", "1,2,3"}, 2, "three corners");
    refused({"--visibility", "--portal", "-2,0,2 2,0,2 2,2,2 1"}, 2, "three corners");
    refused({"--visibility", "--portal", "-2,0,2 2,0,2 2,2,nan"}, 2, "three corners");
    refused({"--visibility", "--portal", "-2,0,2 2,0,2 3,2,2"}, 1, "right angles");
    refused({"--visibility", "--portal", "-0.4,0.7,0.3 0.4,0.7,0.3 0.4,1.1,0.3"}, 1,
            "no light arrives through portal 1");
    refused({"--visibility", "--portals", folder / "none.json"}, 1, "none.json");
    write_text(folder / "bad.json", "{}");
    refused({"--visibility", "--portals", folder / "bad.json"}, 1, "bad.json");
    write_text(folder / "bad.json", small_scene("\"cosine\""));
    refused({"--visibility", "--portals", folder / "bad.json"}, 1, "bad.json: the scene has no portals");
}

} // namespace
} // namespace acdf::test
