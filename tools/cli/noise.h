// Variance as people see it: noise, in per cent of a pixel.
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

namespace acdf::tools {

/// Samples per pixel for which noise is reported: a preview, a draft, a frame.
constexpr std::array<std::uint32_t, 3> kToldSamples = {16, 64, 256};

/// Standard deviation of a pixel over its value, of `samples` independent samples of that relative variance each.
inline double noise_of(double relative_variance, std::uint32_t samples) {
    return std::sqrt(relative_variance / samples);
}

/// "12 %", two significant digits; "infinite" where it is.
inline std::string noise_text(double relative_variance, std::uint32_t samples) {
    const double noise = 100.0 * noise_of(relative_variance, samples);
    if (std::isinf(noise)) return "infinite";
    char text[32];
    std::snprintf(text, sizeof text, noise >= 99.5 ? "%.0f %%" : "%.2g %%", noise);
    return text;
}

/// "25 %, 12 %, 6.2 %", of kToldSamples.
inline std::string noise_texts(double relative_variance) {
    std::string out;
    for (const std::uint32_t samples : kToldSamples)
        out += (out.empty() ? "" : ", ") + noise_text(relative_variance, samples);
    return out;
}

/// {"16": 25.1, "64": ...}, in per cent, four significant digits; null where infinite.
inline nlohmann::ordered_json noise_json(double relative_variance) {
    nlohmann::ordered_json out;
    for (const std::uint32_t samples : kToldSamples) {
        char text[32];
        std::snprintf(text, sizeof text, "%.4g", 100.0 * noise_of(relative_variance, samples));
        const double rounded = std::strtod(text, nullptr);
        out[std::to_string(samples)] =
            std::isfinite(rounded) ? nlohmann::ordered_json(rounded) : nlohmann::ordered_json();
    }
    return out;
}

} // namespace acdf::tools
