// Files of several maps by the public library: what the program makes, and what is refused.
#include "docs/examples/clear_sky/clear_sky.h"
#include "tests/inputs/write_rgb.h"
#include "tests/lib/build/builder/builder.h"

#include "input/sha256.h"

#include <functional>

namespace {

using namespace acdf;
using namespace acdf::builder;
using namespace acdf::test;
using builder::ErrorCode;
using builder::Status;

constexpr int kMapWidth = 64;

/// Four hours of a morning, in files and in memory.
class MorningMaps {
public:
    MorningMaps() {
        std::string digests;
        for (const char* hour : {"7", "8", "9", "10"}) {
            const clear_sky::Vector sun = clear_sky::sun_at(std::atof(hour), 45.0, 23.44);
            maps.push_back(clear_sky::latlong(clear_sky::Sky(sun, 3.0), kMapWidth));
            suns.push_back({sun[0], sun[1], sun[2]});
            files.push_back(folder_ / (hour + std::string(".pfm")));
            write_rgb(files.back(), kMapWidth, kMapWidth / 2, maps.back());
            digests += input::file_sha256(files.back()) + "\n";
        }
        source = {"7.pfm", input::text_sha256(digests, files[0]), "", ""};
    }
    std::vector<Pixels> pixels() const {
        std::vector<Pixels> out;
        for (const std::vector<float>& map : maps) out.push_back(pixels_of(map, kMapWidth, kMapWidth / 2));
        return out;
    }
    IndexedOptions options() const {
        IndexedOptions out;
        out.axes = {{"time", {7.0, 8.0, 9.0, 10.0}}};
        out.goal = Goal::of_budget(8000);
        out.source = source;
        return out;
    }
    Bytes program(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), files.begin(), files.end());
        arguments.insert(arguments.begin(), "env");
        return program_bytes(arguments, folder_ / "day.acdf");
    }

    std::vector<std::vector<float>> maps;
    std::vector<std::array<double, 3>> suns;
    std::vector<std::string> files;
    Source source;

private:
    Folder folder_;
};

TEST(BuilderMaps, AreWhatTheProgramMakes) {
    const MorningMaps morning;
    const auto expect_same = [&](const IndexedOptions& options, std::vector<std::string> arguments) {
        IndexedFile made;
        const Status status = indexed(morning.pixels(), options, made);
        ASSERT_TRUE(status.ok()) << status.message;
        ASSERT_EQ(made.accuracy.size(), 4u);
        EXPECT_EQ(made.bad_texels.size(), 4u);
        EXPECT_EQ(made.suns, options.sun ? 4u : 0u);
        arguments.insert(arguments.end(), {"--budget", "8000"});
        EXPECT_EQ(made.bytes, morning.program(arguments)) << arguments[0];
        File file;
        ASSERT_TRUE(File::from_memory(made.bytes.data(), made.bytes.size(), file).ok());
        const Text told = file.metadata("fit.options");
        EXPECT_EQ(std::string(told.data, told.size), option_text(options));
    };
    expect_same(morning.options(), {"--axis", "time=7,8,9,10"});
    IndexedOptions options = morning.options();
    options.axes = {{"hour", {7.0, 9.0}}, {"half", {0.0, 1.0}}};
    options.target.filter = ACDF_FILTER_NEAREST;
    options.target.channels = {ACDF_CHANNELS_SEPARATE, {1.0, 1.0, 1.0}};
    options.codec = ACDF_CODEC_ZLIB;
    expect_same(options, {"--axis", "hour=7,9", "--axis", "half=0,1", "--filter", "nearest", "--channel", "rgb",
                          "--compress", "zlib"});
    options = morning.options();
    options.sun = false;
    expect_same(options, {"--axis", "time=7,8,9,10", "--no-sun"});
    options = morning.options();
    std::vector<std::string> arguments = {"--axis", "time=7,8,9,10"};
    for (std::array<double, 3> sun : morning.suns) {
        for (double& coordinate : sun) coordinate = std::floor(1e4 * coordinate); // of any length
        options.suns.push_back(sun);
        arguments.insert(arguments.end(),
                         {"--sun", std::to_string(int(sun[0])) + "," + std::to_string(int(sun[1])) + "," +
                                       std::to_string(int(sun[2]))});
    }
    expect_same(options, arguments);
    const std::string text = option_text(options);
    options.suns[1][0] += 1.0;
    EXPECT_NE(option_text(options), text);
}

TEST(BuilderMaps, RefuseWhatDoesNotFitTogether) {
    const MorningMaps morning;
    const auto fails = [&](ErrorCode code, const char* what,
                           const std::function<void(std::vector<Pixels>&, IndexedOptions&)>& change) {
        std::vector<Pixels> maps = morning.pixels();
        IndexedOptions options = morning.options();
        change(maps, options);
        IndexedFile made;
        made.bytes.assign(3, 7);
        const Status status = indexed(maps, options, made);
        EXPECT_EQ(status.code, code) << what << ": " << status.message;
        EXPECT_FALSE(std::string(status.message).empty()) << what;
        EXPECT_TRUE(made.bytes.empty()) << what;
    };
    const auto refused = [&](const char* what, const std::function<void(IndexedOptions&)>& change) {
        fails(ErrorCode::invalid_argument, what, [&](std::vector<Pixels>&, IndexedOptions& o) { change(o); });
    };
    refused("no axes", [](IndexedOptions& o) { o.axes.clear(); });
    refused("four axes", [](IndexedOptions& o) { o.axes.assign(4, {"time", {0.0, 1.0}}); });
    refused("too few coordinates", [](IndexedOptions& o) { o.axes[0].coordinates.pop_back(); });
    refused("coordinates that fall", [](IndexedOptions& o) { o.axes[0].coordinates[2] = 7.5; });
    refused("NaN", [](IndexedOptions& o) { o.axes[0].coordinates[3] = kNan; });
    refused("one coordinate", [](IndexedOptions& o) { o.axes = {{"a", {1.0}}, {"b", {1.0, 2.0, 3.0, 4.0}}}; });
    refused("no name", [](IndexedOptions& o) { o.axes[0].name.clear(); });
    refused("a long name", [](IndexedOptions& o) { o.axes[0].name = "sixteen letters "; });
    refused("no text", [](IndexedOptions& o) { o.axes[0].name = "\xE4"; });
    refused("a name of the grid", [](IndexedOptions& o) { o.axes[0].name = "phi"; });
    refused("two of a name", [](IndexedOptions& o) { o.axes = {{"a", {1.0, 2.0}}, {"a", {1.0, 2.0}}}; });
    refused("cells", [](IndexedOptions& o) { o.goal = Goal::of_cells(100); });
    refused("too few suns", [](IndexedOptions& o) { o.suns.resize(3); });
    refused("suns that are not wanted", [](IndexedOptions& o) { o.suns.resize(4), o.sun = false; });
    refused("a sun that is nowhere", [](IndexedOptions& o) { o.suns.assign(4, {0.0, kNan, 1.0}); });
    refused("a wild codec", [](IndexedOptions& o) { o.codec = static_cast<AcdfCodec>(3); });
    using Maps = std::vector<Pixels>;
    fails(ErrorCode::invalid_argument, "null", [](Maps& m, IndexedOptions&) { m[2].data = nullptr; });
    fails(ErrorCode::invalid_argument, "no maps", [](Maps& m, IndexedOptions&) { m.clear(); });
    fails(ErrorCode::bad_source, "another size", [](Maps& m, IndexedOptions&) { m[2].height /= 2; });
    fails(ErrorCode::bad_source, "discs", [](Maps& m, IndexedOptions&) {
        for (Pixels& map : m) map.width = map.height, map.projection = Projection::angular;
    });
    fails(ErrorCode::no_energy, "a black map", [](Maps& m, IndexedOptions&) {
        static const std::vector<float> black(std::size_t{3} * kMapWidth * kMapWidth);
        m[3].data = black.data();
    });
    fails(ErrorCode::out_of_reach, "few bytes", [](Maps&, IndexedOptions& o) { o.goal = Goal::of_budget(500); });
    IndexedFile made;
    Control control;
    control.progress = [](double share, const char*) { return share < 0.5; };
    EXPECT_EQ(indexed(morning.pixels(), morning.options(), made, control).code, ErrorCode::cancelled);
}

} // namespace
