// Estimates of a file and its partner together are unbiased: Monte Carlo against summation, for every fit and
// partner and each of 200 normals. Of real probes where they are at hand (ACDF_TEST_DATA).
#include "tests/inputs/paths.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/build/partner.h"

#include "input/probe/probe.h"

#include <filesystem>

namespace acdf {
namespace {

using namespace partner_test;

constexpr int kNormals = 200, kEstimates = 64;
constexpr double kSummation = 1e-3; // that sums over texels are off by, of the integral

/// Texels of a file on the grid of the tests: means of luminance. Empty where it is not there.
Probe real_probe(const std::string& name) {
    const std::string path = std::string(acdf_test::kTestData) + "/probes/" + name;
    if (!std::filesystem::exists(path)) return {};
    input::ProbeOptions options;
    if (name.find("_probe.hdr") != std::string::npos) options.projection = input::Projection::angular;
    const input::Probe read = input::read_probe(path, options);
    Probe out{name, std::vector<float>(std::size_t{kColumns} * kRows, 0.0f)};
    std::vector<double> sum(out.radiance.size(), 0.0), count(sum);
    const auto width = static_cast<std::size_t>(read.width), height = static_cast<std::size_t>(read.height);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t texel = y * kRows / height * kColumns + x * kColumns / width;
            const float* rgb = read.rgb.data() + 3 * (y * width + x);
            sum[texel] += 0.2126 * double{rgb[0]} + 0.7152 * double{rgb[1]} + 0.0722 * double{rgb[2]};
            count[texel] += 1.0;
        }
    for (std::size_t i = 0; i < sum.size(); ++i)
        out.radiance[i] = static_cast<float>(std::max(0.0, sum[i] / count[i]));
    return out;
}

/// Real ones: windows and lamps, a sun, soft boxes. Where they are missing the first two synthetic ones take their
/// place; the others have lights of a few texels, and where a horizon cuts these, sums over texels are off by more
/// than kSummation.
std::vector<Probe> compared_probes() {
    const std::vector<Probe> synthetic = probes();
    std::vector<Probe> out;
    for (const char* name : {"grace_probe.hdr", "noon_grass_1k.hdr", "studio.exr"}) {
        if (Probe real = real_probe(name); !real.radiance.empty()) out.push_back(std::move(real));
        else if (out.size() < 2) out.push_back(synthetic[out.size()]);
    }
    return out;
}

/// One estimate: as many samples of the file as of its partner.
double estimate(const Probe& probe, const Made& made, const Vector& n, AcdfHeuristic heuristic,
                std::mt19937_64& random) {
    double sum = 0.0;
    const auto add = [&](const float d[3], double own, double other) {
        const double cosine = dot(n, d);
        if (cosine > 0.0 && own > 0.0) sum += probe.at(d) * cosine * weight(own, other, heuristic);
    };
    const double u0 = acdf_test::uniform(random), u1 = acdf_test::uniform(random);
    const DirectionSample s = made.sample(n, u0, u1);
    add(s.direction, double{s.pdf}, std::max(0.0, dot(n, s.direction)) / kPi);
    const double v0 = acdf_test::uniform(random), v1 = acdf_test::uniform(random);
    float d[3];
    acdf_cosine_direction(n.data(), v0, v1, d);
    add(d, dot(n, d) / kPi, made.pdf(n, d));
    return sum;
}

/// What an estimate's mean is off by, in standard errors of summation. By the variance that sums over texels give,
/// so that a bright light that was never sampled does not make the error small.
class Scores {
public:
    void add(double z) {
        ++count_;
        sum_ += z;
        squares_ += z * z;
        largest_ = std::max(largest_, std::abs(z));
        beyond_ += std::abs(z) > 4.0;
    }
    double count_ = 0.0, sum_ = 0.0, squares_ = 0.0, largest_ = 0.0;
    int beyond_ = 0;
};

TEST(PartnerUnbiased, AtEachOf200NormalsForEveryProbeFitAndPartner) {
    ACDF_NOT_SANITIZED();
    Scores all;
    std::mt19937_64 random(77);
    const std::vector<Probe> compared = compared_probes();
    for (const Probe& probe : compared) {
        std::vector<Vector> at;
        std::vector<double> wanted;
        for (int i = 0; i < kNormals; ++i) {
            at.push_back(random_normal(random));
            wanted.push_back(probe.irradiance(at.back()));
        }
        for (const Kind& kind : kinds) {
            Made made;
            make(probe, kind, made);
            std::vector<double> density; // the same for all normals
            if (!kind.local)
                for (const Vector& d : middles().direction) density.push_back(made.pdf(d, d.data()));
            Scores own;
            for (std::size_t i = 0; i < at.size(); ++i) {
                // One of each, whatever shares the fit was made for.
                const double variance =
                    slow_variance(probe, at[i], 0.5, kind.mis.heuristic, [&](std::size_t texel) {
                        return kind.local ? made.pdf(at[i], middles().direction[texel].data()) : density[texel];
                    });
                if (variance < 0.0) continue; // dark
                double sum = 0.0;
                for (int k = 0; k < kEstimates; ++k)
                    sum += estimate(probe, made, at[i], kind.mis.heuristic, random);
                const double error = sum / kEstimates / wanted[i] - 1.0;
                const double z = error / std::sqrt(0.5 * variance / kEstimates + kSummation * kSummation);
                own.add(z);
                all.add(z);
            }
            const std::string what = probe.name + (kind.local ? ", local" : ", env") + ", partner " +
                                     std::to_string(kind.mis.kind) + ", heuristic " +
                                     std::to_string(kind.mis.heuristic);
            // A bias that all normals share; and, by what squares of normal numbers sum to, one of a few.
            EXPECT_LT(std::abs(own.sum_), 4.0 * std::sqrt(own.count_)) << what;
            EXPECT_LT(own.squares_, own.count_ + 4.0 * std::sqrt(2.0 * own.count_) + 16.0) << what;
        }
    }
    // 4 standard errors: of so many normal numbers 0.3 are beyond, more than 3 in one of 4000 runs; 5.5 in one of
    // 5000.
    EXPECT_GT(all.count_, 187.0 * static_cast<double>(kinds.size() * compared.size()));
    EXPECT_LE(all.beyond_, 3);
    EXPECT_LT(all.largest_, 5.5);
    std::printf("%g comparisons: %d beyond 4 standard errors, largest %.2f, mean square %.3f\n", all.count_,
                all.beyond_, all.largest_, all.squares_ / all.count_);
}

} // namespace
} // namespace acdf
