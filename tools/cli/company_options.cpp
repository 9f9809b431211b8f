#include "tools/cli/company_options.h"

#include "tools/cli/company_text.h"

#include <CLI/CLI.hpp>

#include <string>

namespace acdf::tools {

void add_company(CLI::App& command, builder::Company& company, bool mean) {
    const char* group = "Company";
    command
        .add_option_function<std::string>(
            "--with",
            [&company, mean](const std::string& text) {
                if (!parse_company(text, company) || (!mean && company.kind == ACDF_COMPANY_MEAN))
                    throw CLI::ValidationError("--with", "'" + text + "' is none of none, cosine, brdf" +
                                                             (mean ? ", mean" : ""));
            },
            mean ? "What the file is combined with, by multiple importance sampling: cosine (diffuse surfaces), "
                   "brdf "
                   "(lobes of several widths), mean (as if it were the same everywhere: Karlik et al. 2019). Where "
                   "that is enough the density is 0: never use such a file alone"
                 : "What the file is combined with, by multiple importance sampling: cosine (diffuse surfaces), "
                   "brdf "
                   "(lobes of several widths). Where that is enough the density is 0: never use such a file alone")
        ->option_text("NAME [none]")
        ->group(group);
    add_weighing(command, company);
}

void add_weighing(CLI::App& command, builder::Company& company) {
    const char* group = "Company";
    command
        .add_option_function<std::string>(
            "--shares",
            [&company](const std::string& text) {
                if (!parse_shares(text, company))
                    throw CLI::ValidationError("--shares", "needs two numbers from 0.001 to 1000 such as 1:1");
            },
            "Samples that your renderer draws from the file and from the company, in proportion")
        ->option_text("L:B [1:1]")
        ->group(group);
    command
        .add_option_function<std::string>(
            "--heuristic",
            [&company](const std::string& text) {
                if (!parse_heuristic(text, company))
                    throw CLI::ValidationError("--heuristic", "'" + text + "' is none of balance, power");
            },
            "How your renderer weighs them: balance, or power (squares)")
        ->option_text("NAME [balance]")
        ->group(group);
}

} // namespace acdf::tools
