// The same file with runtime tables and without, for tests that compare the two.
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace acdf_test {

struct TablesPair {
    std::vector<std::uint8_t> bytes;
    acdf::File fast, plain;

    explicit TablesPair(std::vector<std::uint8_t> given) : bytes(std::move(given)) {
        acdf::LoadOptions options;
        options.tables = false;
        EXPECT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), plain, options).ok());
        const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), fast);
        EXPECT_TRUE(status.ok()) << status.message;
        const bool rows = fast.local().data().rows_of_normals || fast.brdf().data().rows_of_views;
        if (rows || fast.kind() == ACDF_KIND_ENVIRONMENT || fast.kind() == ACDF_KIND_INDEXED)
            return; // whose nodes are made in any case
        EXPECT_EQ(plain.table_bytes(), 0u);
        EXPECT_LE(fast.table_bytes(), 8 * fast.size() + (1u << 20));
    }
};

} // namespace acdf_test
