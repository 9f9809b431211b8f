// What acdf render writes: the names of its files, and what is refused before any long work.
#pragma once

#include "tools/render/sampler_spec.h"

#include <string>
#include <vector>

namespace acdf::tools {

/// What the names of each sampler's files begin with, in their order: no two files have the same name.
std::vector<std::string> file_stems(const std::vector<SamplerSpec>& samplers);

/// `stems`: empty where pictures are on the page alone. Throws Failure where one of the files cannot be written to
/// the folder: it exists and `force` is false, is one of `inputs`, is a folder, or the folder refuses.
void refuse_outputs(const std::string& folder, const std::vector<std::string>& stems, bool force,
                    const std::vector<std::string>& inputs);

/// The files that samplers are read from, relative to the folder `data`.
std::vector<std::string> files_of(const std::vector<SamplerSpec>& samplers, const std::string& data);

} // namespace acdf::tools
