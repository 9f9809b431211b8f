// acdf help: what `acdf COMMAND --help` prints.
#include "tools/cli/help.h"
#include "tools/cli/usage.h"
#include "tools/commands.h"

#include <cstdio>
#include <memory>
#include <string>
#include <utility>

namespace acdf::tools {

void add_help(CLI::App& program, int& exit_code) {
    auto name = std::make_shared<std::string>();
    CLI::App* command = program.add_subcommand("help", "Explain a command, or list them all");
    command->add_option("COMMAND", *name, "The command; none: all commands")->type_name("");
    command->footer(help_footer("", "acdf help\nacdf help env"));
    command->callback([name, &program, &exit_code] {
        const CLI::App* explained = name->empty() ? &program : nullptr;
        for (const CLI::App* one : std::as_const(program).get_subcommands({}))
            if (one->get_name() == *name) explained = one;
        if (!explained) throw CLI::ValidationError(no_such_command(program, *name));
        const std::string text =
            program.get_formatter()->make_help(explained, explained->get_name(), CLI::AppFormatMode::Normal);
        std::fputs(text.c_str(), stdout);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
