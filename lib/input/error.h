// What is wrong with an input.
#pragma once

#include <stdexcept>
#include <string>

namespace acdf::input {

/// Anything wrong with an input: one line that names the file, what is wrong and what would help.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// "path: what", newlines flattened.
Error input_error(const std::string& path, const std::string& what);

} // namespace acdf::input
