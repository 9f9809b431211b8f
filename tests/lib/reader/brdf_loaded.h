// A BRDF made by brdf_builder.h, as the reader sees it.
#pragma once

#include "tests/lib/reader/brdf_builder.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <utility>

namespace acdf_test {

/// A file that must be valid, in memory.
struct Loaded {
    explicit Loaded(Bytes encoded) : bytes(std::move(encoded)) {
        const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
        EXPECT_TRUE(status.ok()) << status.message;
    }
    acdf::BrdfView view() const { return file.brdf(); }
    Bytes bytes; // used in place
    acdf::File file;
};

} // namespace acdf_test
