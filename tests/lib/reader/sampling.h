// Files of random trees, for the tests of samples and pdfs.
#pragma once

#include "tests/inputs/directions.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/random_halvings.h"

#include <acdf/curves/curves.h>
#include <acdf/environment_view.h>

#include <gtest/gtest.h>

#include <memory>

namespace acdf_test {

struct Loaded {
    Bytes bytes;
    acdf::File file;
    acdf::EnvironmentView view;
};

// Keeps the bytes beside the file that uses them.
inline std::unique_ptr<Loaded> loaded(EnvironmentSpec spec) {
    auto out = std::unique_ptr<Loaded>(new Loaded{spec.encode(), {}, acdf::EnvironmentView()});
    const acdf::Status status =
        acdf::File::from_memory(out->bytes.data(), out->bytes.size(), out->file, acdf::with_curves());
    EXPECT_TRUE(status.ok()) << status.message;
    if (status.ok()) out->view = out->file.environment();
    return out;
}

// Trees of both parameterizations: the first `latlong_count` are lat-long, the others octahedral.
constexpr std::uint32_t latlong_count = 120, tree_count = 2 * latlong_count;

inline RandomOptions options_of(std::uint32_t seed) {
    RandomOptions options = varied_options(seed, 1024);
    options.tilts = seed % 4 != 0;
    options.dark = seed % 5 != 0;
    options.octahedral = seed >= latlong_count;
    return options;
}

// Through memory: where GCC 12 vectorises the way back to double, it leaves the rounding out.
inline float rounded(double x) {
    volatile float stored = static_cast<float>(x);
    return stored;
}

} // namespace acdf_test
