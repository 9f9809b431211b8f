// Any bytes: reading them as a manifest of `acdf batch` gives a job or one fault for each line, in order.
#include "tests/fuzz/require.h"
#include "tools/batch/manifest.h"

#include <cstdint>

namespace {

using acdf_test::require;

bool is_text(const std::string& text) {
    for (const char c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) return false;
    return acdf::tools::find_non_utf8(text) == std::string::npos;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const acdf::tools::Manifest manifest = acdf::tools::parse_manifest(text);
    std::size_t line = 0;
    for (const acdf::tools::ManifestJob& job : manifest.jobs) {
        require(job.line > line && !job.source.empty() && is_text(job.source) && is_text(job.output));
        line = job.line;
        if (!job.options) continue;
        for (const std::string& option : *job.options) require(!option.empty() && is_text(option));
    }
    line = 0;
    for (const acdf::tools::ManifestError& error : manifest.errors) {
        require(error.line > line && !error.what.empty());
        line = error.line;
    }
    return 0;
}
