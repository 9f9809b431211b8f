// What a PLY file claims to hold, against its bytes.
#pragma once

#include <string>

namespace acdf::input {

/// Refuses a PLY file of which the header, or a list, claims more elements than the file has: the importer would
/// ask for memory first, or accept a file that was cut short. Reads the file once and holds a line of
/// it. Throws Error.
void check_ply_counts(const std::string& path);

} // namespace acdf::input
