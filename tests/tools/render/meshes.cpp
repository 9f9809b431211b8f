// Scenes of triangles: `acdf local --scene MESH --visibility` makes a file, `acdf render` looks from the same mesh.
#include "tests/inputs/sanitized.h"
#include "tests/tools/render/scenes.h"
#include "visibility/visible_view.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <sstream>
#include <thread>

namespace acdf::test {
namespace {

using Json = nlohmann::json;

struct MeshFolder : SceneFolder {
    MeshFolder() : SceneFolder(mesh_scene("room.obj")) { write_text(*this / "room.obj", room()); }

    Result local(const std::string& output, std::vector<std::string> more) {
        std::vector<std::string> arguments{"local",    *this / "probe.pfm", "-o",       *this / output,
                                           "--filter", "nearest",           "--budget", "64KiB"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_acdf(arguments);
    }
    /// A file of the visibility of room(), which is made once a process.
    void room_file(const std::string& output, bool y_up = false) {
        static std::string made[2];
        std::string& bytes = made[y_up];
        if (bytes.empty()) {
            const std::string mesh = y_up ? "y.obj" : "room.obj";
            write_text(*this / mesh, room(y_up));
            std::vector<std::string> more{"--scene", *this / mesh, "--visibility"};
            if (y_up) more.insert(more.end(), {"--scene-up", "y"});
            const Result result = local(output, more);
            EXPECT_EQ(result.code, 0) << result.err;
            bytes = read_text(*this / output);
        } else {
            write_text(*this / output, bytes);
        }
    }
    Result render(const std::string& scene, const std::string& output, std::vector<std::string> more = {},
                  const std::string& seeds = acdf_test::kSanitized ? "20" : "150") {
        std::vector<std::string> arguments{"render", "--scene",     *this / scene,  "--data",
                                           data(),   "-o",          *this / output, "--seeds",
                                           seeds,    "--no-timing", "--json",       "--no-reference"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_acdf(arguments);
    }
};

/// Rows of normals stay those of all light, so that the file is valid without MIS.
TEST(MeshVisibility, CellsBesideTheCosineAreValidAlone) {
    ACDF_NOT_SANITIZED();
    MeshFolder folder;
    const std::vector<std::string> cells = {"--scene", folder / "room.obj", "--visibility"};
    std::vector<std::string> beside = cells;
    beside.insert(beside.end(), {"--mis", "cosine"});
    ASSERT_EQ(folder.local("room.acdf", cells).code, 0);
    const Result made = folder.local("beside.acdf", beside);
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(run_acdf({"validate", folder / "beside.acdf"}).code, 0);
    const Json info = Json::parse(run_acdf({"info", "--json", folder / "beside.acdf"}).out);
    EXPECT_NE(std::string(info.at("options")).find(" --visibility --mis cosine"), std::string::npos);
    File file;
    ASSERT_TRUE(File::open((folder / "beside.acdf").c_str(), file).ok());
    EXPECT_FALSE(file.local().requires_mis());
    EXPECT_NE(read_text(folder / "room.acdf"), read_text(folder / "beside.acdf"));
    for (const char* option : {"--shares", "--heuristic", "--cosine-share"}) {
        std::vector<std::string> more = beside;
        more.insert(more.end(), {option, std::string(option) == "--shares"      ? "2:1"
                                         : std::string(option) == "--heuristic" ? "power"
                                                                                : "0.2"});
        EXPECT_EQ(folder.local("none.acdf", more).code, 2) << option;
    }
}

TEST(MeshVisibility, AreSampledInPictures) {
    ACDF_NOT_SANITIZED();
    MeshFolder folder;
    const Result made = folder.local("room.acdf", {"--scene", folder / "room.obj", "--visibility", "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.err.find("visibility on 22 triangles"), std::string::npos) << made.err;
    EXPECT_GT(Json::parse(made.out).at("visibility"), 50);
    EXPECT_EQ(run_acdf({"validate", folder / "room.acdf"}).code, 0);
    const Json info = Json::parse(run_acdf({"info", "--json", folder / "room.acdf"}).out);
    EXPECT_GT(info.at("local").at("visibility").at("cells"), 50);
    EXPECT_NE(std::string(info.at("options")).find(" --visibility"), std::string::npos) << info.at("options");
    EXPECT_LE(info.at("bytes"), 65536);
    const Json measured =
        Json::parse(run_acdf({"measure", folder / "room.acdf", "--against", folder / "probe.pfm", "--json"}).out);
    EXPECT_EQ(measured.at("support_violations"), 0);
    EXPECT_FALSE(measured.contains("visibility"));

    std::vector<std::string> sampled_from{"--sampler", "local:64KiB", "--sampler", "file:room.acdf"};
    if (!acdf_test::kSanitized) sampled_from.insert(sampled_from.end(), {"--sampler", "visibility:64KiB"});
    const Result result = folder.render("scene.json", "out", sampled_from);
    ASSERT_EQ(result.code, 0) << result.err;
    const Json samplers = Json::parse(result.out).at("samplers");
    ASSERT_EQ(samplers.size(), sampled_from.size() / 2);
    for (const Json& one : samplers) {
        EXPECT_LT(std::fabs(double(one.at("bias_standard_errors"))), 4.0) << one;
        if (one.at("sampler") == "local:64KiB") continue;
        EXPECT_GT(one.at("equal_samples_gain").at("value"), 2.0) << one;
        if (one.at("sampler") == "file:room.acdf") {
            EXPECT_EQ(one.at("bytes"), info.at("memory_bytes")) << one;
        }
    }
}

/// On the mesh, whichever axis of it points up.
TEST(MeshVisibility, AreMeasuredOnTheirMesh) {
    MeshFolder folder;
    folder.room_file("room.acdf");
    ASSERT_EQ(folder.local("plain.acdf", {}).code, 0);
    const auto measure = [&](const std::string& file, std::vector<std::string> more) {
        std::vector<std::string> arguments{"measure", folder / file, "--against", folder / "probe.pfm", "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_acdf(arguments);
    };
    const Result result = measure("room.acdf", {"--scene", folder / "room.obj", "--points", "40"});
    ASSERT_EQ(result.code, 0) << result.err;
    const Json visibility = Json::parse(result.out).at("visibility");
    EXPECT_GT(visibility.at("points"), 10);
    EXPECT_LE(visibility.at("points"), 40);
    EXPECT_GT(visibility.at("relative_variance"), 0.0);
    EXPECT_NE(visibility.at("gain"), 1.0);
    EXPECT_EQ(visibility.at("support_violations"), 0);
    EXPECT_GE(visibility.at("relative_variance_worst"), visibility.at("relative_variance"));
    if (!acdf_test::kSanitized) { // the same code
        write_text(folder / "y.obj", room(true));
        folder.room_file("y.acdf", true);
        const Result turned = measure("y.acdf", {"--scene", folder / "y.obj", "--scene-up", "y", "--points", "40"});
        ASSERT_EQ(turned.code, 0) << turned.err;
        EXPECT_NEAR(Json::parse(turned.out).at("visibility").at("relative_variance"),
                    visibility.at("relative_variance"), 1e-3);
    }
    const Result text = run_acdf({"measure", folder / "room.acdf", "--against", folder / "probe.pfm", "--scene",
                                  folder / "room.obj", "--points", "9"});
    EXPECT_NE(text.out.find("positions of the scene"), std::string::npos) << text.out;
    const Result by_normals =
        measure("plain.acdf", {"--scene", folder / "room.obj"}); // which stores no visibility cells
    EXPECT_EQ(by_normals.code, 0) << by_normals.err;
    EXPECT_FALSE(Json::parse(by_normals.out).contains("visibility"));
    EXPECT_EQ(measure("plain.acdf", {"--scene", folder / "room.obj", "--points", "9"}).code, 2);
    EXPECT_EQ(measure("room.acdf", {"--scene", folder / "none.obj"}).code, 1);
    EXPECT_EQ(measure("room.acdf", {"--points", "9"}).code, 2);
    EXPECT_EQ(measure("room.acdf", {"--scene-up", "y"}).code, 2);
}

/// What has come and what has gone since the file was made.
TEST(MeshVisibility, OfAnotherSceneAreUnbiased) {
    ACDF_NOT_SANITIZED();
    MeshFolder folder;
    folder.room_file("room.acdf");
    std::string changed = room();
    changed.replace(changed.find("f 5 6 9 10"), 10, "f 7 8 10 9");               // the other half of the roof
    write_text(folder / "changed.obj", changed.substr(0, changed.find("f 15"))); // no box
    write_text(folder / "changed.json", mesh_scene("changed.obj"));
    const Result result = folder.render("changed.json", "out", {"--sampler", "file:room.acdf"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_LT(std::fabs(double(Json::parse(result.out).at("samplers")[0].at("bias_standard_errors"))), 4.0);
}

TEST(MeshVisibility, OfMeshesWithYUpAreThoseOfTheirOwnCoordinates) {
    MeshFolder folder;
    write_text(folder / "y.obj", room(true));
    folder.room_file("z.acdf");
    folder.room_file("y.acdf", true);
    File z, y;
    ASSERT_TRUE(File::open((folder / "z.acdf").c_str(), z).ok());
    ASSERT_TRUE(File::open((folder / "y.acdf").c_str(), y).ok());
    const VisibleLocalView of_z = visible_view(z), of_y = visible_view(y);
    const float n[3] = {0, 0, 1};
    for (int i = 0; i < 200; ++i) {
        const float p[3] = {float(i % 7) * 0.6f - 1.8f, float(i % 11) * 0.35f - 1.8f, float(i % 3) * 0.9f},
                    turned[3] = {p[1], p[2], p[0]};
        const AcdfVisiblePoint a = of_z.at(p, n), b = of_y.at(turned, n);
        ASSERT_TRUE(a.in_cell);
        const DirectionSample s = of_z.sample(a, i / 200.0, 0.3), t = of_y.sample(b, i / 200.0, 0.3);
        // Sums over visible light are rounded in another order: a share of a row may be a step off.
        EXPECT_NEAR(s.pdf, t.pdf, 1e-5f * s.pdf);
        for (int k = 0; k < 3; ++k) EXPECT_EQ(s.direction[k], t.direction[k]);
    }
}

/// The mesh of room() in pbrt's frame: x negated, and triangles wound so that their normals are mirrored ones.
std::string mirrored_room() {
    std::istringstream in(room());
    std::ostringstream out;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line.substr(std::min<std::size_t>(2, line.size())));
        if (line.rfind("v ", 0) == 0) {
            double x = 0, y = 0, z = 0;
            words >> x >> y >> z;
            out << "v " << 0 - x << ' ' << y << ' ' << z << '\n';
        } else if (line.rfind("f ", 0) == 0) {
            std::vector<int> corners;
            for (int c; words >> c;) corners.push_back(c);
            for (std::size_t i = 1; i + 1 < corners.size(); ++i)
                out << "f " << corners[0] << ' ' << corners[i + 1] << ' ' << corners[i] << '\n';
        }
    }
    return out.str();
}

TEST(MeshVisibility, OfAMirroredFrameAreThoseOfTheirOwnCoordinates) {
    ACDF_NOT_SANITIZED();
    MeshFolder folder;
    write_text(folder / "pbrt.obj", mirrored_room());
    folder.room_file("z.acdf");
    const Result told = folder.local("as-is.acdf", {"--scene", folder / "pbrt.obj", "--for", "luxcore"});
    EXPECT_NE(told.err.find("--scene-axes \"(-X, Y, Z)\""), std::string::npos) << told.err;
    const Result made =
        folder.local("x.acdf", {"--scene", folder / "pbrt.obj", "--scene-axes", "(-X, Y, Z)", "--visibility"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Json info = Json::parse(run_acdf({"info", "--json", folder / "x.acdf"}).out);
    EXPECT_NE(std::string(info.at("options")).find(" --scene-axes (-x,y,z) --visibility"), std::string::npos);
    File z, x;
    ASSERT_TRUE(File::open((folder / "z.acdf").c_str(), z).ok());
    ASSERT_TRUE(File::open((folder / "x.acdf").c_str(), x).ok());
    const VisibleLocalView of_z = visible_view(z), of_x = visible_view(x);
    const float n[3] = {0, 0, 1};
    for (int i = 0; i < 200; ++i) {
        const float p[3] = {float(i % 7) * 0.6f - 1.8f, float(i % 11) * 0.35f - 1.8f, float(i % 3) * 0.9f},
                    there[3] = {-p[0], p[1], p[2]};
        const AcdfVisiblePoint a = of_z.at(p, n), b = of_x.at(there, n);
        ASSERT_TRUE(b.in_cell);
        const DirectionSample s = of_z.sample(a, i / 200.0, 0.3);
        EXPECT_NEAR(of_x.pdf(b, s.direction), s.pdf, 0.01 * s.pdf); // normals are summed in another order
    }
}

/// Under the roof the sky above the open half is sampled, and what the roof hides is not.
TEST(MeshVisibility, ArePlotted) {
    MeshFolder folder;
    folder.room_file("room.acdf");
    ASSERT_EQ(folder.local("plain.acdf", {}).code, 0);
    const auto plot = [&](const std::string& file, const std::string& output, std::vector<std::string> more) {
        std::vector<std::string> arguments{"plot", folder / file, "-o", folder / output, "--width", "64"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_acdf(arguments);
    };
    ASSERT_EQ(plot("room.acdf", "here.exr", {"--normal", "0,0,1", "--position", "0,-1,0"}).code, 0);
    ASSERT_EQ(plot("room.acdf", "anywhere.exr", {"--normal", "0,0,1"}).code, 0);
    ASSERT_EQ(plot("room.acdf", "six.png", {"--position", "0,-1,0.1"}).code, 0);
    EXPECT_NE(read_text(folder / "here.exr"), read_text(folder / "anywhere.exr"));
    ASSERT_EQ(plot("room.acdf", "cells.png", {"--scene", folder / "room.obj"}).code, 0);
    ASSERT_EQ(
        plot("room.acdf", "inside.png", {"--scene", folder / "room.obj", "--from", "0,-1.5,1.5", "--to=-1,1,0"})
            .code,
        0);
    EXPECT_NE(read_text(folder / "cells.png"), read_text(folder / "inside.png"));
    EXPECT_EQ(plot("plain.acdf", "no.png", {"--scene", folder / "room.obj"}).code, 1);
    EXPECT_EQ(plot("room.acdf", "no.png", {"--scene", folder / "none.obj"}).code, 1);
    EXPECT_EQ(plot("room.acdf", "no.exr", {"--scene", folder / "room.obj"}).code, 2);
    EXPECT_EQ(plot("room.acdf", "no.png", {"--scene", folder / "room.obj", "--position", "0,0,0"}).code, 2);
    EXPECT_EQ(plot("room.acdf", "no.png", {"--from", "0,0,0"}).code, 2);
    for (const auto& [file, place] : {std::pair{"plain.acdf", "0,0,0"}, {"room.acdf", "0,0,9"}}) {
        const Result refused = plot(file, "no.png", {"--position", place});
        EXPECT_EQ(refused.code, 1);
        EXPECT_EQ(lines_in(refused.err), 1u) << refused.err;
    }
}

/// A file of the mesh itself and one that is made for the picture serve it as well as those of a mesh with z up.
TEST(MeshVisibility, OfMeshesWithYUpServePictures) {
    ACDF_NOT_SANITIZED();
    MeshFolder folder;
    write_text(folder / "y.obj", room(true));
    write_text(folder / "y.json", mesh_scene("y.obj", R"(, "up": "y")"));
    folder.room_file("y.acdf", true);
    const Result result =
        folder.render("y.json", "out",
                      {"--sampler", "local:64KiB", "--sampler", "file:y.acdf", "--sampler", "visibility:64KiB",
                       "--sampler", "product(visibility:64KiB,ggx:0.9)", "--sequence", "independent"},
                      "40");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json samplers = Json::parse(result.out).at("samplers");
    for (const Json& one : samplers) {
        EXPECT_LT(std::fabs(double(one.at("bias_standard_errors"))), 4.0) << one;
        if (one.at("sampler") == "local:64KiB") continue;
        EXPECT_GT(one.at("equal_samples_gain").at("value"), 2.0) << one;
    }
}

/// What others do in rooms, on the mesh itself and on one with y up.
TEST(MeshBaselines, OfRoomsAreUnbiased) {
    ACDF_NOT_SANITIZED();
    MeshFolder folder;
    write_text(folder / "y.obj", room(true));
    write_text(folder / "y.json", mesh_scene("y.obj", R"(, "up": "y")"));
    for (const std::string scene : {"scene.json", "y.json"}) {
        const Result result =
            folder.render(scene, "out-" + scene,
                          {"--sampler", "full-cdf", "--sampler", "portals", "--sampler", "portals:uniform",
                           "--sampler", "mis(portals,cosine)", "--sampler", "visibility-cache:8x4", "--sampler",
                           "mis(visibility-cache:8x4,cosine)", "--sequence", "independent"});
        ASSERT_EQ(result.code, 0) << result.err;
        const Json report = Json::parse(result.out);
        for (const Json& one : report.at("samplers")) {
            EXPECT_LT(std::fabs(double(one.at("bias_standard_errors"))), 4.0) << one;
            if (one.at("sampler") == "full-cdf" || one.at("sampler") == "portals:uniform") continue;
            EXPECT_GT(one.at("equal_samples_gain").at("value"), 2.0) << one;
        }
    }
}

/// A room in two files is one scene: what one of them hides from visibility on the other is known.
TEST(MeshVisibility, OfSeveralFilesAreThoseOfAllTogether) {
    ACDF_NOT_SANITIZED();
    MeshFolder folder;
    const std::string whole = room(), points = whole.substr(0, whole.find('f')),
                      faces = whole.substr(points.size());
    const std::size_t middle = faces.find("f 15");
    write_text(folder / "walls.obj", points + faces.substr(0, middle));
    write_text(folder / "box.obj", points + faces.substr(middle));
    folder.room_file("one.acdf");
    const Result two =
        folder.local("two.acdf", {"--scene", folder / "walls.obj", "--scene", folder / "box.obj", "--visibility"});
    ASSERT_EQ(two.code, 0) << two.err;
    const auto visibility = [&](const std::string& file) {
        return Json::parse(run_acdf({"info", "--json", folder / file}).out).at("local").at("visibility");
    };
    EXPECT_EQ(visibility("one.acdf"), visibility("two.acdf"));
    File a, b;
    ASSERT_TRUE(File::open((folder / "one.acdf").c_str(), a).ok());
    ASSERT_TRUE(File::open((folder / "two.acdf").c_str(), b).ok());
    const AcdfVisibleLocal x = visible_view(a).data(), y = visible_view(b).data();
    ASSERT_EQ(x.cells.header->split_count, y.cells.header->split_count);
    for (std::uint32_t i = 0; i < x.cells.header->split_count; ++i)
        EXPECT_EQ(x.cells.splits[i].position, y.cells.splits[i].position);
}

/// In the middle of the room light comes from above, for whatever hangs there.
TEST(MeshVisibility, InTheAirKnowWhatIsHiddenThere) {
    MeshFolder folder;
    ASSERT_EQ(folder.local("air.acdf", {"--scene", folder / "room.obj", "--visibility", "--volume"}).code, 0);
    File file;
    ASSERT_TRUE(File::open((folder / "air.acdf").c_str(), file).ok());
    const std::string options = Json::parse(run_acdf({"info", "--json", folder / "air.acdf"}).out).at("options");
    EXPECT_NE(options.find("--visibility --volume"), std::string::npos) << options;
    const VisibleLocalView view = visible_view(file);
    const float middle[3] = {0.0f, 1.0f, 1.0f}; // below the half that is open
    double sky = 0.0, alone = 0.0;
    for (const float side : {-1.0f, 1.0f})
        for (int i = 0; i < 400; ++i) {
            const float n[3] = {side, 0.0f, 0.0f};
            const double u = (i % 20 + 0.5) / 20.0, v = (i / 20 + 0.5) / 20.0;
            const auto open = [&](const DirectionSample& s) { return s.pdf > 0.0f && s.direction[2] > 0.5f; };
            sky += open(view.sample(view.at(middle, n), u, v));
            alone += open(view.sample(view.at(n), u, v));
        }
    EXPECT_GT(sky, 1.3 * alone);
    EXPECT_GT(sky, 500.0);
}

/// Ended at any moment of the search for visibility, the program leaves nothing.
TEST(MeshVisibility, LeaveNothingWhereTheyAreCancelled) {
    MeshFolder folder;
    const std::size_t before = folder.entries();
    for (const int milliseconds : {30, 150, 400}) {
        const pid_t pid = start_acdf({"local", folder / "probe.pfm", "-o", folder / "no.acdf", "--scene",
                                      folder / "room.obj", "--visibility", "--budget", "4MB", "--quiet"},
                                     "/dev/null", "/dev/null", "/dev/null");
        ASSERT_GT(pid, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        kill(pid, SIGINT);
        EXPECT_NE(wait_for(pid), 0);
        EXPECT_EQ(folder.entries(), before);
    }
}

TEST(MeshVisibility, MistakesAreOneLine) {
    MeshFolder folder;
    write_text(folder / "broken.obj", "v 0 0 0\n");
    const auto refused = [&](const std::vector<std::string>& options, int code, const std::string& part) {
        const Result result = folder.local("no.acdf", options);
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "no.acdf"));
    };
    refused({"--visibility"}, 2, "--visibility");
    refused({"--visibility", "--scene", folder / "room.obj", "--no-sharing"}, 2, "--visibility");
    refused({"--volume", "--scene", folder / "room.obj"}, 2, "--volume");
    refused({"--visibility", "--scene", folder / "none.obj", "--scene", folder / "room.obj"}, 1, "none.obj");
    refused({"--visibility", "--scene", folder / "probe.pfm"}, 1, "probe.pfm");
    refused({"--visibility", "--scene", folder / "broken.obj"}, 1, "broken.obj");
    write_text(folder / "none.json", mesh_scene("none.obj"));
    const Result missing = folder.render("none.json", "out");
    EXPECT_EQ(missing.code, 1);
    EXPECT_NE(missing.err.find("none.obj"), std::string::npos) << missing.err;
    write_text(folder / "shut.json", small_scene("\"portals\""));
    const Result shut = folder.render("shut.json", "out");
    EXPECT_EQ(shut.code, 1);
    EXPECT_EQ(lines_in(shut.err), 1u) << shut.err;
    EXPECT_NE(shut.err.find("has no portals"), std::string::npos) << shut.err;
}

} // namespace
} // namespace acdf::test
