// The built-in probes of `acdf demo`: what a user without data can try everything on.
#pragma once

#include <string>
#include <vector>

namespace acdf::tools {

/// A lat-long map, RGB, height x width x 3 (docs/conventions.md).
struct DemoProbe {
    std::string name;
    std::string what;
    int width = 0, height = 0;
    std::vector<float> rgb;
};

/// A clear sky with a sun 50,000 times as bright over dark ground; a room with four windows and two lamps; the
/// two area lights of Lawrence et al. 2005, Fig. 4.
std::vector<DemoProbe> demo_probes();

/// Writes an OpenEXR file (half float would clip the sun, so float). Throws Failure.
void write_probe(const DemoProbe& probe, const std::string& path, bool force);

} // namespace acdf::tools
