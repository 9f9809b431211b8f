// Options of several numbers or names with commas between them.
#pragma once

#include <CLI/CLI.hpp>

namespace acdf::tools {

/// The list is one word: what follows it is the next argument, not more of the list. `count`: so many, which spaces
/// may part as well; 0: any number of them, also by giving the option again.
inline CLI::Option* comma_separated(CLI::Option* option, int count = 0) {
    option->delimiter(',')->type_name("")->allow_extra_args(false);
    if (count > 0) return option->expected(count);
    return option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

} // namespace acdf::tools
