// Loads and checks .acdf files. C++17, no exceptions, no RTTI; needs zlib alone.
//
//   #include <acdf/environment_view.h>
//   acdf::File file;
//   if (acdf::Status status = acdf::File::open("probe.acdf", file); !status.ok()) { ... status.message ... }
//   acdf::EnvironmentView sky = file.environment();
//   acdf::DirectionSample s = sky.sample(u0, u1);     // s.direction, s.pdf in sr^-1
//   float p = sky.pdf(s.direction);
//
// Safety: `open` and `from_memory` accept any bytes. They check every rule of format/SPEC.md that memory
// safety and a correct pdf need, in time linear in the size, and never read outside what they are given.
// A file that was accepted can be sampled for ever without reading outside it.
//
// Memory: at most four times the file and its inflated chunks, and 1 MiB; the limits are checked before any of it
// is allocated. Runtime tables take at most eight times the file and 1 MiB more, and as much again while they are
// made. LoadOptions leaves them out.
//
// With tables or without, nodes of halvings take 8 bytes each, at most 16 times their chunk. Local environments and
// BRDFs of halvings keep 4 bytes for each row and split, too. That is 9 times the files that acdf makes, and at
// most 256 times any file (rule 6039).
#pragma once

#include <acdf/allocator.h>
#include <acdf/layout.h>

#include <cstddef>
#include <cstdint>

struct AcdfCurves;
struct AcdfFile;
#ifndef ACDF_ENVIRONMENT_ONLY
struct AcdfMove;
#endif

namespace acdf {

class EnvironmentView;
#ifndef ACDF_ENVIRONMENT_ONLY
class LocalEnvironmentView;
class BrdfView;
class TableView;
class IndexedEnvironment;
#endif

/// What kind of failure; the numbers are stable.
enum class ErrorCode : int {
    none = 0,
    cannot_open = 1,
    cannot_read = 2,
    out_of_memory = 3,
    limit_exceeded = 4,
    malformed = 5,   ///< breaks a rule of SPEC.md: see Status::rule
    unsupported = 6, ///< a newer or unknown version, kind, feature or critical chunk
};

/// The outcome of loading: a value, never an exception.
struct Status {
    ErrorCode code = ErrorCode::none;
    int rule = 0;             ///< number of the broken rule of SPEC.md, 0 if none
    std::uint64_t offset = 0; ///< byte in the file where it shows
    char message[240] = {};   ///< one line, UTF-8: what is wrong and where

    /// Whether the file was loaded.
    bool ok() const noexcept { return code == ErrorCode::none; }
};

/// Limits checked before anything is allocated.
struct Limits {
    std::uint64_t max_file_bytes = std::uint64_t{1} << 32;
    std::uint64_t max_inflated_bytes = std::uint64_t{1} << 30; ///< sum over compressed chunks
};

/// How a file is loaded.
struct LoadOptions {
    LoadOptions() noexcept = default;
    LoadOptions(const Limits& limits) noexcept : limits(limits) {}

    Limits limits;
    /// Whether runtime tables are made: samples and pdfs take a fraction of the time. Without them nothing
    /// more is allocated, and each call searches the file's own trees from their roots.
    bool tables = true;
    /// Where the memory comes from that an open file keeps; by default the C library. It must stay usable until the
    /// file is gone. What is needed for a moment, while bytes are checked, is the C library's, but for the nodes of
    /// a tree of halvings.
    AcdfAllocator allocator = {};
    /// What reads files of the fits `cdf`, `pdf` and `uniform`: acdf_curves() of acdf/curves/curves.h. Null: such
    /// files are refused as `unsupported`.
    const AcdfCurves* curves = nullptr;
};

/// A key or value of the metadata: UTF-8, not terminated.
struct Text {
    const char* data = nullptr;
    std::size_t size = 0;
};

/// A checked file. Movable, not copyable.
class File {
public:
    File() noexcept = default;
    ~File();
    File(File&& other) noexcept;
    File& operator=(File&& other) noexcept;
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    /// Reads and checks the regular file at `path`. On failure `file` is left empty.
    static Status open(const char* path, File& file, const LoadOptions& options = {}) noexcept;
    /// Checks `size` bytes at `data`. They are used in place, and must outlive `file`, unless they are not
    /// aligned to 8 bytes (then copied). Compressed chunks are inflated into memory of the file's own.
    static Status from_memory(const void* data, std::size_t size, File& file,
                              const LoadOptions& options = {}) noexcept;

    /// Whether no file was loaded: then only this may be asked.
    bool empty() const noexcept { return opened_ == nullptr; }
    // Everything below asks for a file that is not empty.
    /// Kind, and the parts of the file as they lie in it; axis i < axis_count. A tree of halvings has no bins.
    AcdfKind kind() const noexcept;
    const AcdfHeader& header() const noexcept;
    const AcdfDescription& description() const noexcept;
    const AcdfAxis& axis(std::uint32_t i) const noexcept;
    const AcdfBin& bin(std::uint32_t i) const noexcept;
    bool has_bins() const noexcept;
    std::uint64_t size() const noexcept;
    /// The same file for functions in C.
    const AcdfFile* c_file() const noexcept { return opened_; }
    /// What the file is to be combined with; null: it is to be used alone.
    const AcdfPartner* partner() const noexcept;
    /// Bytes of the runtime tables; 0 where there are none: left out, of no use, or no memory for them.
    std::uint64_t table_bytes() const noexcept;

    /// Metadata pairs; `count` is 0 where the file carries none.
    std::uint32_t metadata_count() const noexcept;
    void metadata(std::uint32_t i, Text& key, Text& value) const noexcept;
    /// The value of `key`, empty where absent.
    Text metadata(const char* key) const noexcept;

    /// The view of an environment file (acdf/environment_view.h): only where kind() == ACDF_KIND_ENVIRONMENT.
    EnvironmentView environment() const noexcept;
#ifndef ACDF_ENVIRONMENT_ONLY
    // The views of the other kinds are in acdf/views.h.
    /// The view of a local environment file: only where kind() == ACDF_KIND_LOCAL.
    LocalEnvironmentView local() const noexcept;
    /// The view of a BRDF file: only where kind() == ACDF_KIND_BRDF.
    BrdfView brdf() const noexcept;
    /// The view of a table file: only where kind() == ACDF_KIND_TABLE.
    TableView table() const noexcept;
    /// The view of an environment of several maps: only where kind() == ACDF_KIND_INDEXED.
    IndexedEnvironment indexed() const noexcept;
    /// The memory that views point into, to be copied: moves[ACDF_MAX_MOVES], `to` of which are null. Returns how
    /// many there are (acdf/moved.h).
    int memory(AcdfMove* moves) const noexcept;
#endif

private:
    AcdfFile* opened_ = nullptr;
};

} // namespace acdf
