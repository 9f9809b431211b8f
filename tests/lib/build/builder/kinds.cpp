// Local environments, BRDFs and tables by the public library: what the program makes, from every form of input.
#include "tests/inputs/table_files.h"
#include "tests/inputs/write_rgb.h"
#include "tests/lib/build/builder/builder.h"

#include "input/brdf/models.h"
#include "input/sha256.h"

#include <acdf/curves/curves.h>
#include <algorithm>
#include <atomic>

namespace {

using namespace acdf;
using namespace acdf::builder;
using builder::ErrorCode;
using builder::Status;
using namespace acdf::test;

/// A file of 64 x 32 texels of a sky, as the program reads it.
class SkyFile {
public:
    SkyFile() : rgb(sky()), path_(folder_ / "sky.pfm") {
        write_rgb(path_, int(kSkyWidth), int(kSkyHeight), rgb);
        source = {"sky.pfm", input::file_sha256(path_), "", ""};
    }
    Bytes program(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"local", path_});
        return program_bytes(arguments, folder_ / "sky.acdf");
    }
    std::string file(const std::string& name) const { return folder_ / name; }

    std::vector<float> rgb;
    Source source;

private:
    Folder folder_;
    std::string path_;
};

Bytes local_bytes(const SkyFile& sky_file, LocalOptions options) {
    options.source = sky_file.source;
    Local made;
    const Status status = local(pixels_of(sky_file.rgb), options, made);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(made.normals, 256u);
    if (options.bin_target == BinTarget::mean) { // the centre of a bin does not see all that others do
        EXPECT_EQ(made.accuracy.support_violations, 0u);
    }
    File file;
    EXPECT_TRUE(File::from_memory(made.bytes.data(), made.bytes.size(), file, acdf::with_curves()).ok());
    const Text told = file.metadata("fit.options");
    EXPECT_EQ(std::string(told.data, told.size), option_text(options));
    return made.bytes;
}

TEST(BuilderLocal, MakesWhatTheProgramMakes) {
    const SkyFile file;
    LocalOptions options;
    options.goal = Goal::of_budget(32 << 10);
    EXPECT_EQ(local_bytes(file, options), file.program({"--budget", "32KiB"}));
    if (acdf_test::kSanitized) return; // test_build_local makes the others
    options.cosine_share = 0.2;
    options.subdivisions = 4;
    options.tiles = 60;
    EXPECT_EQ(local_bytes(file, options),
              file.program({"--budget", "32KiB", "--cosine-share", "0.2", "--normals", "4", "--tiles", "60"}));
    options = {};
    options.sharing = false;
    options.columns = 6, options.rows = 3;
    options.fit.fit = ACDF_FIT_CDF;
    options.fit.phi_segments = options.fit.theta_segments = 8;
    options.bin_target = BinTarget::centre;
    EXPECT_EQ(local_bytes(file, options), file.program({"--no-sharing", "--normals", "6x3", "--fit", "cdf",
                                                        "--knots", "8x8", "--bin-target", "centre"}));
}

TEST(BuilderLocal, NormalsOfAScene) {
    const SkyFile file;
    write_text(file.file("normals.txt"), "0 0 1 3\n0 0.6 0.8 1\n1 0 0 2\n");
    LocalOptions options;
    options.goal = Goal::of_budget(32 << 10);
    options.normals = {{{0.0f, 0.0f, 1.0f}, 3.0}, {{0.0f, 0.6f, 0.8f}, 1.0}, {{1.0f, 0.0f, 0.0f}, 2.0}};
    options.normals_text = "--scene " + input::file_sha256(file.file("normals.txt"));
    const Bytes made = local_bytes(file, options);
    File read;
    ASSERT_TRUE(File::from_memory(made.data(), made.size(), read, acdf::with_curves()).ok());
    const float up[3] = {0.0f, 0.0f, 1.0f}, down[3] = {0.0f, 0.0f, -1.0f};
    EXPECT_TRUE(read.local().stored(up));
    EXPECT_FALSE(read.local().stored(down));
    std::reverse(options.normals.begin(), options.normals.end()); // the order of a list means nothing to bins
    options.normals[0].weight *= 2.0;
    EXPECT_NE(local_bytes(file, options), made); // but weights do
    const Bytes program = file.program({"--budget", "32KiB", "--scene", file.file("normals.txt")});
    File by_program;
    ASSERT_TRUE(File::from_memory(program.data(), program.size(), by_program, acdf::with_curves()).ok());
    EXPECT_EQ(by_program.metadata("fit.options").size, read.metadata("fit.options").size);
    EXPECT_TRUE(by_program.local().stored(up));
    EXPECT_FALSE(by_program.local().stored(down));
}

TEST(BuilderLocal, Misuse) {
    const std::vector<float> rgb = sky();
    const auto refused = [&](const char* what, const std::function<void(LocalOptions&)>& change) {
        LocalOptions options;
        options.goal = Goal::of_budget(32 << 10);
        change(options);
        Local made;
        EXPECT_EQ(local(pixels_of(rgb), options, made).code, ErrorCode::invalid_argument) << what;
    };
    refused("a zero normal", [](LocalOptions& o) { o.normals = {{{0.0f, 0.0f, 0.0f}, 1.0}}; });
    refused("a NaN normal", [](LocalOptions& o) { o.normals = {{{NAN, 0.0f, 0.0f}, 1.0}}; });
    for (const double weight : {0.0, -1.0, kNan})
        refused("a weight", [&](LocalOptions& o) { o.normals = {{{0.0f, 0.0f, 1.0f}, weight}}; });
    refused("subdivisions", [](LocalOptions& o) { o.subdivisions = 257; });
    refused("columns with sharing", [](LocalOptions& o) { o.columns = o.rows = 4; });
    refused("columns alone", [](LocalOptions& o) { o.columns = 4, o.sharing = false; });
    refused("tiles without sharing", [](LocalOptions& o) { o.tiles = 4, o.sharing = false; });
    refused("a small weight", [](LocalOptions& o) { o.max_weight = 0.5; });
    refused("a bound without sharing", [](LocalOptions& o) { o.max_weight = 9.0, o.sharing = false; });
    refused("a share", [](LocalOptions& o) { o.cosine_share = 1.0; });
    refused("a NaN share", [](LocalOptions& o) { o.cosine_share = kNan; });
    refused("a variance without sharing",
            [](LocalOptions& o) { o.goal = Goal::of_variance(0.1), o.sharing = false, o.fit.fit = ACDF_FIT_CDF; });
    refused("the variance fit without sharing", [](LocalOptions& o) { o.sharing = false; });
}

Bytes brdf_bytes(const Brdf& given, const BrdfOptions& options) {
    BrdfFile made;
    const Status status = brdf(given, options, made);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_GT(made.theta_views, 1u);
    EXPECT_EQ(made.accuracy.support_violations, 0u);
    return made.bytes;
}

TEST(BuilderBrdf, MakesWhatTheProgramMakes) {
    const Folder folder;
    const auto expect_same = [&](const std::string& text, BrdfOptions options, std::vector<std::string> arguments) {
        const auto model = input::model_brdf(text);
        Brdf given;
        given.evaluate = [&](const double wo[3], const double wi[3], double rgb[3]) {
            model->evaluate(wo, wi, rgb);
        };
        given.isotropic = model->isotropic;
        given.mirrored = model->mirror;
        options.source.name = text;
        arguments.insert(arguments.begin(), {"brdf", text});
        EXPECT_EQ(brdf_bytes(given, options), program_bytes(arguments, folder / "b.acdf")) << text;
    };
    BrdfOptions options;
    options.goal = Goal::of_budget(6 << 10);
    options.theta_views = 6;
    expect_same("ggx:alpha=0.2", options, {"--budget", "6KiB", "--views", "6"});
    if (acdf_test::kSanitized) return; // the same code, with other options
    options.channels = {ACDF_CHANNELS_LARGEST, {1.0, 1.0, 1.0}};
    options.diffuse_share = 0.1f;
    options.theta_views = 3, options.phi_views = 4;
    expect_same("ggx:alpha=0.2,0.5,f0=0.9", options,
                {"--budget", "6KiB", "--channel", "max", "--diffuse-floor", "0.1", "--views", "3x4"});
    options = {};
    options.fit = ACDF_FIT_CDF;
    options.theta_views = 4;
    expect_same("blinn:e=20", options, {"--fit", "cdf", "--views", "4"});
}

TEST(BuilderBrdf, Tables) {
    const Folder folder;
    const ShapeVector shape{6, 1, 8, 12};
    const input::NpyArray values = array_of(shape, [](const ShapeVector& at) {
        return 0.2 + 3.0 / (1.0 + at[2] * at[2]) + 0.05 * (at[3] < 6 ? at[3] : 11 - at[3]) + 0.02 * at[0];
    });
    write_text(folder / "b.npy", npy_file(values.values, shape));
    Array array;
    array.data = values.values.data();
    array.shape = shape;
    Brdf tabular;
    ASSERT_TRUE(tabulated(array, tabular).ok());
    EXPECT_TRUE(tabular.isotropic);
    EXPECT_TRUE(tabular.mirrored);
    BrdfOptions options;
    options.goal = Goal::of_budget(16 << 10);
    options.theta_views = 6;
    options.source = {"b.npy", input::file_sha256(folder / "b.npy"), "", ""};
    EXPECT_EQ(brdf_bytes(tabular, options),
              program_bytes({"brdf", folder / "b.npy", "--budget", "16KiB", "--views", "6"}, folder / "b.acdf"));
    array.shape = {6, 8, 12};
    EXPECT_EQ(tabulated(array, tabular).code, ErrorCode::invalid_argument);
    EXPECT_FALSE(tabular.evaluate);
    std::vector<float> bad(6 * 8 * 12, 1.0f);
    bad[3] = NAN;
    array.data = bad.data();
    array.shape = shape;
    EXPECT_EQ(tabulated(array, tabular).code, ErrorCode::bad_source);
}

TEST(BuilderBrdf, Misuse) {
    BrdfFile made;
    BrdfOptions options;
    options.goal = Goal::of_budget(12 << 10);
    options.theta_views = 2;
    Brdf given;
    EXPECT_EQ(brdf(given, options, made).code, ErrorCode::invalid_argument);
    given.evaluate = [](const double*, const double*, double*) { throw 3; };
    EXPECT_EQ(brdf(given, options, made).code, ErrorCode::callback_failed);
    std::atomic<bool> asked_below{false};
    const auto answers = [&](double r) {
        given.evaluate = [r, &asked_below](const double* wo, const double* wi, double rgb[3]) {
            if (!(wo[2] > 0.0) || !(wi[2] > 0.0)) asked_below = true;
            rgb[0] = rgb[1] = rgb[2] = r;
        };
        return brdf(given, options, made).code;
    };
    EXPECT_EQ(answers(0.0), ErrorCode::no_energy);
    EXPECT_EQ(answers(-1.0), ErrorCode::no_energy);
    for (const double dark : {1e-101, 1e-160, 1e-310}) EXPECT_EQ(answers(dark), ErrorCode::no_energy) << dark;
    for (const double bad : {kNan, 1e19, std::numeric_limits<double>::infinity()})
        EXPECT_EQ(answers(bad), ErrorCode::bad_source) << bad;
    options.channels.weights = {1e6, 1e6, 1e6};
    EXPECT_EQ(answers(9.9e17), ErrorCode::none);
    const double variance = made.accuracy.relative_variance;
    options.channels = {};
    EXPECT_EQ(answers(0.3), ErrorCode::none);
    EXPECT_NEAR(made.accuracy.relative_variance, variance, 1e-4);
    EXPECT_EQ(answers(1e-99), ErrorCode::none);
    EXPECT_NEAR(made.accuracy.relative_variance, variance, 1e-4);
    given.evaluate = [](const double* wo, const double* wi, double rgb[3]) { // one view in two is next to black
        rgb[0] = rgb[1] = rgb[2] = (wo[2] > 0.5 ? 1.0 : 1e-200) * (wi[0] * wi[0] < 0.1 ? 1.0 : 0.2);
    };
    EXPECT_EQ(brdf(given, options, made).code, ErrorCode::none);
    const double half_black = made.accuracy.relative_variance;
    given.evaluate = [](const double* wo, const double* wi, double rgb[3]) {
        rgb[0] = rgb[1] = rgb[2] = wo[2] > 0.5 ? wi[0] * wi[0] < 0.1 ? 1.0 : 0.2 : 0.0;
    };
    EXPECT_EQ(brdf(given, options, made).code, ErrorCode::none);
    EXPECT_EQ(made.accuracy.relative_variance, half_black);
    EXPECT_FALSE(asked_below); // nothing is reflected below the surface
    const auto refused = [&](const std::function<void(BrdfOptions&)>& change) {
        BrdfOptions changed = options;
        change(changed);
        return brdf(given, changed, made).code == ErrorCode::invalid_argument && made.bytes.empty();
    };
    EXPECT_TRUE(refused([](BrdfOptions& o) { o.theta_views = 1; }));
    EXPECT_TRUE(refused([](BrdfOptions& o) { o.theta_views = 8, o.phi_views = 2; }));
    EXPECT_TRUE(refused([](BrdfOptions& o) { o.theta_views = 0, o.phi_views = 8; }));
    EXPECT_TRUE(refused([](BrdfOptions& o) { o.diffuse_share = NAN; }));
    EXPECT_TRUE(refused([](BrdfOptions& o) { o.max_weight = 0.5; }));
    EXPECT_TRUE(refused([](BrdfOptions& o) { o.max_weight = kNan; }));
    EXPECT_TRUE(refused([](BrdfOptions& o) { o.max_weight = 9.0, o.fit = ACDF_FIT_CDF; }));
    EXPECT_TRUE(refused([](BrdfOptions& o) { o.goal = Goal::of_variance(kNan); }));
    EXPECT_TRUE(refused([](BrdfOptions& o) { o.fit = static_cast<AcdfFit>(5); }));
    options.goal = Goal::of_budget(300);
    EXPECT_EQ(brdf(given, options, made).code, ErrorCode::out_of_reach);
}

Bytes table_bytes(const Array& array, const TableOptions& options) {
    Table made;
    const Status status = table(array, options, made);
    EXPECT_TRUE(status.ok()) << status.message;
    return made.bytes;
}

TEST(BuilderTable, MakesWhatTheProgramMakesOfAnyLayout) {
    const Folder folder;
    const ShapeVector shape{3, 8, 10};
    const std::vector<float> values = noisy_array(shape, 5).values;
    TableOptions options;
    options.indexed = 1;
    options.names = {"t", "u", "v"};
    options.ranges = {{0.0, 3.0}, {-1.0, 1.0}, {0.0, 10.0}};
    options.max_weight = 30.0;
    Array array;
    array.data = values.data();
    array.shape = shape;
    for (const bool wide : {false, true}) {
        std::vector<double> large(values.begin(), values.end());
        if (wide)
            for (double& v : large) v *= 1e60; // more than a float32 holds
        write_text(folder / "t.npy", wide ? npy_file(large, shape) : npy_file(values, shape));
        options.source = {"t.npy", input::file_sha256(folder / "t.npy"), "", ""};
        if (wide) array.data = large.data(), array.number = Number::float64;
        const Bytes expected = program_bytes({"table", folder / "t.npy", "--indexed", "1", "--names", "t,u,v",
                                              "--range", "u=-1:1", "--max-weight", "30"},
                                             folder / "t.acdf");
        EXPECT_EQ(table_bytes(array, options), expected) << wide;
    }
    array.data = values.data();
    array.number = Number::float32;
    const Bytes expected = table_bytes(array, options);
    std::vector<float> turned(values.size()), reversed(values.rbegin(), values.rend());
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 8; ++j)
            for (std::size_t k = 0; k < 10; ++k) turned[i + 3 * (j + 8 * k)] = values[(i * 8 + j) * 10 + k];
    array.data = turned.data();
    array.strides = {4, 12, 96};
    EXPECT_EQ(table_bytes(array, options), expected);
    array.data = &reversed.back();
    array.strides = {-320, -40, -4};
    EXPECT_EQ(table_bytes(array, options), expected);
}

TEST(BuilderTable, BadNumbersAndMisuse) {
    std::vector<float> values(24, 1.0f);
    values[7] = -1.0f, values[9] = NAN;
    Array array;
    array.data = values.data();
    array.shape = {4, 6};
    Table made;
    const Status status = table(array, {}, made);
    EXPECT_EQ(status.code, ErrorCode::bad_source);
    EXPECT_NE(std::string(status.message).find("1 NaN, 1 negative, the first at [1, 1]"), std::string::npos);
    TableOptions zero;
    zero.bad_as_zero = true;
    ASSERT_TRUE(table(array, zero, made).ok());
    EXPECT_EQ(made.bad.nan, 1u);
    EXPECT_EQ(made.bad.negative, 1u);
    EXPECT_EQ(made.bad.first, 7u);
    EXPECT_DOUBLE_EQ(made.total, 22.0);
    const auto refused = [&](const char* what, const std::function<void(Array&, TableOptions&)>& change) {
        Array changed = array;
        TableOptions options = zero;
        change(changed, options);
        EXPECT_EQ(table(changed, options, made).code, ErrorCode::invalid_argument) << what;
        EXPECT_TRUE(made.bytes.empty());
    };
    refused("null", [](Array& a, TableOptions&) { a.data = nullptr; });
    refused("no axes", [](Array& a, TableOptions&) { a.shape = {}; });
    refused("seven axes", [](Array& a, TableOptions&) { a.shape = {1, 1, 1, 1, 1, 4, 6}; });
    refused("an empty axis", [](Array& a, TableOptions&) { a.shape = {4, 0}; });
    refused("too many", [](Array& a, TableOptions&) { a.shape = {1u << 31, 1u << 31}; });
    refused("overlap", [](Array& a, TableOptions&) { a.strides = {4, 4}; });
    refused("a stride of 0", [](Array& a, TableOptions&) { a.strides = {0, 4}; });
    refused("a far stride", [](Array& a, TableOptions&) { a.strides = {PTRDIFF_MAX, 4}; });
    refused("one stride", [](Array& a, TableOptions&) { a.strides = {4}; });
    refused("all indexed", [](Array&, TableOptions& o) { o.indexed = 2; });
    refused("names", [](Array&, TableOptions& o) { o.names = {"a", "a"}; });
    refused("a name with a zero", [](Array&, TableOptions& o) { o.names = {std::string("a\0", 2), "b"}; });
    refused("a range", [](Array&, TableOptions& o) { o.ranges = {{0.0, 1.0}, {kNan, 1.0}}; });
    refused("an axis of no width", [](Array&, TableOptions& o) { o.ranges = {{0.0, 1.0}, {1.0, 1.0}}; });
    refused("max_weight", [](Array&, TableOptions& o) { o.max_weight = kNan; });
    values.assign(24, 0.0f);
    EXPECT_EQ(table(array, {}, made).code, ErrorCode::no_energy);
}

} // namespace
