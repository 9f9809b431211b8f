// Directions, and BRDF files made in memory, for the tests.
#pragma once

#include "input/brdf/brdf.h"
#include "input/probe/probe.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace acdf::test {

constexpr double kPi = 3.14159265358979323846;
using Direction = std::array<double, 3>;
using Rgb = std::array<double, 3>;
using Bytes = std::vector<std::uint8_t>;

inline Direction at_angles(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Uniform over the hemisphere.
inline Direction random_direction(std::mt19937_64& random) {
    const auto u = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const double z = 1.0 - u(), phi = 2.0 * kPi * u(), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

inline Direction turned(const Direction& w, double phi) {
    return {std::cos(phi) * w[0] - std::sin(phi) * w[1], std::sin(phi) * w[0] + std::cos(phi) * w[1], w[2]};
}

inline Direction mirrored(const Direction& w) { return {w[0], -w[1], w[2]}; }

inline Rgb rho(const input::Brdf& brdf, const Direction& wo, const Direction& wi) {
    Rgb rgb = {-1.0, -1.0, -1.0};
    brdf.evaluate(wo.data(), wi.data(), rgb.data());
    return rgb;
}

inline double mean_of(const Rgb& rgb) { return (rgb[0] + rgb[1] + rgb[2]) / 3.0; }

/// Share of the light from wo that is reflected, by a midpoint sum over half-vectors, dense where highlights are.
inline Rgb albedo(const input::Brdf& brdf, const Direction& wo, int steps = 300) {
    Rgb sum = {0.0, 0.0, 0.0};
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps, theta = 0.5 * kPi * t * t * t;
        const double d_theta = 1.5 * kPi * t * t / steps;
        for (int j = 0; j < steps; ++j) {
            const Direction h = at_angles(theta, 2.0 * kPi * (j + 0.5) / steps);
            const double dot = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2];
            const Direction wi = {2.0 * dot * h[0] - wo[0], 2.0 * dot * h[1] - wo[1], 2.0 * dot * h[2] - wo[2]};
            if (!(dot > 0.0 && wi[2] > 0.0)) continue;
            const Rgb value = rho(brdf, wo, wi);
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += value[c] * wi[2] * 4.0 * dot * std::sin(theta) * d_theta * 2.0 * kPi / steps;
        }
    }
    return sum;
}

/// The message with which `action` refuses; empty if it does not. Fails unless it is one line.
template <class Action>
std::string refusal_of(const Action& action) {
    try {
        action();
    } catch (const input::Error& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        return text;
    }
    return {};
}

#define EXPECT_REFUSED(action, part)                                                                               \
    do {                                                                                                           \
        const std::string refusal_text = ::acdf::test::refusal_of([&] { (void)(action); });                        \
        EXPECT_NE(refusal_text.find(part), std::string::npos) << "refusal: '" << refusal_text << "'";              \
    } while (0)

/// Writes a tensor file; `type` as in input::TensorType.
class TensorWriter {
public:
    void add(const std::string& name, std::uint8_t type, const std::vector<std::uint64_t>& shape, Bytes data) {
        fields_.push_back({name, type, shape, std::move(data)});
    }
    void floats(const std::string& name, const std::vector<std::uint64_t>& shape,
                const std::vector<float>& values) {
        Bytes data(values.size() * sizeof(float));
        if (!data.empty()) std::memcpy(data.data(), values.data(), data.size());
        add(name, 10, shape, std::move(data));
    }
    Bytes bytes() const {
        std::size_t start = 18;
        for (const Field& f : fields_) start += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
        Bytes out, payload;
        append(out, "tensor_file", 12);
        out.push_back(1), out.push_back(0);
        number(out, static_cast<std::uint32_t>(fields_.size()));
        for (const Field& f : fields_) {
            number(out, static_cast<std::uint16_t>(f.name.size()));
            append(out, f.name.data(), f.name.size());
            number(out, static_cast<std::uint16_t>(f.shape.size()));
            out.push_back(f.type);
            number(out, static_cast<std::uint64_t>(start + payload.size()));
            for (const std::uint64_t length : f.shape) number(out, length);
            payload.insert(payload.end(), f.data.begin(), f.data.end());
        }
        out.insert(out.end(), payload.begin(), payload.end());
        return out;
    }

private:
    struct Field {
        std::string name;
        std::uint8_t type;
        std::vector<std::uint64_t> shape;
        Bytes data;
    };
    static void append(Bytes& out, const void* data, std::size_t size) {
        const auto* const bytes = static_cast<const std::uint8_t*>(data);
        out.insert(out.end(), bytes, bytes + size);
    }
    template <class Number>
    static void number(Bytes& out, Number value) {
        append(out, &value, sizeof value);
    }
    std::vector<Field> fields_;
};

/// What stands in a .bsdf file. Every table is small and of another size, to distinguish them.
struct RglParts {
    std::vector<float> theta = {0.0f, 0.6f, 1.1f, 1.5707964f}, phi = {0.0f};
    std::vector<std::uint64_t> ndf_shape = {3, 5}, sigma_shape = {3, 4}, vndf_size = {7, 6}, colour_size = {4, 5};
    std::vector<float> ndf, sigma, vndf, luminance, colour;
    std::vector<float> wavelengths; ///< empty: RGB
    std::uint8_t jacobian = 1;

    std::uint64_t slices() const { return theta.size() * phi.size(); }
    std::uint64_t bands() const { return wavelengths.empty() ? 3 : wavelengths.size(); }

    /// Random numbers in [low, 1) everywhere.
    void fill(std::uint64_t seed, double low = 0.05) {
        std::mt19937_64 random(seed);
        const auto table = [&](std::uint64_t count) {
            std::vector<float> values(count);
            for (float& v : values)
                v = static_cast<float>(low + (1.0 - low) * static_cast<double>(random() >> 11) * 0x1p-53);
            return values;
        };
        ndf = table(ndf_shape[0] * ndf_shape[1]);
        sigma = table(sigma_shape[0] * sigma_shape[1]);
        vndf = table(slices() * vndf_size[0] * vndf_size[1]);
        luminance = table(slices() * colour_size[0] * colour_size[1]);
        colour = table(slices() * bands() * colour_size[0] * colour_size[1]);
    }
    TensorWriter writer() const {
        const std::uint64_t p = phi.size(), t = theta.size();
        TensorWriter out;
        const std::string text = "made for a test";
        out.add("description", 1, {text.size()}, Bytes(text.begin(), text.end()));
        out.floats("phi_i", {p}, phi);
        out.floats("theta_i", {t}, theta);
        out.floats("sigma", sigma_shape, sigma);
        out.floats("ndf", ndf_shape, ndf);
        out.floats("vndf", {p, t, vndf_size[0], vndf_size[1]}, vndf);
        out.floats("luminance", {p, t, colour_size[0], colour_size[1]}, luminance);
        out.floats(wavelengths.empty() ? "rgb" : "spectra", {p, t, bands(), colour_size[0], colour_size[1]},
                   colour);
        if (!wavelengths.empty()) out.floats("wavelengths", {bands()}, wavelengths);
        out.add("jacobian", 1, {1}, {jacobian});
        return out;
    }
    Bytes bytes() const { return writer().bytes(); }
};

} // namespace acdf::test
