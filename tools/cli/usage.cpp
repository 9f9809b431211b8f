#include "tools/cli/usage.h"

#include "tools/cli/messages.h"
#include "tools/cli/nearest.h"

#include <CLI/CLI.hpp>

#include <vector>

namespace acdf::tools {
namespace {

std::string did_you_mean(const std::string& name) { return name.empty() ? "" : "; did you mean " + name + "?"; }

/// Of the first option among words that nothing takes: the option that was likely meant.
std::string meant_option(const CLI::App& command, const std::vector<std::string>& words) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back(name);
    for (const std::string& word : words) {
        if (word.rfind("--", 0) != 0) continue;
        const std::string name = nearest_name(word.substr(2, word.find('=') - 2), names);
        return name.empty() ? "" : "--" + name;
    }
    return "";
}

std::string what_is_extra(const CLI::App& program) {
    const std::vector<std::string> words = program.remaining(true);
    const std::vector<CLI::App*> called = program.get_subcommands();
    const bool has_commands = !program.get_subcommands({}).empty();
    if (has_commands && called.empty() && !words.empty() && words.front().rfind('-', 0) != 0)
        return no_such_command(program, words.front());
    std::string text;
    for (const std::string& word : words) text += " " + word;
    return "not expected:" + on_one_line(text) +
           did_you_mean(meant_option(called.empty() ? program : *called[0], words));
}

std::string what_of_a_value(const CLI::ParseError& error) {
    const std::string text = on_one_line(error.what());
    const auto option = [&](const char* what) { return text.substr(0, text.find(what)); };
    if (text.find(": 1 required ") != std::string::npos) return option(": 1 required ") + ": needs a value";
    if (text.find(": At Most 1 required ") != std::string::npos)
        return option(": At Most ") + ": is given more than once";
    const std::string at_least = ": At least ";
    if (const std::size_t count = text.find(at_least), end = text.find(" required but received ");
        count < end && end != std::string::npos)
        return option(at_least.c_str()) + ": needs " +
               text.substr(count + at_least.size(), end - count - at_least.size()) +
               " numbers with commas between them";
    return text;
}

} // namespace

std::string what_is_wrong(const CLI::App& program, const CLI::ParseError& error) {
    const bool extra = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
    return extra ? what_is_extra(program) : what_of_a_value(error);
}

std::string no_such_command(const CLI::App& program, const std::string& name) {
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
    return "there is no command '" + on_one_line(name) + "'" + did_you_mean(nearest_name(name, names));
}

} // namespace acdf::tools
