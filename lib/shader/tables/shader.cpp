// Tables for shaders, of a loaded file.
#include <acdf/shader/tables.h>
#include <acdf/views.h>

#include "memory.h"
#include "message.h"
#include "shader/tables/walk.h"

#include <cstddef>
#include <utility>

namespace acdf {

namespace {

Status none(const char* why) {
    Status status;
    status.code = ACDF_UNSUPPORTED;
    write_message(status.message, sizeof status.message, "no tables for shaders: %s", why);
    return status;
}

bool has_halvings(const File& file) {
    if (file.kind() == ACDF_KIND_ENVIRONMENT) return file.environment().data().halved;
    if (file.kind() == ACDF_KIND_LOCAL) return file.local().data().environment.halved;
    return file.kind() != ACDF_KIND_BRDF || file.brdf().data().halved;
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
    if (file.kind() == ACDF_KIND_TABLE)
        return none("it is neither an environment nor a local environment nor a BRDF");
    if (!has_halvings(file)) return none("its fit has curves; make it with --fit variance");
    if (!acdf::make_walk(file, out.block_)) return none("its maps break a rule, or memory is too little");
    return {};
}

} // namespace acdf
