// The view of a file for programs that have exceptions. Not installed.
#pragma once

#include <acdf/visibility/visibility.h>

#include <stdexcept>

namespace acdf {

/// Throws std::runtime_error where the file is of another kind or its cells break a rule. The file must outlive the
/// view.
inline VisibleLocalView visible_view(const File& file) {
    VisibleLocalView view;
    if (const Status status = VisibleLocalView::of(file, view); !status.ok())
        throw std::runtime_error(status.message);
    return view;
}

} // namespace acdf
