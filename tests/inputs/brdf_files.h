// BRDFs of known form and files made of them, for the tests.
#pragma once

#include "build/brdf.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace acdf_test {

using Direction = std::array<float, 3>;

inline Direction at_angles(double cosine, double phi) {
    const double s = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return {float(s * std::cos(phi)), float(s * std::sin(phi)), float(cosine)};
}

/// A lobe around the mirror direction, of width a along x and b along y, over a diffuse base: cheap to evaluate.
class LobeBrdf : public acdf::build::Brdf {
public:
    LobeBrdf(double a, double b, double base = 0.1) : a_(a), b_(b), base_(base) {
        isotropic = mirror = a == b;
        name = "lobe";
    }
    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const override {
        const double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]};
        const double x = h[0] / (h[2] * a_), y = h[1] / (h[2] * b_), q = 1.0 + x * x + y * y;
        const bool lit = wo[2] > 0.0 && wi[2] > 0.0;
        const double value = lit ? base_ + 0.1 / (a_ * b_ * q * q) : 0.0;
        rgb[0] = rgb[1] = rgb[2] = value;
    }

private:
    double a_, b_, base_;
};

/// Not reciprocal: it reflects more the steeper the light comes in, and to one side.
class LopsidedBrdf : public acdf::build::Brdf {
public:
    LopsidedBrdf() {
        isotropic = true;
        mirror = false;
        name = "lopsided";
    }
    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const override {
        const double side = wo[0] * wi[1] - wo[1] * wi[0];
        rgb[0] = rgb[1] = rgb[2] = wi[2] > 0.0 && wo[2] > 0.0 ? wi[2] * wi[2] * (1.0 + 0.9 * side) : 0.0;
    }
};

/// A file made in memory, and what it stands for.
struct MadeBrdf {
    std::unique_ptr<acdf::build::Brdf> source;
    acdf::build::BrdfFile made;
    acdf::File file;
    acdf::compress::Reflected reflected;

    acdf::BrdfView view() const { return file.brdf(); }
};

inline std::unique_ptr<MadeBrdf> make_brdf(std::unique_ptr<acdf::build::Brdf> source,
                                           const acdf::build::BrdfFileOptions& options) {
    auto out = std::make_unique<MadeBrdf>();
    out->source = std::move(source);
    out->made = acdf::build::build_brdf(*out->source, options);
    const acdf::Status status =
        acdf::File::from_memory(out->made.bytes.data(), out->made.bytes.size(), out->file, acdf::with_curves());
    EXPECT_TRUE(status.ok()) << status.message;
    out->reflected = acdf::build::reflected_light(*out->source, options.channels, options.weights);
    return out;
}

/// Options of files whose accuracy is measured roughly: measuring 64 views takes longer than all else.
inline acdf::build::BrdfFileOptions roughly_measured() {
    acdf::build::BrdfFileOptions options;
    options.measured_views = 8;
    return options;
}

inline acdf::build::BrdfFileOptions budget(std::uint64_t bytes) {
    acdf::build::BrdfFileOptions options = roughly_measured();
    options.fit.goal.kind = acdf::compress::Goal::Kind::budget;
    options.fit.goal.budget = bytes;
    return options;
}

} // namespace acdf_test
