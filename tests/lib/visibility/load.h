// Loading and validating bytes with their visibility cells.
#pragma once

#include "tests/lib/reader/load.h"
#include "visibility/check.h"

#include <acdf/visibility/visibility.h>

namespace acdf_test {

/// As load, and makes the view of a local environment.
inline acdf::Status load_visible(const Bytes& bytes, const acdf::Limits& limits = {}) {
    const Exact exact(bytes);
    acdf::File file;
    acdf::VisibleLocalView view;
    const acdf::Status status =
        acdf::File::from_memory(exact.data(), exact.size(), file, acdf::with_curves(limits));
    return status.ok() ? acdf::VisibleLocalView::of(file, view) : status;
}

/// What the reader finds, and where that is nothing, what its cells and portals break.
inline Findings visible_findings(const Bytes& bytes) {
    Findings out = findings(bytes);
    const Exact exact(bytes);
    acdf::File file;
    if (!acdf::File::from_memory(exact.data(), exact.size(), file, acdf::with_curves()).ok()) return out;
    acdf::validate_visibility(file, Findings::take, &out);
    return out;
}

inline void expect_visible(const Bytes& file) {
    const Findings found = visible_findings(file);
    EXPECT_TRUE(found.rules.empty()) << found.text;
}

} // namespace acdf_test
