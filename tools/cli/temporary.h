// Temporary files beside the outputs they become, and what killed programs left of them.
#pragma once

#include <cstddef>
#include <string>

namespace acdf::tools {

/// Makes ".acdf-XXXXXX" + `extension` in `folder`, locked (flock) as long as a descriptor of it is open. Returns
/// the descriptor, which is not inherited by other programs, and its `path`; -1 with errno where that fails.
int create_temporary(const std::string& folder, const std::string& extension, std::string& path);

/// Whether `name`, without folders, is one that create_temporary makes.
bool is_temporary_name(const std::string& name);

/// Removes the temporary files in `folder`, but those that a running program has locked, on this machine or, on
/// shared file systems that lock, on another. Where the file system has no locks none is removed. Returns how many
/// were.
std::size_t remove_stale_temporaries(const std::string& folder);

} // namespace acdf::tools
