// A clear sky with its sun, after A. J. Preetham, P. Shirley and B. Smits, "A Practical Analytic Model for
// Daylight", SIGGRAPH 1999: the luminance and colour of the sky from its table 2 and appendix A.2, and sunlight
// through molecules and aerosols from its appendix A.1. Ozone, mixed gases and vapour, which take a few per cent of
// the sun, are left out. Luminance is in kcd/m^2, RGB is linear with Rec. 709 primaries. C++17, this header alone.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace clear_sky {

using Vector = std::array<double, 3>; // z is up
using Colour = std::array<double, 3>;

constexpr double pi = 3.14159265358979323846;
constexpr double sun_radius = 0.2665 * pi / 180.0;

inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Towards the sun at an hour of solar time, at a latitude and a declination in degrees: +x is south, +y is east.
inline Vector sun_at(double hour, double latitude, double declination) {
    const double turn = pi * (hour - 12.0) / 12.0, l = latitude * pi / 180.0, d = declination * pi / 180.0;
    return {std::sin(l) * std::cos(d) * std::cos(turn) - std::cos(l) * std::sin(d), -std::cos(d) * std::sin(turn),
            std::sin(l) * std::sin(d) + std::cos(l) * std::cos(d) * std::cos(turn)};
}

/// The sky of a sun and a turbidity from 2, very clear, to 6, hazy.
class Sky {
public:
    Sky(const Vector& sun, double turbidity) : sun_(sun), turbidity_(turbidity) {
        const double t = turbidity, zenith = std::acos(std::fmin(1.0, std::fmax(0.0, sun[2])));
        const double chi = (4.0 / 9.0 - t / 120.0) * (pi - 2.0 * zenith);
        const double z3 = zenith * zenith * zenith, z2 = zenith * zenith;
        zenith_ = {(4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192,
                   t * t * (0.00166 * z3 - 0.00375 * z2 + 0.00209 * zenith) +
                       t * (-0.02903 * z3 + 0.06377 * z2 - 0.03202 * zenith + 0.00394) + 0.11693 * z3 -
                       0.21196 * z2 + 0.06052 * zenith + 0.25886,
                   t * t * (0.00275 * z3 - 0.00610 * z2 + 0.00317 * zenith) +
                       t * (-0.04214 * z3 + 0.08970 * z2 - 0.04153 * zenith + 0.00516) + 0.15346 * z3 -
                       0.26756 * z2 + 0.06670 * zenith + 0.26688};
        for (std::size_t i = 0; i < 3; ++i) at_zenith_[i] = perez(i, 1.0, zenith);
        sunlight_ = sunlight();
        const double facing = std::fmax(0.0, sun[2]) * pi * sun_radius * sun_radius;
        const Colour above = sky({0.0, 0.0, 1.0});
        for (std::size_t i = 0; i < 3; ++i) ground_[i] = 0.2 * (sunlight_[i] * facing / pi + above[i]);
    }

    const Vector& sun() const { return sun_; }

    /// The light of the sky from a unit direction, without the sun; below the horizon that of grey ground.
    Colour sky(const Vector& towards) const {
        if (towards[2] <= 0.0) return ground_;
        const double angle = std::acos(std::fmin(1.0, std::fmax(-1.0, dot(towards, sun_))));
        Colour seen;
        for (std::size_t i = 0; i < 3; ++i) seen[i] = zenith_[i] * perez(i, towards[2], angle) / at_zenith_[i];
        const double y = std::fmax(seen[0], 0.0), x = y * seen[1] / seen[2], z = y * (1.0 - seen[1]) / seen[2] - y;
        return {std::fmax(0.0, 3.2406 * x - 1.5372 * y - 0.4986 * z),
                std::fmax(0.0, -0.9689 * x + 1.8758 * y + 0.0415 * z),
                std::fmax(0.0, 0.0557 * x - 0.2040 * y + 1.0570 * z)};
    }

    /// The light of the sun's disc; none of it comes from below the horizon.
    Colour disc(const Vector& towards) const {
        const bool seen = towards[2] > 0.0 && dot(towards, sun_) > std::cos(sun_radius);
        return seen ? sunlight_ : Colour{};
    }

private:
    /// Table 2: i = 0 of luminance Y, 1 and 2 of chromaticity x and y.
    double perez(std::size_t i, double cosine, double angle) const {
        static constexpr double slope[3][5] = {{0.1787, -0.3554, -0.0227, 0.1206, -0.0670},
                                               {-0.0193, -0.0665, -0.0004, -0.0641, -0.0033},
                                               {-0.0167, -0.0950, -0.0079, -0.0441, -0.0109}};
        static constexpr double at_0[3][5] = {{-1.4630, 0.4275, 5.3251, -2.5771, 0.3703},
                                              {-0.2592, 0.0008, 0.2125, -0.8989, 0.0452},
                                              {-0.2608, 0.0092, 0.2102, -1.6537, 0.0529}};
        double c[5];
        for (int k = 0; k < 5; ++k) c[k] = slope[i][k] * turbidity_ + at_0[i][k];
        const double toward = std::cos(angle);
        return (1.0 + c[0] * std::exp(c[1] / std::fmax(cosine, 0.01))) *
               (1.0 + c[2] * std::exp(c[3] * angle) + c[4] * toward * toward);
    }

    /// Appendix A.1, at a wavelength of each channel in micrometres.
    Colour sunlight() const {
        static constexpr double wavelength[3] = {0.61, 0.55, 0.465};
        const double elevation = std::asin(std::fmin(1.0, std::fmax(0.0, sun_[2]))) * 180.0 / pi;
        const double mass = 1.0 / (std::sin(elevation * pi / 180.0) + 0.15 * std::pow(elevation + 3.885, -1.253));
        const double aerosols = 0.04608 * turbidity_ - 0.04586;
        Colour out;
        for (int i = 0; i < 3; ++i)
            out[i] = 1.9e6 * std::exp(-0.008735 * std::pow(wavelength[i], -4.08) * mass) *
                     std::exp(-aerosols * std::pow(wavelength[i], -1.3) * mass);
        return out;
    }

    Vector sun_;
    double turbidity_;
    Colour zenith_{}, at_zenith_{}, sunlight_{}, ground_{};
};

/// Towards a point of a lat-long map, of positions in texels, whose centre shows +x and whose first row touches +z.
inline Vector towards(double column, double row, int width) {
    const double phi = pi - 2.0 * pi * column / width, theta = 2.0 * pi * row / width;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The map, width / 2 rows of RGB from the top: the sky at the middle of each texel, the sun by its share of it.
inline std::vector<float> latlong(const Sky& sky, int width) {
    constexpr int across = 16; // points of a texel near the sun
    const double near = std::cos(sun_radius + 4.0 * pi / width);
    std::vector<float> rgb;
    rgb.reserve(std::size_t{3} * width * (width / 2));
    for (int row = 0; row < width / 2; ++row)
        for (int column = 0; column < width; ++column) {
            const Vector middle = towards(column + 0.5, row + 0.5, width);
            Colour light = sky.sky(middle);
            if (dot(middle, sky.sun()) > near)
                for (int k = 0; k < across * across; ++k) {
                    const Colour part = sky.disc(
                        towards(column + (k % across + 0.5) / across, row + (k / across + 0.5) / across, width));
                    for (int i = 0; i < 3; ++i) light[i] += part[i] / (across * across);
                }
            for (const double value : light) rgb.push_back(static_cast<float>(value));
        }
    return rgb;
}

} // namespace clear_sky
