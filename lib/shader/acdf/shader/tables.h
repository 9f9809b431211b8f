// Words for a shader's buffer or texture, from which `acdf/shader/walk.h` and `acdf/shader/brdf.h` sample;
// `acdf export` writes them, too.
#pragma once

#include <acdf/reader.h>
#include <acdf/shader/brdf.h>
#include <acdf/views.h>

namespace acdf {

/// The tables of one file, which outlive it. They are offsets and never addresses: they may be copied
/// anywhere, aligned to four bytes, and tables of several files may stand one after the other in one buffer.
class ShaderTables {
public:
    ShaderTables() noexcept = default;
    ~ShaderTables();
    ShaderTables(ShaderTables&& other) noexcept;
    ShaderTables& operator=(ShaderTables&& other) noexcept;
    ShaderTables(const ShaderTables&) = delete;
    ShaderTables& operator=(const ShaderTables&) = delete;

    /// Makes the tables of `acdf/shader/walk.h` of a file that is not empty: of environments and local
    /// environments, on either grid. Of several maps those of acdf/shader/maps.h, of BRDFs those of
    /// acdf/shader/brdf.h. `unsupported` where there are none: for tables, and for the fits that have curves.
    /// `out` then is empty. Work and memory are in proportion to the cells, some 60 bytes each, and rows.
    /// Visibility cells are left out: a normal is served alike at every position.
    static Status make(const File& file, ShaderTables& out) noexcept;

    /// Little-endian, as a GPU takes them.
    const std::uint32_t* words() const noexcept { return static_cast<const std::uint32_t*>(block_.data); }
    /// How many; 0: empty.
    std::size_t size() const noexcept { return block_.data ? words()[0] : 0; }

private:
    AcdfBlock block_ = {};
};

} // namespace acdf
