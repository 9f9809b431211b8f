// Options that take one of a few names.
#pragma once

#include <CLI/CLI.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace acdf::tools {

/// What an option's value is called.
template <class Value>
struct Named {
    const char* name;
    Value value;
};

/// An option that takes one of `names`, and nothing else; `choose` is called with its index.
CLI::Option* add_choice_of(CLI::App& command, const std::string& option, const std::vector<std::string>& names,
                           const std::function<void(std::size_t)>& choose, const std::string& help);

/// The same of values: into a variable, or by a call.
template <class Value, std::size_t count, class Into>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Into&& into,
                        const Named<Value> (&names)[count], const std::string& help) {
    std::vector<std::string> texts;
    std::array<Value, count> values{};
    for (std::size_t i = 0; i < count; ++i) {
        texts.push_back(names[i].name);
        values[i] = names[i].value;
    }
    if constexpr (std::is_invocable_v<Into, Value>)
        return add_choice_of(
            command, option, texts, [into, values](std::size_t i) { into(values[i]); }, help);
    else
        return add_choice_of(
            command, option, texts, [&into, values](std::size_t i) { into = values[i]; }, help);
}

} // namespace acdf::tools
