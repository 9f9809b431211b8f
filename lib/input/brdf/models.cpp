#include "input/brdf/models.h"

#include "compress/trigonometry.h"
#include "input/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>

namespace acdf::input {
namespace {

using Rgb = std::array<double, 3>;

/// What numbers before any key are: of each model its own parameter.
std::string first_parameter(const std::string& model) {
    return model == "lambert" ? "albedo" : model == "ggx" ? "alpha" : model == "cook-torrance" ? "m" : "e";
}

/// "name:key=1,key=1,2": numbers by key. "name:1" is "name:key=1" of the first one.
class Parameters {
public:
    explicit Parameters(const std::string& text) : text_(text) {
        const std::size_t colon = text.find(':');
        if (colon == std::string::npos) return;
        std::string key = first_parameter(text.substr(0, colon));
        for (std::size_t begin = colon + 1, end; begin <= text.size(); begin = end + 1) {
            end = std::min(text.find(',', begin), text.size());
            std::string item = text.substr(begin, end - begin);
            if (const std::size_t equals = item.find('='); equals != std::string::npos) {
                key = item.substr(0, equals);
                item = item.substr(equals + 1);
                if (numbers_.count(key)) fail("'" + key + "' comes twice");
            }
            numbers_[key].push_back(number(item));
        }
    }

    /// Takes the numbers of `key`, at most `most`, each in [low, high]; `otherwise` where it is not given.
    std::vector<double> take(const std::string& key, std::size_t most, double low, double high, double otherwise) {
        const auto at = numbers_.find(key);
        if (at == numbers_.end()) return {otherwise};
        std::vector<double> values = at->second;
        numbers_.erase(at);
        if (values.size() > most) fail("'" + key + "' takes at most " + std::to_string(most) + " numbers");
        for (const double v : values)
            if (!(v >= low && v <= high))
                fail("'" + key + "' is not from " + short_text(low) + " to " + short_text(high));
        return values;
    }
    double one(const std::string& key, double low, double high, double otherwise) {
        return take(key, 1, low, high, otherwise)[0];
    }
    Rgb colour(const std::string& key, double low, double high, double otherwise) {
        const std::vector<double> v = take(key, 3, low, high, otherwise);
        if (v.size() == 2) fail("'" + key + "' takes one number or three");
        return v.size() == 1 ? Rgb{v[0], v[0], v[0]} : Rgb{v[0], v[1], v[2]};
    }
    void finish() const {
        if (!numbers_.empty()) fail("it has no parameter '" + numbers_.begin()->first + "'");
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw input_error(text_, what + "; for example ggx:0.1, ggx:alpha=0.1 or cook-torrance:m=0.2,n=1.5,k=0");
    }
    double number(const std::string& item) const {
        char* end = nullptr;
        const double value = std::strtod(item.c_str(), &end);
        if (item.empty() || *end != '\0' || std::isspace(static_cast<unsigned char>(item[0])))
            fail("'" + item + "' is not a number");
        return value;
    }
    static std::string short_text(double value) {
        char text[32];
        std::snprintf(text, sizeof text, "%g", value);
        return text;
    }

    const std::string& text_;
    std::map<std::string, std::vector<double>> numbers_;
};

/// The half-vector and what models need of it.
struct Half {
    double x, y, z; ///< of wh
    double dot;     ///< wo . wh
    Half(const double wo[3], const double wi[3]) : x(wo[0] + wi[0]), y(wo[1] + wi[1]), z(wo[2] + wi[2]) {
        const double length = std::sqrt(x * x + y * y + z * z);
        x /= length, y /= length, z /= length;
        // Of both, so that exchanging them changes no bit: wo . wh = wi . wh = |wo + wi| / 2.
        dot = std::min(1.0, 0.5 * length);
    }
};

/// What lies above the horizon, made finite.
class Model : public Brdf {
public:
    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const final {
        Rgb value = {0.0, 0.0, 0.0};
        if (wo[2] > 0.0 && wi[2] > 0.0) value = above(wo, wi);
        for (std::size_t c = 0; c < 3; ++c)
            rgb[c] = value[c] > 0.0 ? std::min(value[c], std::numeric_limits<double>::max()) : 0.0;
    }

protected:
    virtual Rgb above(const double wo[3], const double wi[3]) const = 0;
};

Rgb scaled(const Rgb& colour, double factor) {
    return {colour[0] * factor, colour[1] * factor, colour[2] * factor};
}

class Lambert : public Model {
public:
    explicit Lambert(Parameters& p) : albedo_(p.colour("albedo", 0.0, 1.0, 1.0)) {}

private:
    Rgb above(const double*, const double*) const override { return scaled(albedo_, 1.0 / compress::pi); }
    Rgb albedo_;
};

class Ggx : public Model {
public:
    explicit Ggx(Parameters& p) : f0_(p.colour("f0", 0.0, 1.0, 1.0)) {
        const std::vector<double> alpha = p.take("alpha", 2, 1e-4, 10.0, 0.1);
        alpha_x_ = alpha.front(), alpha_y_ = alpha.back();
        isotropic = mirror = alpha_x_ == alpha_y_;
    }

private:
    Rgb above(const double wo[3], const double wi[3]) const override {
        const Half h(wo, wi);
        const double x = h.x / alpha_x_, y = h.y / alpha_y_, s = x * x + y * y + h.z * h.z;
        const double d = 1.0 / (compress::pi * alpha_x_ * alpha_y_ * s * s);
        const double masked = 2.0 * (wo[2] * norm(wi) + wi[2] * norm(wo)); // 4 cos cos / G
        const double f = std::pow(1.0 - h.dot, 5.0);
        return scaled({f0_[0] + (1.0 - f0_[0]) * f, f0_[1] + (1.0 - f0_[1]) * f, f0_[2] + (1.0 - f0_[2]) * f},
                      d / masked);
    }
    /// cos (1 + 2 Lambda) of Smith's Lambda.
    double norm(const double w[3]) const {
        const double x = alpha_x_ * w[0], y = alpha_y_ * w[1];
        return std::sqrt(x * x + y * y + w[2] * w[2]);
    }
    Rgb f0_;
    double alpha_x_, alpha_y_;
};

/// Reflectance of a flat surface of index n + ik for unpolarised light (Born and Wolf, Principles of Optics,
/// §14.2).
double fresnel(double cosine, double n, double k) {
    const double cos2 = cosine * cosine, sin2 = 1.0 - cos2;
    const double t = n * n - k * k - sin2;
    const double a2b2 = std::sqrt(t * t + 4.0 * n * n * k * k);
    const double a = std::sqrt(std::max(0.0, 0.5 * (a2b2 + t)));
    const double s = (a2b2 + cos2 - 2.0 * a * cosine) / (a2b2 + cos2 + 2.0 * a * cosine);
    const double q = 2.0 * a * cosine * sin2, r = cos2 * a2b2 + sin2 * sin2;
    const double p = r + q > 0.0 ? s * (r - q) / (r + q) : s;
    return std::clamp(0.5 * (s + p), 0.0, 1.0);
}

class CookTorrance : public Model {
public:
    explicit CookTorrance(Parameters& p)
        : m_(p.one("m", 1e-4, 10.0, 0.2)), n_(p.colour("n", 0.01, 100.0, 1.5)), k_(p.colour("k", 0.0, 100.0, 0.0)) {
    }

private:
    Rgb above(const double wo[3], const double wi[3]) const override {
        const Half h(wo, wi);
        const double cos2 = h.z * h.z, tan2 = (h.x * h.x + h.y * h.y) / cos2;
        const double d = std::exp(-tan2 / (m_ * m_)) / (compress::pi * m_ * m_ * cos2 * cos2);
        // G / (4 cos cos), each branch with what cancels taken out.
        const double low = std::min(wo[2], wi[2]), high = std::max(wo[2], wi[2]);
        const double masked = std::min(0.25 / (low * high), 0.5 * h.z / (h.dot * high));
        Rgb out;
        for (std::size_t c = 0; c < 3; ++c) out[c] = d * masked * fresnel(h.dot, n_[c], k_[c]);
        return out;
    }
    double m_;
    Rgb n_, k_;
};

class Blinn : public Model {
public:
    explicit Blinn(Parameters& p) : e_(p.one("e", 0.0, 1e7, 100.0)), albedo_(p.colour("albedo", 0.0, 1.0, 1.0)) {
        scale_ = (e_ + 2.0) * (e_ + 4.0) / (8.0 * compress::pi * (std::exp2(-0.5 * e_) + e_));
    }

private:
    Rgb above(const double wo[3], const double wi[3]) const override {
        return scaled(albedo_, scale_ * std::pow(Half(wo, wi).z, e_));
    }
    double e_, scale_;
    Rgb albedo_;
};

using Maker = std::unique_ptr<Brdf> (*)(Parameters&);

template <class T>
std::unique_ptr<Brdf> make(Parameters& parameters) {
    return std::make_unique<T>(parameters);
}

const std::map<std::string, Maker>& makers() {
    static const std::map<std::string, Maker> all = {{"lambert", make<Lambert>},
                                                     {"ggx", make<Ggx>},
                                                     {"cook-torrance", make<CookTorrance>},
                                                     {"blinn", make<Blinn>}};
    return all;
}

} // namespace

bool is_model(const std::string& text) { return makers().count(text.substr(0, text.find(':'))) > 0; }

std::unique_ptr<Brdf> model_brdf(const std::string& text) {
    if (!is_model(text))
        throw input_error(text, "there is no model of this name; there are lambert, ggx, cook-torrance and blinn");
    Parameters parameters(text);
    std::unique_ptr<Brdf> brdf = makers().at(text.substr(0, text.find(':')))(parameters);
    parameters.finish();
    brdf->name = text;
    return brdf;
}

} // namespace acdf::input
