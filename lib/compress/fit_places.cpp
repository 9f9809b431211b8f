#include "compress/fit_places.h"

#include "compress/fit_shared.h"
#include "compress/place_rows.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

namespace acdf::compress {
namespace {

/// Splits of tiles that cells tell apart: more of them and there are fewer cells (docs/places.md).
constexpr std::uint32_t kColumns = 127;
/// How far cells are mixed, of the smaller one at their border.
constexpr double kBlend = 0.4;
/// Points of a cell, in the mean; rounds in which they are found; and candidates for each.
constexpr std::size_t kPointsOfCell = 80;
constexpr std::uint32_t kRounds = 3;
constexpr std::uint64_t kCandidates = 24;
/// Around the points: light is gathered next to them, too.
constexpr float kMargin = 1e-3f;

bool is_finite(const std::array<float, 3>& x) {
    return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
}

/// The code of the visibility nearest to a factor.
std::uint8_t visibility_code(double factor) {
    std::uint32_t low = 0, high = 255;
    while (low < high) { // the first that is no less
        const std::uint32_t middle = (low + high) / 2;
        if (acdf_visibility(static_cast<std::uint8_t>(middle)) < factor) low = middle + 1;
        else high = middle;
    }
    const auto at = [](std::uint32_t code) { return acdf_visibility(static_cast<std::uint8_t>(code)); };
    if (low > 0 && factor * factor < at(low - 1) * at(low)) --low;
    return static_cast<std::uint8_t>(low);
}

/// The box of the first points that a source tells of, which are as even as any; a little larger, as light is
/// gathered next to them, too.
AcdfPlaces header_of(const PointSource& source, const PlacesFrame& frame) {
    AcdfPlaces out = {};
    for (int k = 0; k < 3; ++k) std::copy_n(frame.transform[k], 4, out.transform[k]);
    constexpr std::size_t batch = 1 << 16;
    std::vector<PlacePoint> points(batch);
    std::vector<char> there(batch, 0);
    tbb::parallel_for(std::size_t{0}, batch,
                      [&](std::size_t i) { there[i] = source(i, points[i]) && is_finite(points[i].position); });
    if (std::find(there.begin(), there.end(), 1) == there.end())
        throw std::invalid_argument("a scene without points");
    float size = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
        out.low[k] = std::numeric_limits<float>::infinity();
        out.high[k] = -out.low[k];
        for (std::size_t i = 0; i < batch; ++i) {
            if (!there[i]) continue;
            out.low[k] = std::min(out.low[k], points[i].position[k]);
            out.high[k] = std::max(out.high[k], points[i].position[k]);
        }
        size = std::max(size, out.high[k] - out.low[k]);
    }
    if (!(size > 0.0f)) size = 1.0f;
    for (std::size_t k = 0; k < 3; ++k) {
        out.low[k] -= kMargin * size;
        out.high[k] += kMargin * size;
    }
    return out;
}

/// The bytes of a cell.
void encode(const PlaceParts& parts, const float* given, const float* factors, std::uint8_t* out) {
    constexpr double kUnseen = 1e-6; // of what no point of the cell sees: it has the factor of the cell around it
    std::vector<double> all(parts.boxes()), seen(parts.boxes());
    double whole = 0.0, visible = 0.0;
    for (std::size_t p = 0; p < parts.boxes(); ++p) {
        all[p] = double{given[p]} + kUnseen;
        seen[p] = all[p] * double{factors[p]};
        whole += all[p];
        visible += seen[p];
    }
    *out++ = visibility_code(whole > 0.0 ? visible / whole : 1.0);
    for (std::size_t p = parts.boxes(); p < parts.count(); ++p) *out++ = visibility_code(double{factors[p]});
    const std::vector<std::array<double, 2>> without = parts.sides(all.data()), with = parts.sides(seen.data());
    for (std::size_t c = 0; c < with.size(); ++c) {
        const double lower = with[c][0] / without[c][0], upper = with[c][1] / without[c][1];
        *out++ = row_code(lower, upper);
    }
}

template <class Record>
void append(std::vector<std::uint8_t>& bytes, const Record* records, std::size_t count) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(records);
    bytes.insert(bytes.end(), first, first + count * sizeof(Record));
}

/// Points of a scene, more of them where cells are small: so many that each cell has about as many.
class PointsByCell {
public:
    explicit PointsByCell(const PointSource& source) : source_(source) {}

    const std::vector<PlacePoint>& points() const { return points_; }
    /// Adds points until there are `count`, or no more are found in `most` candidates.
    void add(const AcdfPlaces& header, const std::vector<AcdfPlaceSplit>& splits, std::uint32_t cells,
             std::size_t count, std::uint64_t most) {
        const CellNumbers numbers(header, splits, cells);
        std::vector<std::size_t> of_cell(cells, 0);
        for (const PlacePoint& point : points_) ++of_cell[numbers.of(point)];
        const std::size_t quota = count / cells + 1;
        constexpr std::size_t batch = 1 << 16;
        std::vector<PlacePoint> candidates(batch);
        std::vector<std::uint32_t> cell(batch);
        for (const std::uint64_t end = next_ + most; next_ < end && points_.size() < count; next_ += batch) {
            tbb::parallel_for(std::size_t{0}, batch, [&](std::size_t i) {
                const bool there = source_(next_ + i, candidates[i]) && is_finite(candidates[i].position);
                cell[i] = there ? numbers.of(candidates[i]) : cells;
            });
            for (std::size_t i = 0; i < batch && points_.size() < count; ++i) {
                if (cell[i] >= cells || of_cell[cell[i]] >= quota) continue;
                ++of_cell[cell[i]];
                points_.push_back(candidates[i]);
            }
        }
    }

private:
    const PointSource& source_;
    std::vector<PlacePoint> points_;
    std::uint64_t next_ = 0;
};

} // namespace

Chunk fit_places(const AcdfLocal& local, std::uint32_t bins, const PlaceScene& scene, const PlacesFrame& frame,
                 const PlacesSize& size, const std::function<void(double)>& progress) {
    if (!local.blend.tiles) throw std::invalid_argument("bins that do not share tiles have no places");
    const auto report = [&](double share) {
        if (progress) progress(share);
    };
    const std::uint32_t splits_of_tiles = local.blend.tiles->tile_count - 1;
    const PlaceParts parts(local, bins, size.columns > 0 ? size.columns : kColumns);
    const std::uint64_t width = 1 + local.light_count + parts.column_count();
    const std::uint64_t fixed = sizeof(AcdfPlaces) + 2 * std::uint64_t{splits_of_tiles};
    const std::uint64_t most = size.bytes > fixed ? (size.bytes - fixed) / (width + sizeof(AcdfPlaceSplit)) : 1;
    const auto cells = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(most, 1, ACDF_PLACE_ROW - 1));
    const auto points_wanted = kPointsOfCell * std::size_t{cells};

    AcdfPlaces header = header_of(scene.points, frame);
    const PlaceCells::Box low{header.low[0], header.low[1], header.low[2], -1.0f, -1.0f, -1.0f},
        high{header.high[0], header.high[1], header.high[2], 1.0f, 1.0f, 1.0f};
    PointsByCell points(scene.points);
    std::vector<AcdfPlaceSplit> splits;
    std::unique_ptr<PlaceCells> tree;
    PlaceLight light;
    for (std::uint32_t round = 0; round < kRounds; ++round) {
        const std::uint32_t shift = 2 * (kRounds - 1 - round); // a quarter of points and cells before, and so on
        points.add(header, splits, tree ? tree->cell_count() : 1,
                   std::max<std::size_t>(points_wanted >> shift, 1024),
                   kCandidates * (points_wanted >> shift) + (1u << 20));
        light = trace_places(parts, points.points(), scene.occluded,
                             [&](double share) { report((round + 0.8 * share) / kRounds); });
        tree = std::make_unique<PlaceCells>(light, points.points(), low, high, std::max(cells >> shift, 1u));
        splits = tree->splits(round + 1 == kRounds ? kBlend : 0.0);
    }
    const PlaceRows told =
        place_rows(*tree, CellNumbers(header, splits, tree->cell_count()), light, points.points());
    header.split_count = static_cast<std::uint32_t>(splits.size());
    header.row_count = tree->cell_count();
    header.column_count = parts.column_count();
    std::vector<std::uint8_t> rows(header.row_count * width);
    tbb::parallel_for(std::size_t{0}, std::size_t{header.row_count}, [&](std::size_t cell) {
        const std::size_t first = cell * parts.count();
        encode(parts, &told.all[first], &told.factors[first], &rows[cell * width]);
    });
    Chunk chunk{ACDF_CHUNK_PLACES, {}};
    append(chunk.bytes, &header, 1);
    append(chunk.bytes, splits.data(), splits.size());
    append(chunk.bytes, parts.columns().data(), parts.columns().size());
    append(chunk.bytes, rows.data(), rows.size());
    report(1.0);
    return chunk;
}

} // namespace acdf::compress
