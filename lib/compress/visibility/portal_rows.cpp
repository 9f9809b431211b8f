#include "compress/visibility/portal_rows.h"
#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace acdf::compress {
namespace {

/// Rays of a point to all that the row samples, to find what comes in by other ways.
constexpr std::uint32_t kRays = 16;
/// How much an estimate from few points is trusted, and the least and the most of the samples that rows take: light
/// may come where no ray found any, and through a portal that no ray came through.
constexpr VisibilityCaution kCaution{0.02f, 1.0f};
constexpr double kLeastOfRow = 0.02, kMostOfRow = 0.9;
/// Of the mean light of points, of which so many are asked: what is added to that of each, so that the darkest do
/// not decide alone.
constexpr double kDark = 0.1;
constexpr std::size_t kAsked = 4096;

/// Numbers in [0, 1), evenly spread over `index` for each `stream` (Roberts 2018).
double spread(std::uint64_t index, std::uint64_t stream, double step) {
    return std::fmod((static_cast<double>(index) + 0.5) * step + static_cast<double>(stream) * 0.6180339887498949,
                     1.0);
}

bool above(const VisibilityPoint& point, const float* d) {
    return d[0] * point.normal[0] + d[1] * point.normal[1] + d[2] * point.normal[2] > 0.0f;
}

/// The light of a point through pieces of portals, negative where a ray is met, and by other ways. Relative to the
/// total.
struct PortalLight {
    std::vector<float> given; ///< one a piece of all portals
    float other = 0.0f;

    float all() const {
        float sum = other;
        for (const float g : given) sum += std::max(g, 0.0f);
        return sum;
    }
};

class PortalRays {
public:
    PortalRays(const AcdfLocal& local, const PortalSet& set, const Occluded& occluded)
        : local_(local), table_(set.table(nullptr)), occluded_(occluded), parts_(set.row_bytes() - 1) {}

    /// Of point `i` of all.
    PortalLight trace(std::size_t i, const VisibilityPoint& point) const {
        PortalLight out{std::vector<float>(parts_, 0.0f)};
        AcdfVisiblePortal visible_portals[ACDF_MAX_PORTALS];
        const double from[3] = {double{point.position[0]}, double{point.position[1]}, double{point.position[2]}};
        std::uint32_t seen = 0;
        for (std::uint32_t k = 0; k < table_.header->portal_count; ++k) {
            if (!acdf_portal_bounds(&table_, &table_.portals[k], from, &visible_portals[seen])) continue;
            trace_portal(i, point, k, visible_portals[seen], out);
            ++seen;
        }
        out.other = other_ways(i, point, visible_portals, seen);
        return out;
    }

private:
    bool is_met(const VisibilityPoint& point, const float* d) const { return occluded_(point, {d[0], d[1], d[2]}); }

    void trace_portal(std::size_t i, const VisibilityPoint& point, std::uint32_t portal,
                      AcdfVisiblePortal& visible_portal, PortalLight& out) const {
        const std::uint32_t pieces = table_.header->pieces;
        AcdfPortalEye eye = {};
        eye.table = &table_;
        std::copy_n(point.normal.begin(), 3, eye.x + 3);
        const AcdfPortalPieces all = acdf_all_pieces(&table_);
        acdf_portal_weigh(&eye, portal, &all, &visible_portal);
        for (std::uint32_t x = 0; x < pieces; ++x)
            for (std::uint32_t y = 0; y < pieces; ++y) {
                const float weight = visible_portal.piece[x][y];
                if (!(weight > 0.0f)) continue;
                const std::size_t part = (portal * pieces + x) * pieces + y;
                const std::uint32_t piece[2] = {x, y};
                const double u[2] = {spread(i, part, kSteps[0]), spread(i, 3 * part, kSteps[1])};
                float d[3];
                acdf_piece_sample(&table_, &visible_portal, piece, u, d);
                if (above(point, d)) out.given[part] = is_met(point, d) ? -weight : weight;
            }
    }

    float other_ways(std::size_t i, const VisibilityPoint& point, const AcdfVisiblePortal* visible_portals,
                     std::uint32_t count) const {
        AcdfLocalPoint row;
        acdf_local_at(&local_, point.normal.data(), &row);
        if (row.what != ACDF_LOCAL_ROWS) return 0.0f;
        std::uint32_t arrives = 0;
        for (std::uint32_t r = 0; r < kRays; ++r) {
            const AcdfDirectionSample s = acdf_local_sample_at(&local_, &row, spread(kRays * i + r, 0, kSteps[0]),
                                                               spread(kRays * i + r, 0, kSteps[1]));
            if (!(s.pdf > 0.0f) || !above(point, s.direction)) continue;
            const double d[3] = {double{s.direction[0]}, double{s.direction[1]}, double{s.direction[2]}};
            const bool through =
                std::any_of(visible_portals, visible_portals + count, [&](const AcdfVisiblePortal& visible_portal) {
                    AcdfPortalSpot spot;
                    return acdf_visible_portal_find(&table_, &visible_portal, d, &spot) &&
                           acdf_portal_spot_pdf(&table_, &visible_portal, &spot) > 0.0;
                });
            arrives += !through && !is_met(point, s.direction);
        }
        return static_cast<float>(row.sum / row.length * arrives / kRays);
    }

    static constexpr double kSteps[2] = {0.7548776662466927, 0.5698402909980532};

    const AcdfLocal& local_;
    AcdfPortalTable table_;
    const Occluded& occluded_;
    std::size_t parts_;
};

/// What the points of a cell see.
struct CellSums {
    std::vector<float> all, seen;
    float points = 0.0f;
    double other = 0.0;
};

/// How much of the samples rows sample best: second moments of what they and visible_portals sample are balanced.
double share_of_row(double other, double through) {
    if (!(other + through > 0.0)) return 0.5; // nothing is known
    const double root = std::sqrt(other / (other + through));
    return std::clamp(root / (1.0 - root * root + root), kLeastOfRow, kMostOfRow);
}

void encode_cell(const CellSums& sums, std::uint32_t portals, std::uint32_t pieces, std::uint8_t* out) {
    double through = 0.0;
    for (const float seen : sums.seen) through += double{seen};
    *out++ = static_cast<std::uint8_t>(std::lround(256.0 * share_of_row(sums.other, through)) - 1);
    for (std::uint32_t k = 0; k < portals; ++k) {
        float all = 0.0f, seen = 0.0f;
        for (std::uint32_t c = k * pieces; c < (k + 1) * pieces; ++c) {
            all += sums.all[c];
            seen += sums.seen[c];
        }
        const float points = std::max(sums.points, 1e-6f);
        const VisibilityPrior prior{all > 0.0f ? seen / all : 0.5f, kCaution.prior};
        for (std::uint32_t c = k * pieces; c < (k + 1) * pieces; ++c)
            *out++ =
                visibility_code(double{visible_factor(sums.all[c], sums.seen[c], points, prior, kCaution.floor)});
    }
}

/// The mean light of some of the points. Throws where none arrives through a portal.
double mean_light(const PortalRays& rays, const PortalSet& set, const std::vector<VisibilityPoint>& points) {
    const std::size_t step = std::max<std::size_t>(points.size() / kAsked, 1), count = points.size() / step;
    const std::size_t pieces = std::size_t{set.header.pieces} * set.header.pieces;
    std::vector<PortalLight> lights(count);
    parallel_for(std::size_t{0}, count, [&](std::size_t i) { lights[i] = rays.trace(i * step, points[i * step]); });
    double mean = 0.0;
    for (const PortalLight& light : lights) mean += double{light.all()} / double(count);
    for (std::size_t k = 0; k < set.portals.size(); ++k) {
        const bool arrives = std::any_of(lights.begin(), lights.end(), [&](const PortalLight& light) {
            const float* first = &light.given[k * pieces];
            return std::any_of(first, first + pieces, [](float given) { return given > 0.0f; });
        });
        if (!arrives)
            throw std::invalid_argument("no light arrives through portal " + std::to_string(k + 1) +
                                        ": it is closed");
    }
    return mean;
}

CellSums sum_up_cell(const PortalRays& rays, const PointsOfCells& of, const std::vector<VisibilityPoint>& points,
                     std::uint32_t cell, std::size_t parts, double dark) {
    CellSums out{std::vector<float>(parts, 0.0f), std::vector<float>(parts, 0.0f)};
    for (std::uint32_t i = of.first[cell]; i < of.first[cell + 1]; ++i) {
        const PortalLight light = rays.trace(of.point[i], points[of.point[i]]);
        const double all = double{light.all()};
        if (!(all > 0.0)) continue; // as of what is inside of something
        const auto weight = static_cast<float>(1.0 / std::sqrt(all * all + dark * dark));
        out.points += 1.0f;
        out.other += double{weight * light.other};
        for (std::size_t p = 0; p < parts; ++p) {
            out.all[p] += weight * std::fabs(light.given[p]);
            out.seen[p] += weight * std::max(light.given[p], 0.0f);
        }
    }
    return out;
}

template <class Record>
void append_all(std::vector<std::uint8_t>& bytes, const std::vector<Record>& records) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(records.data());
    bytes.insert(bytes.end(), first, first + records.size() * sizeof(Record));
}

} // namespace

Chunk portal_chunk(const AcdfLocal& local, const PortalSet& set, const PointsOfCells& of,
                   const std::vector<VisibilityPoint>& points, std::uint32_t cells, const Occluded& occluded) {
    const std::size_t width = set.row_bytes();
    const PortalRays rays(local, set, occluded);
    const double dark = kDark * mean_light(rays, set, points);
    std::vector<std::uint8_t> rows(cells * width);
    parallel_for(0u, cells, [&](std::uint32_t cell) {
        encode_cell(sum_up_cell(rays, of, points, cell, width - 1, dark), set.header.portal_count,
                    set.header.pieces * set.header.pieces, &rows[cell * width]);
    });
    Chunk chunk{ACDF_CHUNK_PORTALS, {}};
    append_all(chunk.bytes, std::vector<AcdfPortals>{set.header});
    append_all(chunk.bytes, set.portals);
    append_all(chunk.bytes, set.maps);
    append_all(chunk.bytes, set.sums);
    append_all(chunk.bytes, rows);
    return chunk;
}

} // namespace acdf::compress
