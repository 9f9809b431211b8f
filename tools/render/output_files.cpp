#include "tools/render/output_files.h"

#include "tools/cli/output.h"

#include <algorithm>
#include <filesystem>
#include <set>

namespace acdf::tools {
namespace {

const std::vector<std::string> names_of_page = {"index.html", "render.json"};
const std::vector<std::string> names_of_reference = {"reference.exr", "reference.png"};

/// Of a sampler; the first one has no gain.
std::vector<std::string> names_of(const std::string& stem, bool is_first) {
    std::vector<std::string> names{stem + ".exr", stem + ".png", stem + "-variance.png", stem + "-above.png"};
    if (!is_first) names.push_back(stem + "-gain.png");
    return names;
}

} // namespace

std::vector<std::string> file_stems(const std::vector<SamplerSpec>& samplers) {
    std::vector<std::string> out;
    std::set<std::string> used(names_of_reference.begin(), names_of_reference.end());
    for (const SamplerSpec& spec : samplers) {
        std::string stem = file_stem(spec);
        std::vector<std::string> names = names_of(stem, out.empty());
        const auto is_used = [&used](const std::string& name) { return used.count(name) > 0; };
        for (int i = 2; std::any_of(names.begin(), names.end(), is_used); ++i) {
            stem = file_stem(spec) + "-" + std::to_string(i);
            names = names_of(stem, out.empty());
        }
        used.insert(names.begin(), names.end());
        out.push_back(stem);
    }
    return out;
}

void refuse_outputs(const std::string& folder, const std::vector<std::string>& stems, bool force,
                    const std::vector<std::string>& inputs) {
    std::vector<std::string> names = names_of_page;
    if (!stems.empty()) names.insert(names.end(), names_of_reference.begin(), names_of_reference.end());
    for (std::size_t i = 0; i < stems.size(); ++i)
        for (std::string& name : names_of(stems[i], i == 0)) names.push_back(std::move(name));
    for (const std::string& name : names) Output((std::filesystem::path(folder) / name).string(), force, inputs);
}

std::vector<std::string> files_of(const std::vector<SamplerSpec>& samplers, const std::string& data) {
    std::vector<std::string> out;
    for (const SamplerSpec& spec : samplers) {
        if (spec.kind == SamplerKind::file) out.push_back((std::filesystem::path(data) / spec.path).string());
        for (std::string& file : files_of(spec.parts, data)) out.push_back(std::move(file));
    }
    return out;
}

} // namespace acdf::tools
