// Files of measured BRDFs, for the tests that look at how good those are.
#pragma once

#include "tests/inputs/brdf_files.h"
#include "tests/inputs/paths.h"

#include "input/brdf/brdf.h"

#include <filesystem>
#include <map>
#include <string>
#include <utility>

namespace acdf_test {

inline std::string real_brdf_path(const std::string& name) {
    return std::string(acdf_test::kTestData) + "/brdfs/" + name;
}

/// The file of a measured BRDF within so many KiB; each is made once a process.
inline const MadeBrdf& real_brdf(const std::string& name, std::uint64_t kib) {
    static std::map<std::pair<std::string, std::uint64_t>, std::unique_ptr<MadeBrdf>> made;
    std::unique_ptr<MadeBrdf>& brdf = made[{name, kib}];
    if (!brdf) brdf = make_brdf(acdf::input::open_brdf(real_brdf_path(name)), budget(kib << 10));
    return *brdf;
}

#define NEEDS(name)                                                                                                \
    if (!std::filesystem::exists(real_brdf_path(name))) GTEST_SKIP() << real_brdf_path(name) << " is not there"

} // namespace acdf_test
