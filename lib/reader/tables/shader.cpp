// Tables for shaders, of a loaded file.
#include <acdf/shader_tables.h>

#include "memory.h"
#include "tables/cells.h"
#include "tables/walk.h"

#include <cstddef>
#include <cstdio>
#include <utility>

namespace acdf {

static_assert(offsetof(AcdfCells, numbers) == 4 * ACDF_CELLS_NUMBERS);
static_assert(offsetof(AcdfCells, directions) == 4 * ACDF_CELLS_DIRECTIONS);
static_assert(offsetof(AcdfCells, pieces) == 4 * ACDF_CELLS_PIECES);
static_assert(offsetof(AcdfCells, densities) == 4 * ACDF_CELLS_DENSITIES);
static_assert(offsetof(AcdfCells, ends) == 4 * ACDF_CELLS_ENDS);
static_assert(sizeof(AcdfPiece) == 4 * ACDF_PIECE_WORDS && sizeof(AcdfPieceEnds) == 4 * ACDF_ENDS_WORDS);

namespace {

Status none(const char* why) {
    Status status;
    status.code = ErrorCode::unsupported;
    std::snprintf(status.message, sizeof status.message, "no tables for shaders: %s", why);
    return status;
}

} // namespace

ShaderTables::~ShaderTables() { give_block({}, block_); }
ShaderTables::ShaderTables(ShaderTables&& other) noexcept : block_(std::exchange(other.block_, AcdfBlock{})) {}
ShaderTables& ShaderTables::operator=(ShaderTables&& other) noexcept {
    std::swap(block_, other.block_);
    return *this;
}

Status ShaderTables::make(const File& file, ShaderTables& out) noexcept {
    out = ShaderTables();
    if (file.kind() != ACDF_KIND_ENVIRONMENT) return none("it is no environment");
    if (file.description().parameterization != ACDF_PARAM_LATLONG)
        return none("its cells lie on the octahedral square; walks (--walk) do that, or --domain latlong");
    if (!make_shader_cells(file.environment().data(), TreeSurvey(file.environment().data(), file.tree_units()),
                           out.block_))
        return none(
            "its cells tilt (--fit pdf), are more than 65535 pieces or too small at a pole, or memory is too "
            "little; make it with fewer cells");
    return {};
}

Status ShaderTables::make_walk(const File& file, ShaderTables& out) noexcept {
    out = ShaderTables();
    if (file.kind() == ACDF_KIND_TABLE) return none("it is no environment, no local environment and no BRDF");
    if (!acdf::make_walk(file, out.block_))
        return none("its cells tilt (--fit pdf), too many share their curves, or memory is too little");
    return {};
}

} // namespace acdf
