// What the public library answers to misuse, to callbacks that fail, and to a caller who cancels.
#include "tests/lib/build/builder/builder.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>

#include <sys/resource.h>

namespace {

using namespace acdf;
using namespace acdf::builder;
using builder::ErrorCode;
using builder::Status;
using namespace acdf::test;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

void expect_failed(const Status& status, ErrorCode code, const std::string& what = "") {
    EXPECT_EQ(status.code, code) << what << ": " << status.message;
    EXPECT_FALSE(std::string(status.message).empty()) << what;
}

TEST(BuilderErrors, Pixels) {
    const std::vector<float> rgb = sky();
    const auto refused = [&](const char* what, const std::function<void(Pixels&)>& change) {
        Pixels pixels = pixels_of(rgb);
        change(pixels);
        Environment made;
        made.bytes.assign(3, 7);
        expect_failed(environment(pixels, cells(50), made), ErrorCode::invalid_argument, what);
        EXPECT_TRUE(made.bytes.empty()) << what;
    };
    constexpr std::ptrdiff_t far = std::numeric_limits<std::ptrdiff_t>::max();
    refused("null", [](Pixels& p) { p.data = nullptr; });
    refused("no columns", [](Pixels& p) { p.width = 0; });
    refused("no rows", [](Pixels& p) { p.height = 0; });
    refused("too many", [](Pixels& p) { p.width = p.height = 0xFFFFFFFFu; });
    refused("too many columns", [](Pixels& p) { p.width = 65537, p.height = 1; });
    refused("two channels", [](Pixels& p) { p.channels = 2; });
    refused("no channels", [](Pixels& p) { p.channels = 0; });
    refused("a wild number", [](Pixels& p) { p.number = static_cast<Number>(77); });
    refused("a wild projection", [](Pixels& p) { p.projection = static_cast<Projection>(77); });
    refused("2:1 as a disc", [](Pixels& p) { p.projection = Projection::angular; });
    refused("2:1 as a cross", [](Pixels& p) { p.projection = Projection::horizontal_cross; });
    for (const std::ptrdiff_t stride : {far, -far, -far - 1, far / 30}) {
        refused("far rows", [&](Pixels& p) { p.row_stride = stride; });
        refused("far pixels", [&](Pixels& p) { p.pixel_stride = stride; });
    }
    refused("far channels", [](Pixels& p) { p.channel_stride = far; });
    refused("numbers counted, not bytes", [](Pixels& p) { p.row_stride = 3 * kSkyWidth; });
    refused("overlapping pixels", [](Pixels& p) { p.pixel_stride = 8; });
    refused("overlapping channels", [](Pixels& p) { p.channel_stride = 2; });
}

TEST(BuilderErrors, EnvironmentOptions) {
    const std::vector<float> rgb = sky();
    const auto refused = [&](const char* what, const std::function<void(EnvironmentOptions&)>& change) {
        EnvironmentOptions options = cells(50);
        change(options);
        Environment made;
        expect_failed(environment(pixels_of(rgb), options, made), ErrorCode::invalid_argument, what);
    };
    for (const double variance : {kNan, kInfinite, 0.0, -1.0})
        refused("variance", [&](EnvironmentOptions& o) { o.goal = Goal::of_variance(variance); });
    refused("no cells", [](EnvironmentOptions& o) { o.goal = Goal::of_cells(0); });
    refused("too many cells", [](EnvironmentOptions& o) { o.goal = Goal::of_cells(0xFFFFFFFFu); });
    refused("no bytes", [](EnvironmentOptions& o) { o.goal = Goal::of_budget(0); });
    refused("a wild goal", [](EnvironmentOptions& o) { o.goal.kind = static_cast<Goal::Kind>(9); });
    for (const double w : {kNan, kInfinite, -1.0, 0.5})
        refused("max_weight", [&](EnvironmentOptions& o) { o.fit.max_weight = w; });
    refused("an order of halvings", [](EnvironmentOptions& o) { o.fit.order = builder::Order::z; });
    refused("no segments", [](EnvironmentOptions& o) { o.fit.phi_segments = 0; });
    refused("too many segments", [](EnvironmentOptions& o) { o.fit.theta_segments = 1 << 20; });
    for (const double e : {kNan, -0.1, 1.1}) refused("epsilon", [&](EnvironmentOptions& o) { o.fit.epsilon = e; });
    refused("a wild fit", [](EnvironmentOptions& o) { o.fit.fit = static_cast<AcdfFit>(0); });
    refused("no text", [](EnvironmentOptions& o) { o.source.name = "\xE4.exr"; });
    refused("too long a text", [](EnvironmentOptions& o) { o.source.reading.assign(5000, 'x'); });
    refused("a wild codec", [](EnvironmentOptions& o) { o.codec = static_cast<AcdfCodec>(3); });
    refused("no weights", [](EnvironmentOptions& o) { o.target.channels.weights = {0.0, 0.0, 0.0}; });
    refused("NaN weights", [](EnvironmentOptions& o) { o.target.channels.weights.g = kNan; });
    refused("weights of separate channels",
            [](EnvironmentOptions& o) { o.target.channels.mode = ACDF_CHANNELS_SEPARATE; });
    refused("a wild policy", [](EnvironmentOptions& o) { o.target.bad_texels = static_cast<BadTexelPolicy>(9); });
    Environment made;
    Control control;
    control.threads = -1;
    expect_failed(environment(pixels_of(rgb), cells(50), made, control), ErrorCode::invalid_argument);
    expect_failed(environment(Target(), cells(50), made), ErrorCode::invalid_argument);
    expect_failed(environment(Rows{}, cells(50), made), ErrorCode::invalid_argument);
    expect_failed(environment(Rows{4, 2, {}}, cells(50), made), ErrorCode::invalid_argument);
}

TEST(BuilderErrors, BlackAndBadMaps) {
    std::vector<float> rgb(3 * kSkyWidth * kSkyHeight, 0.0f);
    Environment made;
    expect_failed(environment(pixels_of(rgb), cells(50), made), ErrorCode::no_energy);
    EnvironmentOptions options = cells(50);
    options.target.uniform_if_black = true;
    ASSERT_TRUE(environment(pixels_of(rgb), options, made).ok());
    EXPECT_LT(made.accuracy.relative_variance, 1e-6);
    rgb[8] = std::numeric_limits<float>::quiet_NaN(); // mended, and black
    expect_failed(environment(pixels_of(rgb), cells(50), made), ErrorCode::no_energy);
    rgb = sky();
    rgb[3 * 70] = -1.0f;
    options.target.bad_texels = BadTexelPolicy::error;
    const Status refused = environment(pixels_of(rgb), options, made);
    expect_failed(refused, ErrorCode::bad_source);
    EXPECT_NE(std::string(refused.message).find("1 negative texels, the first at 6,1"), std::string::npos)
        << refused.message;
    EnvironmentOptions green = cells(50); // light, but not where it is looked for
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = i % 3 == 0 ? 1.0f : 0.0f;
    green.target.channels.weights = {0.0, 1.0, 0.0};
    expect_failed(environment(pixels_of(rgb), green, made), ErrorCode::no_energy);
}

TEST(BuilderErrors, GoalsOutOfReach) {
    const std::vector<float> rgb = sky();
    EnvironmentOptions options;
    options.goal = Goal::of_budget(100);
    Environment made;
    expect_failed(environment(pixels_of(rgb), options, made), ErrorCode::out_of_reach);
    options.goal = Goal::of_variance(1e-300);
    const Status status = environment(pixels_of(rgb), options, made);
    EXPECT_TRUE(status.ok() || status.code == ErrorCode::out_of_reach) << status.message;
    Local local_made;
    LocalOptions local_options;
    local_options.goal = Goal::of_budget(1000);
    expect_failed(local(pixels_of(rgb), local_options, local_made), ErrorCode::out_of_reach);
}

TEST(BuilderErrors, RowsThatGiveUp) {
    Rows rows{1024, 600, {}};
    Environment made;
    const auto sees = [&](const std::function<bool(std::uint32_t, std::uint32_t, float*)>& read) {
        rows.read = read;
        expect_failed(environment(rows, cells(50), made), ErrorCode::callback_failed);
        EXPECT_TRUE(made.bytes.empty());
    };
    sees([](std::uint32_t, std::uint32_t, float*) { return false; });
    sees([](std::uint32_t first, std::uint32_t count, float* rgb) {
        std::fill_n(rgb, 3 * 1024 * count, 1.0f);
        return first < 300;
    });
    sees([](std::uint32_t, std::uint32_t, float*) -> bool { throw std::runtime_error("disk"); });
    sees([](std::uint32_t, std::uint32_t, float*) -> bool { throw 7; });
}

const int kStops = acdf_test::kSanitized ? 4 : 12;

/// Calls `build` with a caller who cancels at the k-th call of progress, for `stops` such k spread over all that
/// there are.
void expect_cancellable(const std::function<Status(const Control&, Bytes&)>& build, int stops = kStops) {
    Bytes whole;
    std::atomic<int> calls{0}, inside{0};
    double told = 0.0;
    Control control;
    control.progress = [&](double share, const char* what) {
        EXPECT_EQ(inside++, 0); // by one thread at a time
        EXPECT_GE(share, told);
        EXPECT_LE(share, 1.0);
        EXPECT_NE(what, nullptr);
        told = share;
        ++calls;
        --inside;
        return true;
    };
    ASSERT_TRUE(build(control, whole).ok());
    EXPECT_EQ(told, 1.0);
    const int all = calls;
    EXPECT_GE(all, 4);
    for (int stop = 1; stop <= all; stop += std::max(1, all / stops)) {
        std::atomic<int> seen{0};
        control.progress = [&](double, const char*) { return ++seen < stop; };
        Bytes none{1, 2, 3};
        expect_failed(build(control, none), ErrorCode::cancelled,
                      std::to_string(stop) + " of " + std::to_string(all));
        EXPECT_TRUE(none.empty());
        const int after = seen;
        EXPECT_EQ(after, stop); // never called again
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        EXPECT_EQ(seen, after);
    }
    control.progress = [&](double share, const char*) -> bool {
        if (share > 0.3) throw std::runtime_error("no window");
        return true;
    };
    Bytes none;
    expect_failed(build(control, none), ErrorCode::callback_failed);
    Bytes again;
    ASSERT_TRUE(build({}, again).ok());
    EXPECT_EQ(again, whole);
}

/// `call` with the bytes of its result.
template <class Result, class Call>
std::function<Status(const Control&, Bytes&)> taking_bytes(const Call& call) {
    return [call](const Control& control, Bytes& bytes) {
        Result result;
        result.bytes = {9};
        const Status status = call(control, result);
        bytes = result.bytes;
        return status;
    };
}

TEST(BuilderErrors, EnvironmentsCanBeCancelled) {
    const struct {
        Projection projection;
        std::uint32_t side;
        int stops; // resampling takes half a second however small the map is
    } maps[] = {{Projection::latlong, 96, kStops}, {Projection::angular, 20, 2}};
    for (const auto& map : maps) {
        const std::vector<float> rgb = sky(map.side, map.side);
        Pixels pixels = pixels_of(rgb, map.side, map.side);
        pixels.projection = map.projection;
        EnvironmentOptions options;
        options.goal = Goal::of_budget(2000);
        expect_cancellable(taking_bytes<Environment>([=](const Control& control, Environment& made) {
                               return environment(pixels, options, made, control);
                           }),
                           map.stops);
    }
}

TEST(BuilderErrors, OtherKindsCanBeCancelled) {
    const std::vector<float> rgb = sky();
    LocalOptions local_options;
    local_options.goal = Goal::of_budget(16 << 10);
    local_options.subdivisions = 2;
    expect_cancellable(taking_bytes<Local>(
        [&](const Control& control, Local& made) { return local(pixels_of(rgb), local_options, made, control); }));
    Brdf lambert;
    lambert.evaluate = [](const double*, const double*, double out[3]) { out[0] = out[1] = out[2] = 0.3; };
    BrdfOptions brdf_options;
    brdf_options.goal = Goal::of_cells(40);
    brdf_options.theta_views = 2;
    expect_cancellable(taking_bytes<BrdfFile>([&](const Control& control, BrdfFile& made) {
                           return brdf(lambert, brdf_options, made, control);
                       }),
                       4); // looking at a BRDF takes as long for few cells
    Array array;
    array.data = rgb.data();
    array.shape = {kSkyHeight, kSkyWidth, 3};
    expect_cancellable(
        taking_bytes<Table>([&](const Control& control, Table& made) { return table(array, {}, made, control); }));
}

TEST(BuilderErrors, ShortOfMemory) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "sanitizers need address space without end";
    Rows rows{1 << 15, 1 << 15, [](std::uint32_t, std::uint32_t count, float* rgb) { // a target of 4 GiB
                  std::fill_n(rgb, (std::size_t{3} << 15) * count, 1.0f);
                  return true;
              }};
    Environment made;
    ASSERT_TRUE(environment(pixels_of(sky()), cells(50), made).ok()); // threads have their stacks by now
    rlimit before{};
    getrlimit(RLIMIT_AS, &before);
    rlimit tight = before;
    tight.rlim_cur = rlim_t{3} << 30;
    setrlimit(RLIMIT_AS, &tight);
    const Status status = environment(rows, cells(50), made);
    setrlimit(RLIMIT_AS, &before);
    expect_failed(status, ErrorCode::out_of_memory);
    EXPECT_TRUE(made.bytes.empty());
}

} // namespace
