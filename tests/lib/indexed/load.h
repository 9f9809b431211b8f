// Loading and validating bytes, with the maps of those that have some.
#pragma once

#include "tests/lib/reader/load.h"

#include "indexed/check.h"

#include <acdf/indexed/views.h>

namespace acdf_test {

/// Loads and forgets.
inline acdf::Status load_with_maps(const Bytes& bytes, const acdf::Limits& limits = {}) {
    const Exact exact(bytes);
    acdf::File file;
    const acdf::Status status =
        acdf::File::from_memory(exact.data(), exact.size(), file, acdf::with_curves(limits));
    acdf::IndexedEnvironment maps;
    if (!status.ok() || file.kind() != ACDF_KIND_INDEXED) return status;
    return acdf::IndexedEnvironment::open(file, maps);
}

inline Findings findings_with_maps(const Bytes& bytes, const acdf::Limits& limits = {}) {
    Findings out = findings(bytes, limits);
    const Exact exact(bytes);
    acdf::File file;
    if (!acdf::File::from_memory(exact.data(), exact.size(), file, acdf::with_curves(limits)).ok()) return out;
    if (file.kind() != ACDF_KIND_INDEXED) return out;
    acdf::validate_maps(file, Findings::take, &out);
    return out;
}

} // namespace acdf_test
