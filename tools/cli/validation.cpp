#include "tools/cli/validation.h"

#include "indexed/check.h"
#include "visibility/check.h"

namespace acdf::tools {

Verdict validate_all(const std::vector<std::uint8_t>& bytes, const std::function<bool(const Finding&)>& take) {
    auto* const context = const_cast<void*>(static_cast<const void*>(&take));
    const FindingSink sink = [](const Finding& finding, void* taker) -> bool {
        return (*static_cast<const std::function<bool(const Finding&)>*>(taker))(finding);
    };
    Verdict verdict = validate(bytes.data(), bytes.size(), sink, context, with_curves());
    File file;
    if (!verdict.valid() || !File::from_memory(bytes.data(), bytes.size(), file, with_curves()).ok())
        return verdict;
    const Verdict beside = file.kind() == ACDF_KIND_INDEXED ? validate_maps(file, sink, context)
                                                            : validate_visibility(file, sink, context);
    return {beside.errors, verdict.warnings + beside.warnings};
}

} // namespace acdf::tools
