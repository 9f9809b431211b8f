#include "input/normals/scene.h"

#include "input/error.h"
#include "input/file_name.h"
#include "input/mesh/file.h"
#include "input/mesh/instances.h"
#include "input/normals/histogram.h"
#include "input/normals/sources.h"

#include <algorithm>
#include <filesystem>
#include <new>

namespace acdf::input {
namespace {

void check_file(const std::string& path) {
    require_regular_file(path, "a mesh, a normal pass or a list");
    std::error_code error;
    if (std::filesystem::file_size(path, error) == 0 && !error) throw input_error(path, "the file is empty");
}

} // namespace

SceneNormals read_scene_normals(const std::string& path, const SceneOptions& options) {
    check_file(path);
    SceneNormals out;
    try {
        NormalHistogram histogram(options.up);
        if (is_mesh(path)) {
            out.kind = is_instances(path) ? "list of instances" : "mesh";
            add_mesh_normals(path, histogram);
        } else if (const std::string end = lower_extension(path); end == ".txt" || end == ".csv") {
            out.kind = "list";
            add_listed_normals(path, histogram);
        } else {
            out.kind = "normal pass";
            add_pixel_normals(path, options.rgb_is_normal, histogram);
        }
        out.normals = histogram.normals();
        out.skipped = histogram.skipped();
    } catch (const std::bad_alloc&) {
        throw input_error(path, "there is not enough memory to read it");
    }
    if (out.normals.empty())
        throw input_error(path, "this " + out.kind + " has no normals (" + std::to_string(out.skipped) +
                                    " are zero, NaN or of polygons without area)");
    return out;
}

} // namespace acdf::input
