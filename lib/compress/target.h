// What a fit approximates: a non-negative function, constant on each rectangle of a grid.
#pragma once

#include <acdf/layout.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace acdf::compress {

class Filling;

/// g on rows x columns, row-major; each axis carries the measure of its steps. For a probe the columns are
/// azimuths and the rows elevations, or u and v of the octahedral square, so that the measure of a texel is its
/// exact solid angle.
///
/// g is the root mean square, over a texel and summed over channels, of the integrand f that a renderer
/// estimates: with one channel and nearest lookup it is f itself. A pdf p that is constant on texels then has
/// E[(f/p)^2] = sum over texels of g^2/p, so that fitting g minimises the noise of f whatever f is.
struct Target {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::vector<float> values; ///< g >= 0, finite
    std::vector<float> peaks;  ///< largest f in each texel; empty: as `values`
    /// Mean of f over each texel, of each channel that counts; empty: g is f.
    std::vector<std::vector<float>> means;
    std::vector<double> column_measure; ///< one a column, > 0
    std::vector<double> row_measure;    ///< one a row, > 0
    std::uint32_t column_axis = 0;      ///< axis numbers in the file
    std::uint32_t row_axis = 1;
    double total = 0.0; ///< integral of f; of several channels their sum
    /// Square of the integral of f, of several channels their sum: what E[(f/p)^2] is compared with. 0: g is f.
    double mean_square = 0.0;
    AcdfParameterization parameterization = ACDF_PARAM_LATLONG; ///< of a probe: lat-long or octahedral
    /// Beside an MIS partner: see Grid. Empty: without any.
    std::vector<float> left, least;
    std::shared_ptr<const Filling> filling;

    const float* row(std::uint32_t r) const { return values.data() + std::size_t{r} * columns; }
};

/// Weights of the red, green and blue channel in the target. Rec. 709 luminance by default.
struct ChannelWeights {
    double r = 0.2126, g = 0.7152, b = 0.0722;
};

/// What a renderer looks up, and which noise counts.
struct TargetOptions {
    ChannelWeights weights;
    AcdfChannels channels = ACDF_CHANNELS_WEIGHTED; ///< the weighted sum, each channel on its own, or the largest
    /// Bilinear wraps at the seam of a lat-long probe and clamps at its poles; at the sides of an octahedral square
    /// it goes on where the direction does, on the other half of the side.
    AcdfFilter filter = ACDF_FILTER_NEAREST;
    AcdfParameterization parameterization = ACDF_PARAM_LATLONG; ///< of the probe: lat-long or octahedral
};

/// How many numbers of a texel count: three, or one.
std::uint32_t planes_of(const TargetOptions& options);

/// The numbers that count of `count` texels of RGB, negatives as 0 channel by channel: plane k of texel i becomes
/// out[k * stride + i]. False where any is not finite.
bool take_texels(const float* rgb, std::size_t count, const TargetOptions& options, float* out, std::size_t stride);

/// A double as a float that is positive where the double is: rounding must not make darkness out of light.
float positive_float(double value);

/// Throws std::invalid_argument where channels together are more than a float holds.
void refuse_overflow(const Target& target);

/// A grid of directions without any light: all but the values.
Target empty_target(std::uint32_t columns, std::uint32_t rows, AcdfParameterization parameterization);

/// Makes the target of a lat-long or octahedral probe of columns x rows RGB texels that come in bands of rows. One
/// channel with nearest lookup takes four bytes a texel, and no more on the way.
class EnvironmentTarget {
public:
    EnvironmentTarget(std::uint32_t columns, std::uint32_t rows, const TargetOptions& options);

    /// `count` rows from row `first` on; negatives count as 0, channel by channel. Throws std::invalid_argument on
    /// non-finite input.
    void take(std::uint32_t first, std::uint32_t count, const float* rgb);
    /// Once, after all rows were taken.
    Target finish();

private:
    Target nearest();
    Target moments();

    TargetOptions options_;
    std::uint32_t columns_, rows_, planes_;
    std::vector<float> values_; ///< of the integrand: planes x rows x columns, one plane a channel that counts
};

/// The target of a probe of `rgb` (rows x columns x 3), negatives as 0 channel by channel, with measure dphi and
/// dz = d cos(theta) (Lawrence et al. 2005, §3), of an octahedral one with equal measures. Throws
/// std::invalid_argument on non-finite input.
Target environment_target(const float* rgb, std::uint32_t columns, std::uint32_t rows,
                          const TargetOptions& options);

/// The same function without its means and peaks, which not all fits look at.
Target of_values(const Target& target);

/// The same function with rows and columns exchanged.
Target transposed(const Target& target);

/// Whether the integral of g is above 0.
bool has_energy(const Target& target);
/// The integral of g, by compensated summation.
double integral(const Target& target);

/// E[(f/p)^2] of the best pdf that is constant on texels, over `mean_square`: at least 1, and 1 where g is f.
double least_second_moment(const Target& target);

/// The map as samplers of texels see it, which sample them by g: without the peaks. `target`, or one that is made
/// in `other`.
const Target& of_texels(const Target& target, Target& other);

/// Sums of one integrand, of each channel that counts.
class ChannelSums {
public:
    void add(const double* of, std::size_t count, double factor) {
        for (std::size_t k = 0; k < count; ++k) sums_[k] += factor * of[k];
    }
    void add(const ChannelSums& other) { add(other.sums_.data(), sums_.size(), 1.0); }
    /// The root of the sum of their squares: what noise is compared with.
    double length() const { return std::hypot(sums_[0], sums_[1], sums_[2]); }

private:
    std::array<double, 3> sums_{};
};

/// The means of f over texel `i`, in `out` where f differs from g; how many there are.
inline std::size_t means_of(const Target& target, std::size_t i, double out[3]) {
    if (target.means.empty()) {
        out[0] = double{target.values[i]};
        return 1;
    }
    for (std::size_t k = 0; k < target.means.size(); ++k) out[k] = double{target.means[k][i]};
    return target.means.size();
}

} // namespace acdf::compress
