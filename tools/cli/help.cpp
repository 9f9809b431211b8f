#include "tools/cli/help.h"

#include <algorithm>
#include <sstream>

namespace acdf::tools {
namespace {

constexpr std::size_t line_width = 96;
constexpr std::size_t option_column = 28;

// The first sentence or line: what the list of subcommands shows.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

} // namespace

HelpFormatter::HelpFormatter() {
    column_width(option_column);
    label("Positionals", "Arguments");
    label("REQUIRED", "(required)");
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
    return wrap(option->get_description(), line_width - option_column);
}

// One blank line between groups, not two.
std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, std::move(name), mode), "\n\n\n", "\n\n");
}

// "Usage: acdf info ...", and not "Usage: info ...".
std::string HelpFormatter::make_usage(const CLI::App* app, std::string name) const {
    const CLI::App* parent = app->get_parent();
    if (parent && name == app->get_name()) name = parent->get_name() + " " + name;
    return CLI::Formatter::make_usage(app, name);
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
    return wrap(app->get_description(), line_width) + "\n\n";
}

std::string HelpFormatter::make_subcommand(const CLI::App* app) const {
    std::stringstream out;
    CLI::detail::format_help(out, app->get_name(), first_line(app->get_description()), 13);
    return out.str();
}

std::string wrap(const std::string& text, std::size_t width) {
    std::string out;
    std::size_t line = 0;
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] == '\n') {
            out += '\n';
            line = 0;
            ++at;
            continue;
        }
        const std::size_t end = std::min(text.find_first_of(" \n", at + 1), text.size());
        std::string word = text.substr(at, end - at);
        if (line + word.size() > width && line > 0) {
            out += '\n';
            line = 0;
            word.erase(0, word.find_first_not_of(' '));
        }
        out += word;
        line += word.size();
        at = end;
    }
    return out;
}

std::string help_footer(const std::string& explanation, const std::string& examples,
                        const std::string& more_exit_codes) {
    std::string out;
    if (!explanation.empty()) out += wrap(explanation, line_width) + "\n\n";
    out += "Examples:\n";
    for (std::size_t at = 0; at < examples.size();) {
        const std::size_t end = std::min(examples.find('\n', at), examples.size());
        out += "  " + examples.substr(at, end - at) + "\n";
        at = end + 1;
    }
    const std::string codes = "Exit codes: 0 done, 1 input or I/O error (one line on stderr), 2 wrong usage" +
                              (more_exit_codes.empty() ? "" : ", " + more_exit_codes);
    return out + "\n" + wrap(codes, line_width);
}

} // namespace acdf::tools
