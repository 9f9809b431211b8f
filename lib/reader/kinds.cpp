// The views of local environments, BRDFs and tables.
#include "check/check.h"
#include "opened_file.h"

#include <acdf/views.h>

namespace acdf {
namespace {

void make_local(const Parts& parts, AcdfFile& file) {
    const AcdfDescription& description = *parts.description;
    AcdfLocal& local = file.local;
    // Its environment is complete, whatever the file is made for: it has no partner.
    local.environment = file.environment;
    set_grid(parts, local.environment);
    local.rows_of_normals = file.rows;
    local.partner = parts.partner;
    local.bins = parts.bins;
    local.cosine_share = static_cast<double>(parts.local->cosine_share);
    if (description.axis_count == 3) { // an octahedron's 4 n^2 + 2 corners
        while (4 * local.subdivisions * local.subdivisions + 2 < parts.axes[2].resolution) ++local.subdivisions;
    } else {
        local.rows = parts.axes[2].resolution;
        local.columns = parts.axes[3].resolution;
    }
}

void make_brdf(const Parts& parts, AcdfFile& file) {
    file.brdf = {file.environment.halved,
                 file.rows,
                 parts.bins,
                 parts.views,
                 parts.nodes,
                 parts.axes[0].resolution,
                 parts.halvings ? ACDF_HALF_STEPS : parts.axes[1].resolution,
                 parts.description->total,
                 file.environment.curves,
                 file.environment.tree};
}

void make_table(const Parts& parts, AcdfFile& file) {
    const u32 axes = parts.description->axis_count;
    u32 indexed = 0;
    while (parts.axes[indexed].role == ACDF_AXIS_INDEXED) ++indexed; // rule 5012: one axis at least is sampled
    file.table = {parts.halvings, parts.bins, parts.axes, axes, indexed, parts.description->total, parts.partner};
}

} // namespace

void make_view(const Parts& parts, AcdfFile& file) noexcept {
    if (file.kind() == ACDF_KIND_LOCAL) make_local(parts, file);
    if (file.kind() == ACDF_KIND_BRDF) make_brdf(parts, file);
    if (file.kind() == ACDF_KIND_TABLE) make_table(parts, file);
}

LocalEnvironmentView File::local() const noexcept { return LocalEnvironmentView(opened_->local); }
BrdfView File::brdf() const noexcept { return BrdfView(opened_->brdf); }
TableView File::table() const noexcept { return TableView(opened_->table); }

} // namespace acdf
