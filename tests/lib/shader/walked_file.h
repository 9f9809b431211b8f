// A file beside its tables for shaders.
#pragma once

#include <acdf/curves/curves.h>
#include <acdf/shader/tables.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace acdf_test {

/// `status`: whether shaders can traverse it. The reader has no tables of its own.
struct WalkedFile {
    std::vector<std::uint8_t> bytes;
    acdf::File file;
    acdf::ShaderTables tables;
    acdf::Status status;
    explicit WalkedFile(std::vector<std::uint8_t> given) : bytes(std::move(given)) {
        acdf::LoadOptions options;
        options.tables = false;
        const acdf::Status loaded =
            acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves(options));
        EXPECT_TRUE(loaded.ok()) << loaded.message;
        status = acdf::ShaderTables::make(file, tables);
        EXPECT_EQ(status.ok(), tables.size() > 0) << status.message;
    }
    bool local() const { return file.kind() == ACDF_KIND_LOCAL; }
};

} // namespace acdf_test
