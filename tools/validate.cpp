// acdf validate: every broken rule of SPEC.md, by number, severity and byte.
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/options.h"
#include "tools/cli/validation.h"
#include "tools/commands.h"

#include "rules/rules.h"
#include "rules/signatures.h"

#include <acdf/curves/curves.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace acdf::tools {
namespace {

using Json = nlohmann::ordered_json;

struct ValidateArguments {
    std::vector<std::string> files;
    bool json = false, quiet = false, strict = false;
};

struct Fault {
    const Rule* rule;
    std::uint64_t offset;
    std::string detail;
};

struct Report {
    std::string path;
    std::vector<Fault> faults;
    acdf::Verdict verdict;

    bool passes(bool strict) const { return verdict.valid() && !(strict && verdict.warnings > 0); }
};

const char* severity_name(Severity severity) { return severity == Severity::error ? "error" : "warning"; }

Report validate_file(const std::string& path) {
    Report report{path, {}, {}};
    const std::vector<std::uint8_t> bytes = read_acdf_bytes(path);
    report.verdict = validate_all(bytes, [&](const Finding& finding) {
        const bool foreign = finding.number == 2002;
        report.faults.push_back({find_rule(finding.number), finding.offset,
                                 foreign ? what_is_it(bytes.data(), bytes.size()) : finding.detail});
        return true;
    });
    return report;
}

Json to_json(const Report& report, bool strict) {
    Json faults = Json::array();
    for (const Fault& fault : report.faults)
        faults.push_back({{"rule", fault.rule->number},
                          {"id", fault.rule->id},
                          {"severity", severity_name(fault.rule->severity)},
                          {"offset", fault.offset},
                          {"sentence", fault.rule->sentence},
                          {"detail", fault.detail}});
    return {{"file", report.path},
            {"valid", report.passes(strict)},
            {"errors", report.verdict.errors},
            {"warnings", report.verdict.warnings},
            {"findings", faults}};
}

std::string counted(std::uint64_t n, const char* what) {
    return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

void print(const Report& report, const ValidateArguments& options) {
    for (const Fault& fault : report.faults)
        std::printf("%s: byte %llu: %s %d (%s): %s\n    rule: %s\n", printable(report.path).c_str(),
                    static_cast<unsigned long long>(fault.offset), severity_name(fault.rule->severity),
                    fault.rule->number, fault.rule->id, printable(fault.detail).c_str(), fault.rule->sentence);
    if (options.quiet) return;
    const acdf::Verdict& verdict = report.verdict;
    if (report.faults.empty()) std::printf("%s: valid\n", printable(report.path).c_str());
    else
        std::printf("%s: %s (%s, %s)\n", printable(report.path).c_str(),
                    report.passes(options.strict) ? "valid" : "not valid", counted(verdict.errors, "error").c_str(),
                    counted(verdict.warnings, "warning").c_str());
}

// A file that cannot be read outranks one that breaks rules: its rules were never checked.
int run(const ValidateArguments& options) {
    Json reports = Json::array();
    bool unreadable = false, faulty = false;
    for (const std::string& path : options.files) {
        try {
            const Report report = validate_file(path);
            faulty |= !report.passes(options.strict);
            if (options.json) reports.push_back(to_json(report, options.strict));
            else print(report, options);
        } catch (const Failure& failure) {
            say(std::string("acdf: ") + failure.what());
            unreadable = true;
        }
    }
    if (options.json && !reports.empty())
        std::fputs(json_text(options.files.size() == 1 ? reports[0] : reports).c_str(), stdout);
    return unreadable ? exit_failed : faulty ? exit_faults : exit_done;
}

} // namespace

void add_validate(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<ValidateArguments>();
    CLI::App* command = program.add_subcommand(
        "validate", "Check files against every rule of the format's specification, and report all faults");
    command->add_option("FILE", options->files, "The files to check (- is stdin)")->required()->type_name("");
    command
        ->add_flag("--strict", options->strict,
                   "Fail on warnings too: readers accept such a file, but it wastes bytes or will surprise someone")
        ->group("Checks");
    add_json(*command, options->json);
    command
        ->add_flag("-q,--quiet", options->quiet, "Print faults only, nothing for files without any: for long lists")
        ->group("Output");
    command->footer(
        help_footer("Each finding names the number of its rule in format/SPEC.md, its severity and the byte where "
                    "it shows. Use it "
                    "on files from elsewhere, after writing your own writer, or when a renderer refuses a file.",
                    "acdf validate sky.acdf\n"
                    "acdf validate --strict --quiet library/*.acdf\n"
                    "acdf validate --json sky.acdf | jq '.findings[].rule'",
                    "3 faults found (errors; with --strict also warnings)"));
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace acdf::tools
