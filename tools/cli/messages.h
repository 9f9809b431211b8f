// What is said to a person: lines on stderr and text on stdout, in which names of files and texts from files cannot
// move the cursor, change colours, end the line or turn what stands beside them.
#pragma once

#include <cstdio>
#include <string>

namespace acdf::tools {

/// `text` with control characters, marks that turn the direction of writing, separators of lines, and bytes that
/// are no UTF-8 written as \x1b and the like. Line ends and tabs stay.
std::string printable(const std::string& text);

/// The same for JSON, where they are written as \u001b: the values stay what they were. `json` is UTF-8.
std::string printable_json(const std::string& json);

/// The same on one line: line ends become spaces.
std::string on_one_line(std::string text);

/// stderr as the program found it: libraries that read images do not get to it (images/openimageio/quiet.h).
std::FILE* to_person();

/// One line on stderr.
void say(const std::string& text);

/// Printable text on stdout.
void put(const std::string& text);

} // namespace acdf::tools
