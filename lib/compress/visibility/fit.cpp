#include "compress/visibility/fit.h"

#include "compress/parallel.h"
#include "compress/visibility/chunk.h"
#include "compress/visibility/portal_rows.h"
#include "compress/visibility/rows.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

namespace acdf::compress {
namespace {

/// Columns of a chunk are so many times the root of its bytes: with more of them there are fewer cells, and both
/// count (docs/notes/visibility.md).
constexpr double kColumns = 0.147, kMostColumns = 127.0;
/// Of files with portals at most, through which most samples are taken: there cells gain more than columns do.
constexpr double kColumnsBesidePortals = 31.0;
/// Cells that have the same columns, in the mean.
constexpr std::uint64_t kCellsOfRegion = 200;
/// Points of a cell, in the mean: those that decide where it is divided and those for its row; rounds in which
/// the first are found; and candidates for each.
constexpr std::size_t kPointsOfDivision = 32, kPointsOfRow = 56;
constexpr std::uint32_t kRounds = 3;
constexpr std::uint64_t kCandidates = 24;
/// Of the time, for progress: what it takes to find cells, before rows.
constexpr double kDivisionShare = 0.4;
/// Around the points: light is gathered next to them, too.
constexpr float kMargin = 1e-3f;

/// The box of the first points of a source, which are as even as any; a little larger, as light is
/// gathered next to them, too. It has a volume, wherever it lies.
AcdfVisibility header_of(const PointSource& source, const VisibilityFrame& frame) {
    AcdfVisibility out = {};
    for (int k = 0; k < 3; ++k) std::copy_n(frame.transform[k], 4, out.transform[k]);
    constexpr std::size_t batch = 1 << 16;
    std::vector<VisibilityPoint> points(batch);
    std::vector<char> there(batch, 0);
    parallel_for(std::size_t{0}, batch,
                 [&](std::size_t i) { there[i] = source(i, points[i]) && is_near(points[i].position); });
    if (std::find(there.begin(), there.end(), 1) == there.end())
        throw std::invalid_argument("a scene without points within 1e30 of its origin");
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    float size = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
        out.low[k] = kInfinity;
        out.high[k] = -out.low[k];
        for (std::size_t i = 0; i < batch; ++i) {
            if (!there[i]) continue;
            out.low[k] = std::min(out.low[k], points[i].position[k]);
            out.high[k] = std::max(out.high[k], points[i].position[k]);
        }
        size = std::max(size, out.high[k] - out.low[k]);
    }
    if (!(size > 0.0f)) size = 1.0f;
    for (std::size_t k = 0; k < 3; ++k) { // far from the origin the margin may be less than one step of floats
        out.low[k] = std::min(out.low[k] - kMargin * size, std::nextafter(out.low[k], -kInfinity));
        out.high[k] = std::max(out.high[k] + kMargin * size, std::nextafter(out.high[k], kInfinity));
    }
    return out;
}

/// Points of a scene, more of them where cells are small: so many that each cell has about as many.
class PointsByCell {
public:
    PointsByCell(const PointSource& source, std::vector<VisibilityPoint>& points)
        : source_(source), points_(points) {}

    /// Adds points until there are `count`, or no more are found in `most` candidates.
    void add(const AcdfVisibility& header, const std::vector<AcdfVisibilitySplit>& splits, std::uint32_t cells,
             std::size_t count, std::uint64_t most) {
        const CellNumbers numbers(header, splits, cells);
        std::vector<std::size_t> of_cell(cells, 0);
        for (const VisibilityPoint& point : points_) ++of_cell[numbers.of(point)];
        const std::size_t quota = count / cells + 1;
        constexpr std::size_t batch = 1 << 16;
        std::vector<VisibilityPoint> candidates(batch);
        std::vector<std::uint32_t> cell(batch);
        for (const std::uint64_t end = next_ + most; next_ < end && points_.size() < count; next_ += batch) {
            parallel_for(std::size_t{0}, batch, [&](std::size_t i) {
                const bool there = source_(next_ + i, candidates[i]) && is_near(candidates[i].position);
                cell[i] = there ? numbers.of(candidates[i]) : cells;
            });
            for (std::size_t i = 0; i < batch && points_.size() < count; ++i) {
                if (cell[i] >= cells || of_cell[cell[i]] >= quota) continue;
                ++of_cell[cell[i]];
                points_.push_back(candidates[i]);
                cells_.push_back(cell[i]);
            }
        }
    }

    /// Where each point was found to lie when it was added.
    const std::vector<std::uint32_t>& cells() const { return cells_; }

private:
    const PointSource& source_;
    std::vector<VisibilityPoint>& points_;
    std::vector<std::uint32_t> cells_;
    std::uint64_t next_ = 0;
};

std::uint32_t usual_columns(std::uint64_t bytes, const PortalSet* portals) {
    const double most = portals ? kColumnsBesidePortals : kMostColumns;
    return static_cast<std::uint32_t>(std::min(kColumns * std::sqrt(double(bytes)), most));
}

/// Cells and regions that fill a chunk.
struct Counts {
    std::uint32_t cells = 1, regions = 1;
};
Counts counts_for(std::uint64_t bytes, std::uint64_t width, std::uint64_t columns) {
    const std::uint64_t set = columns * sizeof(AcdfColumn), cell = width + sizeof(AcdfVisibilitySplit);
    const std::uint64_t room = bytes > sizeof(AcdfVisibility) + set ? bytes - sizeof(AcdfVisibility) - set : 0;
    const auto clamped = [](std::uint64_t cells) {
        return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(cells, 1, ACDF_VISIBILITY_ROW - 1));
    };
    const std::uint64_t regions = std::min<std::uint64_t>(
        room * kCellsOfRegion / (kCellsOfRegion * (cell + sizeof(std::uint16_t)) + set) / kCellsOfRegion, 0x10000);
    if (regions < 2) return {clamped(room / cell), 1};
    return {clamped((room - (regions - 1) * set) / (cell + sizeof(std::uint16_t))),
            static_cast<std::uint32_t>(regions)};
}

/// Points of a scene and cells for them, found together in rounds.
struct DividedVisibility {
    AcdfVisibility header{};
    std::vector<VisibilityPoint> points;
    std::vector<AcdfVisibilitySplit> splits;
    VisibilityLight light;                 ///< of the first points
    std::unique_ptr<VisibilityCells> tree; ///< refers to points and light
};

void divide(DividedVisibility& out, const VisibilityParts& parts, const VisibilityScene& scene, std::uint32_t cells,
            const std::function<void(double)>& report) {
    const AcdfVisibility& h = out.header;
    const VisibilityCells::Box low{h.low[0], h.low[1], h.low[2], -1.0f, -1.0f, -1.0f},
        high{h.high[0], h.high[1], h.high[2], 1.0f, 1.0f, 1.0f};
    PointsByCell points(scene.points, out.points);
    const auto add = [&](std::size_t wanted) {
        points.add(h, out.splits, out.tree ? out.tree->cell_count() : 1, std::max<std::size_t>(wanted, 1024),
                   kCandidates * wanted + (1u << 20));
    };
    double before = 0.0;
    for (std::uint32_t round = 0; round < kRounds; ++round) {
        const std::uint32_t shift = 2 * (kRounds - 1 - round); // a quarter of points and cells before, and so on
        add(kPointsOfDivision * std::size_t{cells} >> shift);
        const double share = std::ldexp(1.0, -int(shift)); // of all
        std::vector<Ray> expected;
        if (out.tree) expected = parts.expect(parts, out.tree->sums({0, out.tree->cell_count()}));
        const ExpectedRays rays = [&](std::size_t i) {
            return expected.empty() ? nullptr : &expected[points.cells()[i] * parts.count()];
        };
        trace_visibility(parts, out.points, scene.occluded, rays, out.light, -1.0,
                         [&](double done) { report(before + 0.8 * (share - before) * done); });
        out.tree = std::make_unique<VisibilityCells>(parts, out.light, out.points, low, high,
                                                     std::max(cells >> shift, 1u));
        out.splits = out.tree->splits();
        report(before = share);
    }
    add(kPointsOfRow * std::size_t{cells});
}

} // namespace

std::vector<Chunk> fit_visibility(const AcdfLocal& local, std::uint32_t bins, const VisibilityScene& scene,
                                  const VisibilityFrame& frame, const VisibilitySize& size,
                                  const std::function<void(double)>& progress) {
    if (!local.rows_of_normals)
        throw std::invalid_argument("bins without rows on one tree of halvings have no visibility cells");
    const auto report = [&](double share) {
        if (progress) progress(share);
    };
    const PortalSet* portals = scene.portals.get();
    const VisibilityParts coarse(local, bins, usual_columns(size.bytes, portals));
    const std::uint64_t width = 1 + coarse.column_count();
    const Counts counts = portals ? counts_for(size.bytes - std::min<std::uint64_t>(size.bytes, portals->bytes()),
                                               width + portals->row_bytes(), coarse.column_count())
                                  : counts_for(size.bytes, width, coarse.column_count());

    DividedVisibility division;
    division.header = header_of(scene.points, frame);
    divide(division, coarse, scene, counts.cells, [&](double share) { report(kDivisionShare * share); });
    const VisibilityCells& tree = *division.tree;
    const std::vector<std::uint32_t> regions = tree.regions(counts.regions);
    const PointsOfCells of =
        points_of_cells(CellNumbers(division.header, division.splits, tree.cell_count()), division.points);

    std::vector<AcdfColumn> columns(regions.size() * coarse.column_count());
    std::vector<std::uint16_t> set_of_row(tree.cell_count());
    std::vector<std::uint8_t> rows(tree.cell_count() * width);
    std::atomic<std::size_t> done{0};
    parallel_for(std::size_t{0}, regions.size(), [&](std::size_t r) {
        const VisibilityCells::Range& cells = tree.cells(regions[r]);
        const std::vector<VisibilitySums> known = tree.sums(cells);
        const VisibilityParts parts(coarse, known);
        const VisibilityRows told = visibility_rows(parts, coarse, known, tree, regions[r], of, division.points,
                                                    scene.occluded, division.light.dark, size.beside_cosine);
        const std::vector<AcdfColumn>& own = parts.columns();
        std::copy(own.begin(), own.end(), columns.begin() + std::ptrdiff_t(r * own.size()));
        for (std::uint32_t cell = cells.begin; cell < cells.end; ++cell) {
            const std::size_t first = (cell - cells.begin) * parts.count();
            encode_visibility(parts, &told.all[first], &told.factors[first], &rows[cell * width]);
            set_of_row[cell] = static_cast<std::uint16_t>(r);
        }
        report(kDivisionShare + (1.0 - kDivisionShare) * double(++done) / double(regions.size()));
    });

    VisibilityChunk chunk{division.header, division.splits, std::move(columns), std::move(set_of_row),
                          std::move(rows)};
    chunk.header.split_count = static_cast<std::uint32_t>(division.splits.size());
    chunk.header.row_count = tree.cell_count();
    chunk.header.column_count = coarse.column_count();
    chunk.header.further_sets = static_cast<std::uint32_t>(regions.size() - 1);
    if (chunk.header.further_sets == 0) chunk.set_of_row.clear();
    std::vector<Chunk> chunks{chunk.stored()};
    if (portals)
        chunks.push_back(portal_chunk(local, *portals, of, division.points, tree.cell_count(), scene.occluded));
    report(1.0);
    return chunks;
}

} // namespace acdf::compress
