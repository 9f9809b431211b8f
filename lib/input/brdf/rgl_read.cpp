#include "input/brdf/rgl.h"

#include "input/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace acdf::input {
namespace {

constexpr char no_file[] = "; give a .bsdf file of the RGL database";

std::vector<float> values_of(const TensorFile& file, const TensorField& field) {
    std::vector<float> values(field.count);
    if (field.count > 0) std::memcpy(values.data(), field.data, field.count * sizeof(float));
    const auto bad = std::count_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
    if (bad > 0)
        throw input_error(file.name(), std::to_string(bad) + " numbers of field '" + field.name +
                                           "' are NaN or infinite; download it again");
    return values;
}

/// Increasing numbers, at least one.
std::vector<float> axis_of(const TensorFile& file, const std::string& name) {
    std::vector<float> axis = values_of(file, file.floats(name, 1));
    if (axis.empty() || std::adjacent_find(axis.begin(), axis.end(), std::greater_equal<>()) != axis.end())
        throw input_error(file.name(), "field '" + name + "' does not increase" + no_file);
    return axis;
}

/// Sets negative values to 0; counts them.
std::size_t clamp_negative(std::vector<float>& values) {
    std::size_t count = 0;
    for (float& v : values)
        if (v < 0.0f) v = 0.0f, ++count;
    return count;
}

class RglReader {
public:
    RglReader(const TensorFile& file, RglTables& out) : file_(file), out_(out) {}

    void read() {
        if (file_.find("M") && !file_.find("vndf"))
            throw input_error(file_.name(),
                              "it is a polarised BRDF (.pbsdf), which is another format and is not read; "
                              "give the .bsdf file of the material");
        read_views();
        out_.ndf = flat("ndf");
        out_.sigma = flat("sigma");
        if (*std::min_element(out_.sigma.values.begin(), out_.sigma.values.end()) <= 0.0f)
            throw input_error(file_.name(),
                              std::string("field 'sigma' has numbers that are not above 0") + no_file);
        out_.vndf = warp("vndf");
        out_.luminance = warp("luminance");
        read_colour();
    }

private:
    /// In radians.
    std::vector<float> angles(const char* name, float least, float most) const {
        std::vector<float> out = axis_of(file_, name);
        if (!(out.front() >= least && out.back() <= most))
            throw input_error(file_.name(),
                              std::string("field '") + name + "' has numbers that are not such angles" + no_file);
        return out;
    }

    void read_views() {
        out_.nodes.theta = angles("theta_i", 0.0f, 1.58f); // they end at pi/2
        out_.nodes.phi = angles("phi_i", -6.3f, 6.3f);     // from -pi to pi, from 0 on, or one
        out_.isotropic = out_.nodes.phi.size() <= 2;
        const TensorField* const flag = file_.find("jacobian");
        if (!flag || flag->type != TensorType::uint8 || flag->count != 1)
            throw input_error(file_.name(), std::string("field 'jacobian' is missing or not one byte") + no_file);
        out_.jacobian = *flag->data != 0;
        if (const TensorField* const text = file_.find("description"); text && text->type == TensorType::uint8)
            out_.description.assign(text->data, text->data + text->count);
        if (out_.isotropic) return;
        const double range =
            static_cast<double>(out_.nodes.phi.back()) - static_cast<double>(out_.nodes.phi.front());
        const double reduction = std::rint(2.0 * 3.14159265358979323846 / range);
        if (reduction != 1.0 && reduction != 2.0 && reduction != 4.0)
            throw input_error(file_.name(),
                              "field 'phi_i' covers neither the circle nor a half or a quarter of it" +
                                  std::string(no_file));
        out_.reduction = static_cast<int>(reduction);
    }

    void check(bool shape_fits, const char* name) const {
        if (!shape_fits)
            throw input_error(file_.name(),
                              std::string("the shape of field '") + name + "' does not fit the others" + no_file);
    }

    void note_negative(std::size_t count, std::size_t all, const std::string& name, const char* what) {
        if (count > 0)
            out_.notes.push_back(std::to_string(count) + " of " + std::to_string(all) + " numbers of '" + name +
                                 "' are negative" + what);
    }

    /// A table without slices.
    RglTable flat(const char* name) {
        const TensorField& field = file_.floats(name, 2);
        check(field.shape[0] >= 2 && field.shape[1] >= 2, name);
        RglTable table{field.shape[1], field.shape[0], 1, values_of(file_, field)};
        note_negative(clamp_negative(table.values), table.values.size(), name, " and taken as 0");
        return table;
    }

    bool fits_views(const TensorField& field) const {
        return field.shape[0] == out_.nodes.phi.size() && field.shape[1] == out_.nodes.theta.size();
    }

    RglWarp warp(const char* name) {
        const TensorField& field = file_.floats(name, 4);
        check(fits_views(field) && field.shape[2] >= 2 && field.shape[3] >= 2, name);
        RglTable table{field.shape[3], field.shape[2], 1, values_of(file_, field)};
        note_negative(clamp_negative(table.values), table.values.size(), name, " and taken as 0");
        for (auto slice = table.values.begin(); slice != table.values.end();
             slice += static_cast<std::ptrdiff_t>(table.slice_size()))
            if (std::all_of(slice, slice + static_cast<std::ptrdiff_t>(table.slice_size()),
                            [](float v) { return v == 0.0f; }))
                throw input_error(file_.name(), std::string("field '") + name +
                                                    "' is 0 everywhere for one of its views" + no_file);
        return RglWarp(std::move(table));
    }

    void read_colour() {
        const bool rgb = file_.find("rgb") != nullptr;
        const char* const name = rgb ? "rgb" : "spectra";
        const TensorField& field = file_.floats(name, 5);
        check(fits_views(field) && field.shape[3] >= 2 && field.shape[4] >= 2 && (!rgb || field.shape[2] == 3),
              name);
        check(field.shape[3] == out_.luminance.table().rows && field.shape[4] == out_.luminance.table().columns,
              name);
        std::vector<float> values = values_of(file_, field);
        const auto negative = std::count_if(values.begin(), values.end(), [](float v) { return v < 0.0f; });
        note_negative(static_cast<std::size_t>(negative), values.size(), name,
                      ": where the interpolated value is negative, it is taken as 0");
        out_.colour = {field.shape[4], field.shape[3], 3,
                       rgb ? std::move(values) : to_srgb(values, field.shape[2], field.shape[3] * field.shape[4])};
        measure_asymmetry();
    }

    std::vector<float> to_srgb(const std::vector<float>& spectra, std::size_t bands, std::size_t size) {
        const std::vector<float> wavelengths = axis_of(file_, "wavelengths");
        check(wavelengths.size() == bands, "wavelengths");
        const std::vector<double> weights = srgb_weights(wavelengths);
        if (weights.empty())
            throw input_error(file_.name(),
                              std::string("field 'wavelengths' (nm) does not cover visible light") + no_file);
        const std::size_t slices = out_.nodes.slices();
        std::vector<float> out(slices * 3 * size);
        std::vector<double> sum(size);
        for (std::size_t row = 0; row < slices * 3; ++row) {
            std::fill(sum.begin(), sum.end(), 0.0);
            for (std::size_t b = 0; b < bands; ++b) {
                const float* const band = &spectra[(row / 3 * bands + b) * size];
                for (std::size_t i = 0; i < size; ++i)
                    sum[i] += weights[row % 3 * bands + b] * static_cast<double>(band[i]);
            }
            for (std::size_t i = 0; i < size; ++i)
                out[row * size + i] = static_cast<float>(std::clamp(sum[i], -3e38, 3e38));
        }
        return out;
    }

    /// Rows of an isotropic table are mirrored about the middle; the warp of visible normals is as symmetric.
    void measure_asymmetry() {
        const RglTable& table = out_.colour;
        double difference = 0.0, sum = 0.0;
        for (std::size_t begin = 0; begin < table.values.size(); begin += table.slice_size())
            for (std::size_t r = 0; r < table.rows; ++r)
                for (std::size_t c = 0; c < table.columns; ++c) {
                    const double a = static_cast<double>(table.values[begin + r * table.columns + c]);
                    const double b =
                        static_cast<double>(table.values[begin + (table.rows - 1 - r) * table.columns + c]);
                    difference += std::abs(a - b);
                    sum += std::abs(a);
                }
        out_.asymmetry = sum > 0.0 ? difference / sum : 0.0;
    }

    const TensorFile& file_;
    RglTables& out_;
};

double lobe(double x, double mean, double below, double above) {
    const double t = (x - mean) / (x < mean ? below : above);
    return std::exp(-0.5 * t * t);
}

} // namespace

std::vector<double> srgb_weights(const std::vector<float>& wavelengths) {
    constexpr double matrix[3][3] = {{3.2404542, -1.5371385, -0.4985314}, // IEC 61966-2-1, from XYZ
                                     {-0.9692660, 1.8760108, 0.0415560},
                                     {0.0556434, -0.2040259, 1.0572252}};
    const std::size_t n = wavelengths.size();
    std::vector<double> weights(3 * n);
    for (std::size_t i = 0; i < n; ++i) {
        const double l = static_cast<double>(wavelengths[i]);
        const double low = static_cast<double>(wavelengths[i > 0 ? i - 1 : 0]);
        const double high = static_cast<double>(wavelengths[i + 1 < n ? i + 1 : i]);
        const double xyz[3] = {1.056 * lobe(l, 599.8, 37.9, 31.0) + 0.362 * lobe(l, 442.0, 16.0, 26.7) -
                                   0.065 * lobe(l, 501.1, 20.4, 26.2),
                               0.821 * lobe(l, 568.8, 46.9, 40.5) + 0.286 * lobe(l, 530.9, 16.3, 31.1),
                               1.217 * lobe(l, 437.0, 11.8, 36.0) + 0.681 * lobe(l, 459.0, 26.0, 13.8)};
        for (std::size_t c = 0; c < 3; ++c) // trapezoidal rule
            weights[c * n + i] =
                0.5 * (high - low) * (matrix[c][0] * xyz[0] + matrix[c][1] * xyz[1] + matrix[c][2] * xyz[2]);
    }
    for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (std::size_t i = 0; i < n; ++i) sum += weights[c * n + i];
        if (!(sum > 1.0)) return {}; // nm; complete coverage gives about 100
        for (std::size_t i = 0; i < n; ++i) weights[c * n + i] /= sum;
    }
    return weights;
}

std::unique_ptr<RglBrdf> parse_rgl(const std::string& name, const std::uint8_t* data, std::size_t size) {
    const TensorFile file(name, data, size);
    RglTables tables;
    RglReader(file, tables).read();
    auto brdf = std::make_unique<RglBrdf>(std::move(tables));
    brdf->name = name;
    return brdf;
}

} // namespace acdf::input
