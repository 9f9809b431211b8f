#include "tools/cli/mis_options.h"

#include "tools/cli/mis_text.h"

#include <CLI/CLI.hpp>

#include <string>

namespace acdf::tools {

void add_partner(CLI::App& command, builder::Partner& partner, AcdfKind kind) {
    const char* group = "MIS partner";
    const bool local = kind == ACDF_KIND_LOCAL;
    const std::string names = local ? "cosine (diffuse surfaces, and glossy ones)"
                                    : "cosine (diffuse surfaces), brdf (lobes of several widths), mean (a partner "
                                      "with the same pdf everywhere: Karlik et al. 2019)";
    command
        .add_option_function<std::string>(
            "--mis",
            [&partner, local](const std::string& text) {
                if (!parse_partner(text, partner) || (local && partner.kind > ACDF_PARTNER_COSINE))
                    throw CLI::ValidationError("--mis", "'" + text + "' is none of none, cosine" +
                                                            (local ? "" : ", brdf, mean"));
            },
            "The sampling technique that your renderer combines with the file by multiple importance sampling: " +
                names + ". The file's pdf is 0 where the partner alone is enough: never use such a file alone")
        ->option_text("NAME [none]")
        ->group(group);
    add_weighing(command, partner);
}

void add_weighing(CLI::App& command, builder::Partner& partner) {
    const char* group = "MIS partner";
    command
        .add_option_function<std::string>(
            "--shares",
            [&partner](const std::string& text) {
                if (!parse_shares(text, partner))
                    throw CLI::ValidationError("--shares", "needs two numbers from 0.001 to 1000 such as 1:1");
            },
            "Samples that your renderer takes from the file and from the partner, in proportion")
        ->option_text("L:B [1:1]")
        ->group(group);
    command
        .add_option_function<std::string>(
            "--heuristic",
            [&partner](const std::string& text) {
                if (!parse_heuristic(text, partner))
                    throw CLI::ValidationError("--heuristic", "'" + text + "' is none of balance, power");
            },
            "How your renderer weights them: balance, or power (squares)")
        ->option_text("NAME [balance]")
        ->group(group);
}

} // namespace acdf::tools
