// Runtime tables of local files as large ones have them.
#pragma once

#include <acdf/local.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace acdf_test {

/// A copy of a file's tables without pieces, which large files leave out.
struct NoPieces {
    struct alignas(64) Line {
        std::uint32_t word[16];
    };
    std::vector<Line> lines;
    AcdfLocal local;

    /// Of a file that has tables.
    explicit NoPieces(const AcdfLocal& from) : lines((from.tables->words + 15) / 16), local(from) {
        std::memcpy(lines.data(), from.tables, 4 * std::size_t{from.tables->words});
        reinterpret_cast<AcdfLocalTables*>(lines.data())->pieces = 0;
        local.tables = reinterpret_cast<const AcdfLocalTables*>(lines.data());
    }
};

} // namespace acdf_test
