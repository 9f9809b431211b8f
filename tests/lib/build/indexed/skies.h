// Maps of clear skies, and files of several.
#pragma once

#include "build/environment.h"
#include "build/indexed/environment.h"
#include "docs/examples/clear_sky/clear_sky.h"

#include <acdf/indexed/views.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace acdf_test {

/// A map, as it is fitted and texel by texel.
struct SkyMap {
    acdf::compress::Target target, texels;

    acdf::build::SunMap view() const { return {&target, &texels, ACDF_FILTER_BILINEAR}; }
};

inline SkyMap sky_map(const std::vector<float>& rgb, int width,
                      AcdfParameterization parameterization = ACDF_PARAM_LATLONG) {
    const auto columns = static_cast<std::uint32_t>(width);
    const std::uint32_t rows = parameterization == ACDF_PARAM_OCTAHEDRAL ? columns : columns / 2;
    acdf::compress::TargetOptions options;
    options.parameterization = parameterization;
    options.filter = ACDF_FILTER_BILINEAR;
    SkyMap out{acdf::compress::environment_target(rgb.data(), columns, rows, options), {}};
    options.filter = ACDF_FILTER_NEAREST;
    out.texels = acdf::compress::environment_target(rgb.data(), columns, rows, options);
    return out;
}

/// 45 degrees north, on the longest day.
inline clear_sky::Sky day_sky(double hour, double turbidity) {
    return clear_sky::Sky(clear_sky::sun_at(hour, 45.0, 23.44), turbidity);
}
inline SkyMap day_map(int width, double hour, double turbidity) {
    return sky_map(clear_sky::latlong(day_sky(hour, turbidity), width), width);
}

/// Maps in one file.
struct SkyFile {
    acdf::build::IndexedEnvironmentFile made;
    acdf::File file;
    acdf::IndexedEnvironment stored;

    SkyFile(const std::vector<SkyMap>& maps, const acdf::build::IndexedOptions& options) {
        std::vector<acdf::build::SunMap> views;
        for (const SkyMap& map : maps) views.push_back(map.view());
        made = acdf::build::build_indexed(views, {}, options);
        EXPECT_LE(made.bytes.size(), options.budget);
        acdf::Status status = acdf::File::from_memory(made.bytes.data(), made.bytes.size(), file);
        EXPECT_TRUE(status.ok()) << status.message;
        status = acdf::IndexedEnvironment::open(file, stored);
        EXPECT_TRUE(status.ok()) << status.message;
    }
    double variance(const acdf::MixedEnvironment& sky, const SkyMap& map) const {
        return acdf::build::measure_mixed(sky, map.view()).relative_variance;
    }
};

inline acdf::build::IndexedOptions along(const std::string& name, const std::vector<double>& coordinates) {
    acdf::build::IndexedOptions options;
    options.target.filter = ACDF_FILTER_BILINEAR;
    options.axes = {{name, coordinates}};
    return options;
}

/// Of a file of `budget` bytes of its own.
inline double own_variance(const SkyMap& map, std::uint64_t budget = 64 << 10) {
    acdf::build::EnvironmentOptions options;
    options.target.filter = ACDF_FILTER_BILINEAR;
    options.fit.goal.kind = acdf::compress::Goal::Kind::budget;
    options.fit.goal.budget = budget;
    return acdf::build::build_environment(map.target, {}, options).accuracy.relative_variance;
}

} // namespace acdf_test
