// A local environment file written by hand, and loaded.
#pragma once

#include "tests/lib/reader/normals_builder.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

namespace acdf_test {

struct LoadedLocal {
    Bytes bytes;
    acdf::File file;

    explicit LoadedLocal(LocalSpec spec) : LoadedLocal(spec.encode()) {}
    explicit LoadedLocal(const NormalsSpec& spec) : LoadedLocal(spec.encode()) {}
    explicit LoadedLocal(Bytes of) : bytes(std::move(of)) {
        const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
        EXPECT_TRUE(status.ok()) << status.message;
    }
    acdf::LocalEnvironmentView view() const { return file.local(); }
    AcdfLocal light() const { return view().data(); }
};

} // namespace acdf_test
