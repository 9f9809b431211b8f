// BRDFs of callables and of tables.
#include "build/brdf.h"

#include "build/brdf_table.h"
#include "build/builder/arrays.h"
#include "build/builder/guard.h"
#include "build/builder/options.h"
#include "build/builder/sources.h"
#include "build/errors.h"

#include <algorithm>
#include <stdexcept>

namespace acdf::builder {
namespace {

/// A caller's BRDF as the fit sees it.
class Callable : public build::Brdf {
public:
    Callable(const builder::Brdf& brdf, const Source& source) : evaluate_(brdf.evaluate) {
        isotropic = brdf.isotropic;
        mirror = brdf.isotropic && brdf.mirrored;
        asymmetry = brdf.asymmetry;
        name = source.name;
        sha256 = source.sha256;
    }

    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const override {
        std::fill(rgb, rgb + 3, 0.0);
        if (!(wo[2] > 0.0 && wi[2] > 0.0)) return;
        try {
            evaluate_(wo, wi, rgb);
        } catch (...) {
            throw build::CallbackFailed();
        }
        for (int k = 0; k < 3; ++k) {
            if (!(rgb[k] < build::kMostReflectance))
                throw std::invalid_argument("a value of the BRDF is NaN, infinite or above 1e18");
            rgb[k] = std::max(rgb[k], 0.0);
        }
    }

private:
    const std::function<void(const double*, const double*, double*)>& evaluate_;
};

} // namespace

Brdf described(const build::Brdf& brdf) {
    Brdf out;
    out.evaluate = [&brdf](const double wo[3], const double wi[3], double rgb[3]) { brdf.evaluate(wo, wi, rgb); };
    out.isotropic = brdf.isotropic;
    out.mirrored = brdf.mirror;
    out.asymmetry = brdf.asymmetry;
    return out;
}

Status tabulated(const Array& table, Brdf& brdf) noexcept {
    return make_into(brdf, {}, [&](Gate&) {
        check(table);
        require(table.shape.size() == 4, "a BRDF has four axes: theta_o, phi_o, theta_h, phi_h");
        BadNumbers bad;
        build::Array values = to_floats(table, bad);
        if (bad.nan + bad.infinite > 0) throw std::invalid_argument(build::text(bad, table.shape));
        const std::shared_ptr<const build::Brdf> held = build::brdf_of_table(std::move(values));
        Brdf out = described(*held);
        out.evaluate = [held](const double wo[3], const double wi[3], double rgb[3]) {
            held->evaluate(wo, wi, rgb);
        };
        return out;
    });
}

Status brdf(const Brdf& brdf, const BrdfOptions& options, BrdfFile& result, const Control& control) noexcept {
    return make_into(result, control, [&](Gate& gate) {
        require(static_cast<bool>(brdf.evaluate), "brdf.evaluate is empty");
        check(options);
        build::BrdfFile made =
            build::build_brdf(Callable(brdf, options.source), internal(options), gate.part(0.0, 1.0));
        BrdfFile out;
        out.bytes = std::move(made.bytes);
        out.accuracy = made.accuracy;
        out.theta_views = made.theta_views;
        out.phi_views = made.phi_views;
        return out;
    });
}

} // namespace acdf::builder
