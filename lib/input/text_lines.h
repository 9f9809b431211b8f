// Lines of numbers in text files.
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <string>

namespace acdf::input {

/// A line without its end. It is gone with the next.
struct TextLine {
    std::uint64_t number = 0; ///< from 1
    const char *begin = nullptr, *end = nullptr;
};

/// Calls `take` with each line of a file, from the top; `what` says in messages what a line is. Throws Error, also
/// for lines of 1 KiB or more.
void for_each_line(const std::string& path, const std::string& what,
                   const std::function<void(const TextLine&)>& take);

/// Reads up to `most` numbers, with blanks or commas between them, and moves `at` to where they end: to `end`, a
/// comment (#) or what is no number.
int read_numbers(const char*& at, const char* end, double* numbers, int most);

/// Whether nothing but blanks, commas and a comment is there.
bool is_blank(const char* at, const char* end);

} // namespace acdf::input
