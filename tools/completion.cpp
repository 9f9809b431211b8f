// acdf completion: scripts with which shells complete commands and options, made of the very tree that parses them.
#include "tools/cli/help.h"
#include "tools/commands.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace acdf::tools {
namespace {

struct Word {
    std::string name, says; // an option or a command, and the first line of its description
    bool value = false;     // whether something follows it
};

struct CommandWords {
    Word command;
    std::vector<Word> options;
};

// The first sentence or line, without what shells read as a part of their own syntax.
std::string short_text(const std::string& text) {
    std::string line = text.substr(0, std::min(text.find('\n'), text.find(". ")));
    if (const std::size_t more = line.find_first_of(";:"); more != std::string::npos) line.resize(more);
    line.erase(std::remove_if(line.begin(), line.end(),
                              [](char c) { return std::string("'\"[]\\`$").find(c) != std::string::npos; }),
               line.end());
    return line;
}

std::vector<Word> option_words(const CLI::App& app) {
    std::vector<Word> words;
    for (const CLI::Option* option : app.get_options()) {
        const bool value = option->get_expected_max() > 0;
        for (const std::string& name : option->get_lnames())
            words.push_back({"--" + name, short_text(option->get_description()), value});
        for (const std::string& name : option->get_snames())
            words.push_back({"-" + name, short_text(option->get_description()), value});
    }
    return words;
}

std::vector<CommandWords> command_words(const CLI::App& program) {
    std::vector<CommandWords> out;
    for (const CLI::App* command : program.get_subcommands({}))
        out.push_back({{command->get_name(), short_text(command->get_description())}, option_words(*command)});
    return out;
}

std::string names(const std::vector<Word>& words) {
    std::string text;
    for (const Word& word : words) text += (text.empty() ? "" : " ") + word.name;
    return text;
}

// Options where the word begins with -, else files; the first word is a command.
std::string bash_script(const CLI::App& program) {
    std::string text = "# bash completion for acdf, made by `acdf completion bash`\n_acdf() {\n"
                       "    local word=${COMP_WORDS[COMP_CWORD]} command= options= commands= i\n"
                       "    COMPREPLY=()\n"
                       "    for ((i = 1; i < COMP_CWORD; ++i)); do\n"
                       "        [[ ${COMP_WORDS[i]} == -* ]] || { command=${COMP_WORDS[i]}; break; }\n"
                       "    done\n    case $command in\n";
    std::vector<Word> all;
    for (const CommandWords& command : command_words(program)) {
        all.push_back(command.command);
        text += "    " + command.command.name + ") options='" + names(command.options) + "' ;;\n";
    }
    text += "    '') options='" + names(option_words(program)) + "' commands='" + names(all) + "' ;;\n    esac\n";
    return text + "    if [[ $word == -* ]]; then\n"
                  "        mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\")\n"
                  "    elif [[ -n $commands ]]; then\n"
                  "        mapfile -t COMPREPLY < <(compgen -W \"$commands\" -- \"$word\")\n"
                  "    fi\n}\ncomplete -o default -o bashdefault -F _acdf acdf\n";
}

std::string zsh_options(const std::vector<Word>& words, const std::string& indent) {
    std::string text;
    for (const Word& word : words)
        text += indent + "'" + word.name +
                (word.value && word.name[1] == '-' ? "="
                 : word.value                      ? "+"
                                                   : "") +
                "[" + word.says + "]" + (word.value ? ":value:_files" : "") + "' \\\n";
    return text;
}

std::string zsh_script(const CLI::App& program) {
    std::string text = "#compdef acdf\n# zsh completion for acdf, made by `acdf completion zsh`\n_acdf() {\n"
                       "    local context state state_descr line\n    typeset -A opt_args\n    _arguments -C \\\n" +
                       zsh_options(option_words(program), "        ") +
                       "        '1:command:->command' '*::argument:->arguments'\n    case $state in\n"
                       "    command)\n        local -a commands=(\n";
    for (const CommandWords& command : command_words(program))
        text += "            '" + command.command.name + ":" + command.command.says + "'\n";
    text += "        )\n        _describe command commands\n        ;;\n    arguments)\n        case $line[1] in\n";
    for (const CommandWords& command : command_words(program))
        text += "        " + command.command.name + ")\n            _arguments \\\n" +
                zsh_options(command.options, "                ") +
                "                '*:file:_files'\n            ;;\n";
    return text + "        esac\n        ;;\n    esac\n}\n"
                  "if [[ $funcstack[1] == _acdf ]]; then _acdf \"$@\"; else compdef _acdf acdf; fi\n";
}

} // namespace

void add_completion(CLI::App& program, int& exit_code) {
    auto shell = std::make_shared<std::string>();
    CLI::App* command = program.add_subcommand("completion", "Print a script with which a shell completes acdf");
    command->add_option("SHELL", *shell, "bash or zsh")
        ->required()
        ->type_name("")
        ->check(CLI::IsMember({"bash", "zsh"}));
    command->footer(help_footer("Packages install these scripts. They are made of the options that this program "
                                "takes.",
                                "source <(acdf completion bash)\n"
                                "acdf completion zsh > ~/.zfunc/_acdf"));
    command->callback([shell, &program, &exit_code] {
        std::fputs((*shell == "bash" ? bash_script(program) : zsh_script(program)).c_str(), stdout);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
