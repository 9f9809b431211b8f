#include "tools/cli/choice.h"

#include <algorithm>

namespace acdf::tools {
namespace {

/// Known names are listed in the order of the alphabet.
std::string none_of(const std::string& text, std::vector<std::string> names) {
    std::sort(names.begin(), names.end());
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    return "'" + text + "' is none of " + known;
}

} // namespace

CLI::Option* add_choice_of(CLI::App& command, const std::string& option, const std::vector<std::string>& names,
                           const std::function<void(std::size_t)>& choose, const std::string& help) {
    const auto index = [names](const std::string& text) {
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), text) - names.begin());
    };
    const auto is_known = [names, index](std::string& text) {
        return index(text) < names.size() ? std::string() : none_of(text, names);
    };
    return command
        .add_option_function<std::string>(
            option, [choose, index](const std::string& text) { choose(index(text)); }, help)
        ->check(CLI::Validator(is_known, ""));
}

} // namespace acdf::tools
