// Sampling trees of curves, of environments and of local environments.
#include "curves/functions.h"

#include <acdf/curves/normals.h>
#include <acdf/curves/tree.h>

namespace acdf {
namespace {

/// A cell, and the random numbers that lead there.
struct Cell {
    AcdfTiltedRange tilted[2];
    AcdfRange range[2];
    AcdfStratum strata[2] = {{0.0, 1.0}, {0.0, 1.0}};

    explicit Cell(const AcdfEnvironment& env) : tilted{acdf_whole_axis(env.columns), acdf_whole_axis(env.rows)} {}

    double sample(const AcdfEnvironment& env, double* u) {
        return found(acdf_tree_sample(env.tree, env.root, u, tilted));
    }
    double find(const AcdfEnvironment& env, const std::uint32_t* square) {
        return found(acdf_tree_find(env.tree, env.root, square, tilted, strata));
    }
    /// Pdf per steradian, where the probability is p, at fractions t of the cell in the measures of the axes.
    float pdf(const AcdfGrid& grid, const double* t, double p) const {
        const double area =
            2.0 * ACDF_PI * static_cast<double>(range[0].high - range[0].low) * acdf_grid_height(&grid, &range[1]);
        const double shape = acdf_tilt_pdf(tilted[0].tilt, t[0]) * acdf_tilt_pdf(tilted[1].tilt, t[1]);
        return acdf_positive_pdf(p * static_cast<double>(grid.columns) / area * shape);
    }

private:
    double found(double probability) {
        for (int axis = 0; axis < 2; ++axis) range[axis] = acdf_untilted(&tilted[axis]);
        return probability;
    }
};

/// The cell of a direction, and where in it the direction lies. Returns the cell's probability; 0: none.
double find(const AcdfEnvironment& env, const float* direction, Cell& cell, double* t) {
    const AcdfGrid grid = acdf_environment_grid(&env);
    double position[2];
    std::uint32_t square[2];
    if (!acdf_grid_square(&grid, direction, square, position)) return 0.0;
    const double p = cell.find(env, square);
    if (p > 0.0) acdf_grid_fractions(&grid, direction, position, cell.range, t);
    return p;
}

} // namespace

AcdfDirectionSample curves_sample(const AcdfEnvironment* env, double u0, double u1) {
    const AcdfGrid grid = acdf_environment_grid(env);
    double u[2] = {acdf_unit_interval(u0), acdf_unit_interval(u1)};
    Cell cell(*env);
    const double p = cell.sample(*env, u);
    for (int axis = 0; axis < 2; ++axis) u[axis] = acdf_tilt_sample(cell.tilted[axis].tilt, u[axis]);
    AcdfDirectionSample out = acdf_grid_position(&grid, cell.range, u, p);
    out.pdf = cell.pdf(grid, u, p);
    return out;
}

float curves_pdf(const AcdfEnvironment* env, const float direction[3]) {
    Cell cell(*env);
    double t[2];
    const double p = find(*env, direction, cell, t);
    return p > 0.0 ? cell.pdf(acdf_environment_grid(env), t, p) : 0.0f;
}

int curves_invert(const AcdfEnvironment* env, const float direction[3], double u[2]) {
    Cell cell(*env);
    double t[2];
    if (!(find(*env, direction, cell, t) > 0.0)) return 0;
    for (int axis = 0; axis < 2; ++axis)
        u[axis] = acdf_stratum_number(&cell.strata[axis], acdf_tilt_cdf(cell.tilted[axis].tilt, t[axis]));
    return 1;
}

double curves_find(const AcdfEnvironment* env, const std::uint32_t square[2], AcdfRange range[2],
                   AcdfStratum strata[2]) {
    Cell cell(*env);
    const double p = cell.find(*env, square);
    for (int axis = 0; axis < 2; ++axis) {
        range[axis] = cell.range[axis];
        strata[axis] = cell.strata[axis];
    }
    return p;
}

int curves_local_bins(const AcdfLocal* local, const float normal[3], AcdfNormalBins* out) {
    if (local->subdivisions > 0) return acdf_octahedral_bins(local->subdivisions, normal, out);
    return acdf_latlong_bins(local->columns, local->rows, normal, out);
}

// The tree of the nearest bin.
void curves_local_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    AcdfNormalBins bins;
    acdf_local_nothing(normal, out);
    if (!curves_local_bins(local, out->surface, &bins)) return;
    const AcdfBin& bin = local->bins[acdf_nearest_bin(&bins)];
    if (bin.root == ACDF_NO_ROOT) acdf_local_by_tree(local->environment.root, out);
    else if (bin.share > 0.0f) acdf_local_by_tree(bin.root, out);
}

double curves_local_irradiance(const AcdfLocal* local, const float normal[3]) {
    AcdfNormalBins bins;
    AcdfLocalPoint point;
    curves_local_at(local, normal, &point);
    if (point.what == ACDF_LOCAL_NOTHING || !curves_local_bins(local, normal, &bins)) return 0.0;
    if (point.by.root == local->environment.root) return local->environment.total;
    // A file may have a total and a share whose product is too large.
    return acdf_clamp(local->environment.total * static_cast<double>(local->bins[acdf_nearest_bin(&bins)].share),
                      0.0, 0x1.fffffffffffffp1023);
}

} // namespace acdf
