// Libraries of images print what they find wrong to stderr, where the program says one line itself.
#pragma once

namespace acdf::images {

/// Keeps libraries that print to `stderr` from doing so while any of these lives, in any thread. What went to
/// `stderr` before must use a copy of it. Does nothing but with glibc, where `stderr` is a variable.
class Quiet {
public:
    Quiet();
    ~Quiet();
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
};

} // namespace acdf::images
