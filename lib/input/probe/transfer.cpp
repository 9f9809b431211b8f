#include "input/probe/transfer.h"

#include "input/file_name.h"

#include <cmath>
#include <cstdlib>

namespace acdf::input {
namespace {

// 0: sRGB; 1: linear; else a power law.
double declared_gamma(const images::ImageFile& file, bool& declared) {
    const std::string space = lower(file.text("oiio:ColorSpace"));
    declared = true;
    if (file.header().format == "hdr") return 1.0; // whatever it declares: renderers ignore that
    if (space == "srgb") return 0.0;
    if (space == "linear" || space == "scene_linear") return 1.0;
    if (space.rfind("gamma", 0) == 0) {
        const double gamma = std::strtod(space.c_str() + 5, nullptr); // also "gammacorrected2.2": see below
        if (gamma > 0.1 && gamma < 10.0) return gamma;
        const double attribute = file.real("oiio:Gamma", 0.0f);
        if (attribute > 0.1 && attribute < 10.0) return attribute;
    }
    declared = false;
    return 1.0;
}

// IEC 61966-2-1.
double srgb_to_linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

} // namespace

void linearize(Image& image, const images::ImageFile& file) {
    const bool integer = !file.header().floating;
    bool declared = false;
    double gamma = declared_gamma(file, declared);
    if (integer && !declared) gamma = 0.0;
    const std::string curve = gamma == 0.0   ? "the sRGB curve undone"
                              : gamma == 1.0 ? "taken as linear"
                                             : "a gamma of " + std::to_string(gamma) + " undone";
    if (integer) image.warnings.push_back("integer pixels end at 1, so bright lights are clipped; " + curve);
    else if (gamma != 1.0) image.warnings.push_back("the file declares a transfer function; " + curve);
    if (gamma == 1.0) return;
    for (float& v : image.rgb) {
        if (!(v > 0.0f)) continue; // bad texels are counted later
        v = static_cast<float>(gamma == 0.0 ? srgb_to_linear(v) : std::pow(static_cast<double>(v), gamma));
    }
}

} // namespace acdf::input
