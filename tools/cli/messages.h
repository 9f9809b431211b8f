// What is said to a person: lines on stderr and text on stdout, in which names of files and texts from files cannot
// move the cursor, change colours or end the line.
#pragma once

#include <cstdio>
#include <string>

namespace acdf::tools {

/// `text` with control characters and bytes that are no UTF-8 told as \x1b and the like. Line ends and tabs stay.
std::string printable(const std::string& text);

/// The same on one line: line ends become spaces.
std::string on_one_line(std::string text);

/// stderr as the program found it: libraries that read images do not get to it (images/openimageio/quiet.h).
std::FILE* to_person();

/// One line on stderr.
void say(const std::string& text);

/// Printable text on stdout.
void put(const std::string& text);

} // namespace acdf::tools
