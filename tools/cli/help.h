// How --help looks.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace acdf::tools {

/// CLI11's layout with descriptions wrapped to the width of a terminal.
class HelpFormatter : public CLI::Formatter {
public:
    HelpFormatter();
    std::string make_option_desc(const CLI::Option* option) const override;
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
    std::string make_usage(const CLI::App* app, std::string name) const override;
    std::string make_description(const CLI::App* app) const override;
    std::string make_subcommand(const CLI::App* app) const override;
};

/// Breaks `text` at spaces into lines of at most `width` bytes; line breaks in it stay.
std::string wrap(const std::string& text, std::size_t width);

/// The end of a subcommand's help: a longer explanation (may be empty), examples, one a line without indent, and
/// the exit codes, of which `validate` has one more.
std::string help_footer(const std::string& explanation, const std::string& examples,
                        const std::string& more_exit_codes = "");

} // namespace acdf::tools
