// A local environment file with visibility cells, written by hand, and loaded.
#pragma once

#include "tests/lib/reader/local_loaded.h"

#include <acdf/visibility/visibility.h>

namespace acdf_test {

class LoadedVisible {
public:
    explicit LoadedVisible(const NormalsSpec& spec) : loaded_(spec) {
        const acdf::Status status = acdf::VisibleLocalView::of(loaded_.file, view_);
        EXPECT_TRUE(status.ok()) << status.message;
    }
    const acdf::VisibleLocalView& view() const { return view_; }

private:
    LoadedLocal loaded_;
    acdf::VisibleLocalView view_;
};

} // namespace acdf_test
