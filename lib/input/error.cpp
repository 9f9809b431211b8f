#include "input/error.h"

namespace acdf::input {

Error input_error(const std::string& path, const std::string& what) {
    std::string text = path + ": " + what;
    for (char& c : text)
        if (c == '\n' || c == '\r' || c == '\t') c = ' ';
    return Error(text);
}

} // namespace acdf::input
