// Whether an image of 2:1 may be a lat-long map, found while its rows pass by.
#pragma once

#include "input/probe/brightness.h"

#include <string>

namespace acdf::input {

/// Keeps up to 128 rows of an image of any size.
class LatlongCheck {
public:
    LatlongCheck(int width, int height);

    /// Rows `first` to first + count - 1, in any order and as often as wanted.
    void take(int first, int count, const float* rgb);

    /// What speaks against it, once all rows are there, as the end of a sentence that begins with the image's size;
    /// empty where nothing does.
    std::string objection() const;

private:
    int row_of(int kept) const;

    int height_;
    Brightness rows_;
};

} // namespace acdf::input
