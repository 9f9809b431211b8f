#include "build/probe/resample.h"

#include "build/probe/overlap.h"
#include "compress/parallel.h"
#include "compress/threads.h"

#include <atomic>
#include <cfloat>
#include <cstdint>

namespace acdf::build {
namespace {

constexpr int max_halvings = 6;

// Solid angles are added up as integers: their sum is the same in any order, so on any number of threads.
constexpr double units = 0x1p61 / (4.0 * compress::pi);

class Resampler {
public:
    Resampler(const Map& map, std::vector<float>& rgb, int width)
        : map_(map), rgb_(rgb), width_(width), height_(width / 2), covered_(texels(map)),
          kept_(map, static_cast<std::size_t>(width_), static_cast<std::size_t>(height_)) {}

    std::vector<float> run() {
        const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
        parallel_rows(height_, [&](int row) { add_coverage(row); });
        parallel_rows(map_.height, [&](int row) { scale_source(row); });
        std::vector<float> result(3 * count);
        parallel_rows(height_, [&](int row) { gather(row, result); });
        hand_out_missed(result);
        return result;
    }

private:
    static std::size_t texels(const Map& map) {
        return static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(map_.width) +
               static_cast<std::size_t>(column);
    }

    template <typename Function>
    static void parallel_rows(int rows, const Function& function) {
        compress::parallel_parts(0, static_cast<std::size_t>(rows), 4, [&](std::size_t first, std::size_t last) {
            for (std::size_t row = first; row < last; ++row) function(static_cast<int>(row));
        });
    }

    SphereCell texel(int column, int row) const {
        const auto phi = [&](int c) { return 1.0 - 2.0 * c / width_; };
        const auto theta = [&](int r) { return 1.0 * r / height_; };
        return {phi(column), phi(column + 1), theta(row), theta(row + 1)};
    }

    template <typename Visit>
    void for_each_source(int row, const Visit& visit) const {
        for (int column = 0; column < width_; ++column)
            for_each_overlap(map_, texel(column, row), max_halvings,
                             [&](int x, int y, double omega, const Polygon&) {
                                 visit(static_cast<std::size_t>(column), index(x, y), omega);
                             });
    }

    void add_coverage(int row) {
        std::vector<Overlap> found;
        for_each_source(row, [&](std::size_t column, std::size_t texel, double omega) {
            covered_[texel].fetch_add(static_cast<std::uint64_t>(omega * units), std::memory_order_relaxed);
            if (kept_.any()) found.push_back(overlap(column, texel, omega));
        });
        if (kept_.any()) kept_.keep(static_cast<std::size_t>(row), found);
    }

    // After this, `rgb_` times the solid angle by which lat-long texels overlap a texel is what it hands out.
    void scale_source(int row) {
        for (int column = 0; column < map_.width; ++column) {
            const std::size_t i = index(column, row);
            const double overlapped = static_cast<double>(covered_[i].load(std::memory_order_relaxed)) / units;
            if (overlapped <= 0.0) continue;
            const double scale = texel_solid_angle(map_, column, row) / overlapped;
            for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) rgb_[c] = to_float(rgb_[c] * scale);
        }
    }

    void gather(int row, std::vector<float>& result) const {
        struct Sums {
            double rgb[3] = {0.0, 0.0, 0.0}, total = 0.0;
        };
        std::vector<Sums> sums(static_cast<std::size_t>(width_));
        const auto add = [&](std::size_t column, std::size_t texel, double omega) {
            Sums& sum = sums[column];
            const float* source = rgb_.data() + 3 * texel;
            for (int c = 0; c < 3; ++c) sum.rgb[c] += omega * source[c];
            sum.total += omega;
        };
        if (!kept_.any()) for_each_source(row, add);
        else
            for (const Overlap& part : kept_[static_cast<std::size_t>(row)]) add(part.of, part.texel, part.omega);
        for (int column = 0; column < width_; ++column)
            for (std::size_t c = 0; c < 3; ++c) {
                const Sums& sum = sums[static_cast<std::size_t>(column)];
                result[result_index(column, row) + c] = to_float(sum.rgb[c] / sum.total);
            }
    }

    std::size_t result_index(int column, int row) const {
        return 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(column));
    }

    // Slivers at the rim of a disc may have been missed by all: each goes where its middle points.
    void hand_out_missed(std::vector<float>& result) const {
        for (int y = 0; y < map_.height; ++y)
            for (int x = 0; x < map_.width; ++x) {
                const std::size_t i = index(x, y);
                if (covered_[i].load(std::memory_order_relaxed) != 0) continue;
                const double omega = texel_solid_angle(map_, x, y);
                if (omega > 0.0) hand_out(x, y, omega, result);
            }
    }

    void hand_out(int x, int y, double omega, std::vector<float>& result) const {
        Direction d{-1.0, 0.0, 0.0}; // the rim of both discs
        to_direction(map_, (x + 0.5) / map_.width, (y + 0.5) / map_.height, d);
        const Map latlong{Layout::latlong, width_, height_};
        const ImagePoint p = to_image(latlong, d);
        const int column = static_cast<int>(p.u * width_), row = static_cast<int>(p.v * height_);
        const double share = omega / texel_solid_angle(latlong, column, row);
        for (std::size_t c = 0; c < 3; ++c) {
            float& at = result[result_index(column, row) + c];
            at = to_float(at + rgb_[3 * index(x, y) + c] * share);
        }
    }

    static float to_float(double v) { return static_cast<float>(v < FLT_MAX ? v : FLT_MAX); }

    const Map map_;
    std::vector<float>& rgb_;
    const int width_, height_;
    std::vector<std::atomic<std::uint64_t>> covered_;
    KeptOverlaps kept_;
};

} // namespace

std::vector<float> resample_to_latlong(const Map& map, std::vector<float> rgb, int width, int threads) {
    std::vector<float> result;
    compress::with_threads(threads, [&] { result = Resampler(map, rgb, width).run(); });
    return result;
}

} // namespace acdf::build
