// Options that take one of a few names.
#pragma once

#include <CLI/CLI.hpp>

#include <map>
#include <string>

namespace acdf::tools {

/// One of `names`, and nothing else: not the number behind a name, as CLI::CheckedTransformer would take it.
template <class Value>
CLI::Validator one_of(const std::map<std::string, Value>& names) {
    return CLI::Validator(
        [names](std::string& text) {
            const auto found = names.find(text);
            if (found != names.end()) {
                text = CLI::detail::value_string(found->second);
                return std::string();
            }
            std::string known;
            for (const auto& [name, value] : names) known += (known.empty() ? "" : ", ") + name;
            return "'" + text + "' is none of " + known;
        },
        "");
}

} // namespace acdf::tools
