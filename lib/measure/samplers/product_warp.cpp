#include "measure/samplers/product_warp.h"

#include "measure/samplers/ggx_lobe.h"
#include "measure/samplers/light_samplers.h"
#include "measure/samplers/point_samplers.h"

#include <acdf/product/product.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::measure {
namespace {

/// A pdf over the unit square that is bilinear between its corners.
class BilinearWarp {
public:
    static constexpr int kSide = 4;

    /// The middles of kSide x kSide strata.
    static double middle(int i) { return (i + 0.5) / kSide; }

    /// Least squares through values[row][column] >= 0 there; even where all are 0.
    void fit(const double values[kSide][kSide]) {
        double mean = 0.0, slope[2] = {}, twist = 0.0, square = 0.0;
        for (int i = 0; i < kSide; ++i) square += (middle(i) - 0.5) * (middle(i) - 0.5);
        for (int i = 0; i < kSide; ++i)
            for (int k = 0; k < kSide; ++k) {
                const double value = values[i][k], x = middle(k) - 0.5, y = middle(i) - 0.5;
                mean += value / (kSide * kSide);
                slope[0] += value * x / (kSide * square);
                slope[1] += value * y / (kSide * square);
                twist += value * x * y / (square * square);
            }
        double sum = 0.0;
        for (int i = 0; i < 2; ++i)
            for (int k = 0; k < 2; ++k) {
                const double x = k - 0.5, y = i - 0.5;
                corner_[i][k] = std::max(0.1 * mean, mean + slope[0] * x + slope[1] * y + twist * x * y);
                sum += corner_[i][k];
            }
        for (auto& row : corner_)
            for (double& value : row) value = sum > 0.0 ? 4.0 * value / sum : 1.0;
    }
    double density(const double u[2]) const { return between(row_at(0, u[0]), row_at(1, u[0]), u[1]); }
    /// u becomes a point of the pdf.
    void draw(double u[2]) const {
        u[0] = linear(corner_[0][0] + corner_[1][0], corner_[0][1] + corner_[1][1], u[0]);
        u[1] = linear(row_at(0, u[0]), row_at(1, u[0]), u[1]);
    }

private:
    static double between(double a, double b, double t) { return a + t * (b - a); }
    double row_at(int row, double x) const { return between(corner_[row][0], corner_[row][1], x); }
    /// Of a pdf that goes from a to b, both positive.
    static double linear(double a, double b, double u) {
        return std::min(1.0, u * (a + b) / (a + std::sqrt(between(a * a, b * b, u))));
    }

    double corner_[2][2] = {{1.0, 1.0}, {1.0, 1.0}};
};

/// A file of light at one point: what is sampled for a pair of numbers, and the numbers that sample a direction.
class LightAtPoint {
public:
    explicit LightAtPoint(const File& file) : local_(), is_local_(file.kind() == ACDF_KIND_LOCAL) {
        if (is_local_) local_ = file.local().data();
        else if (file.kind() == ACDF_KIND_ENVIRONMENT) local_.environment = file.environment().data();
        else throw std::invalid_argument("the light of a product is an environment or a local environment");
        if (local_.cosine_share > 0.0 || file.partner())
            throw std::invalid_argument("the pdf of a file for an MIS partner is 0 where the partner suffices");
    }
    bool has_cosine() const { return is_local_; }
    void move_to(const float normal[3]) {
        if (is_local_) acdf_local_at(&local_, normal, &point_);
    }
    AcdfDirectionSample sample(const double u[2]) const {
        return is_local_ ? acdf_local_sample_at(&local_, &point_, u[0], u[1])
                         : acdf_environment_sample(&local_.environment, u[0], u[1]);
    }
    float pdf(const float direction[3]) const {
        return is_local_ ? acdf_local_pdf_at(&local_, &point_, direction)
                         : acdf_environment_pdf(&local_.environment, direction);
    }
    bool invert(const float direction[3], double u[2]) const {
        if (!is_local_) return acdf_environment_invert(&local_.environment, direction, u) != 0;
        const AcdfGrid grid = acdf_environment_grid(&local_.environment);
        AcdfRange range[2];
        AcdfStratum strata[2] = {{0.0, 1.0}, {0.0, 1.0}};
        std::uint32_t square[2];
        double position[2], t[2];
        if (point_.what == ACDF_LOCAL_NOTHING || !acdf_grid_square(&grid, direction, square, position))
            return false;
        acdf_sphere_ranges(grid.columns, grid.rows, range);
        if (!find(square, range, strata)) return false;
        acdf_grid_fractions(&grid, direction, position, range, t);
        for (int axis = 0; axis < 2; ++axis) u[axis] = acdf_stratum_number(&strata[axis], t[axis]);
        return true;
    }

private:
    bool find(const std::uint32_t* square, AcdfRange* range, AcdfStratum* strata) const {
        if (point_.what == ACDF_LOCAL_ROWS) {
            AcdfSpan box[2];
            const double p = acdf_rows_strata(local_.rows_of_normals, local_.environment.halved, &point_.by.rows,
                                              square, box, strata);
            acdf_halved_ranges(box, range);
            return p > 0.0;
        }
        const AcdfEnvironment tree = acdf_local_tree(&local_, &point_);
        return acdf_environment_find_square(&tree, square, range, strata) > 0.0;
    }

    AcdfLocal local_;
    bool is_local_;
    AcdfLocalPoint point_{};
};

template <class AnyLobe>
struct WarpTable {
    LightAtPoint light;
    AnyLobe lobe;
    std::uint64_t files;

    std::uint64_t bytes() const { return files; }
};

template <class AnyLobe>
class WarpAtPoint final : public PointSampler {
public:
    explicit WarpAtPoint(const WarpTable<AnyLobe>& table) : light_(table.light), lobe_(table.lobe) {}

    void move_to(const ShadingPoint& point) override {
        constexpr int side = BilinearWarp::kSide;
        const SurfaceFrame frame = frame_of(point);
        typename AnyLobe::Point lobe{};
        double values[side][side] = {};
        float wo[3], wi[3];
        light_.move_to(point.n);
        frame.to_local(point.wo, wo);
        const bool seen = lobe_.at(wo, lobe);
        for (int i = 0; seen && i < side; ++i)
            for (int k = 0; k < side; ++k) {
                const double u[2] = {BilinearWarp::middle(k), BilinearWarp::middle(i)};
                const AcdfDirectionSample s = light_.sample(u);
                frame.to_local(s.direction, wi);
                if (!(s.pdf > 0.0f && wi[2] > 0.0f)) continue;
                const float pdf = lobe_.pdf(lobe, wi); // about BRDF times cosine
                values[i][k] = double{light_.has_cosine() ? lobe_.value(lobe, wi, pdf) : pdf};
            }
        warp_.fit(values);
    }
    AcdfDirectionSample sample(double u0, double u1) const override {
        double u[2] = {u0, u1};
        warp_.draw(u);
        AcdfDirectionSample out = light_.sample(u);
        out.pdf *= static_cast<float>(warp_.density(u));
        return out;
    }
    float pdf(const float wi[3]) const override {
        const float light = light_.pdf(wi);
        double u[2];
        if (!(light > 0.0f) || !light_.invert(wi, u)) return 0.0f;
        return light * static_cast<float>(warp_.density(u));
    }

private:
    LightAtPoint light_;
    const AnyLobe& lobe_;
    BilinearWarp warp_;
};

template <class AnyLobe>
std::unique_ptr<LightSampler> warp_of(const File& light, const AnyLobe& lobe, std::uint64_t brdf_bytes) {
    using Table = WarpTable<AnyLobe>;
    return std::make_unique<MovedToPoints<Table, WarpAtPoint<AnyLobe>>>(
        Table{LightAtPoint(light), lobe, memory_of(light) + brdf_bytes});
}

} // namespace

std::unique_ptr<LightSampler> product_warp_sampler(const File& light, const File& brdf) {
    if (brdf.kind() != ACDF_KIND_BRDF) throw std::invalid_argument("numbers are warped towards a BRDF, or ggx");
    return warp_of(light, BrdfLobe(brdf.brdf().data()), memory_of(brdf));
}

std::unique_ptr<LightSampler> product_warp_sampler(const File& light, double alpha) {
    return warp_of(light, GgxLobe(alpha), 0);
}

} // namespace acdf::measure
