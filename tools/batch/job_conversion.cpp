#include "tools/batch/job_conversion.h"

#include "tools/cli/usage.h"
#include "tools/cli/values.h"

#include <CLI/CLI.hpp>

#include <filesystem>

namespace acdf::tools {
namespace {

/// Options are bound to members of the conversion, and `command` must live as long.
struct ParsedConversion {
    std::unique_ptr<Conversion> conversion;
    CLI::App command;
};

std::unique_ptr<Conversion> conversion_of(const std::string& kind) {
    return kind == "env" ? env_conversion() : kind == "local" ? local_conversion() : brdf_conversion();
}

} // namespace

std::shared_ptr<Conversion> make_conversion(const BatchJob& job) {
    const auto parsed = std::make_shared<ParsedConversion>();
    parsed->conversion = conversion_of(job.kind->name);
    Conversion& conversion = *parsed->conversion;
    parsed->command.name(job.kind->name);
    parsed->command.set_help_flag();
    conversion.add_options(parsed->command);
    refuse_what_is_no_value(parsed->command);
    std::vector<std::string> reversed(job.options.rbegin(), job.options.rend()); // as CLI11 wants it
    try {
        parsed->command.parse(std::move(reversed));
        conversion.source = job.source;
        for (std::string* file : conversion.files())
            if (file != &conversion.source) *file = (std::filesystem::path(job.base) / *file).string();
        if (!job.maps.empty() && !conversion.takes_all(job.maps))
            throw OptionError("several maps in one file are for env, and need an axis: {\"axis\": \"time=6,9\"}");
        conversion.check();
    } catch (const CLI::ParseError& error) {
        throw OptionError(what_is_wrong(parsed->command, error));
    }
    return {parsed, &conversion};
}

} // namespace acdf::tools
