// Lists of instances: meshes, and where they stand.
#pragma once

#include "input/mesh/placement.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::input {

/// A mesh of a scene and all placements where it stands.
struct Instances {
    std::string mesh; ///< path of an .obj or .ply
    std::vector<Placement> placements;
};

/// Whether a file is a list of instances, by its name: .instances.
bool is_instances(const std::string& path);

/// Reads a list: a line an instance, the twelve numbers of a Placement row by row and the mesh's file, relative to
/// the list's folder. Lines that begin with # are comments. Meshes are in the order in which they come first.
/// Throws Error: one line.
std::vector<Instances> read_instances(const std::string& path);

/// A file of a scene and, of a list of instances, the meshes. Throws Error.
std::vector<std::string> scene_files(const std::string& path);

/// Bytes of its meshes, each counted as often as it stands somewhere; 0 of what is not there or cannot be read,
/// which is reported when it is read.
std::uint64_t scene_bytes(const std::string& path);

/// SHA-256, 64 hex digits: of a file's bytes; of a list of instances, of the digits of all its files, a line each.
/// Throws Error.
std::string scene_sha256(const std::string& path);

} // namespace acdf::input
