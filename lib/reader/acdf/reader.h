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
// A file that was accepted can be sampled for ever without reading outside it. Libraries beside the reader check
// what they alone read: IndexedEnvironment::open several maps, VisibleLocalView::of visibility cells and portals.
//
// Memory: at most four times the file and its inflated chunks, and 1 MiB; the limits are checked before any of it
// is allocated. Runtime tables take at most eight times the file and 1 MiB more, and as much again while they are
// made. LoadOptions leaves them out.
//
// With tables or without, nodes of halvings take 8 bytes each, at most 16 times their chunk. Local environments and
// BRDFs of halvings keep 4 bytes for each row and split, too. That is 9 times the files that acdf makes, and at
// most 256 times any file (rule 6039).
#pragma once

#include <acdf/file.h>

namespace acdf {

class EnvironmentView;
class LocalEnvironmentView;
class BrdfView;
class TableView;

/// The outcome of loading: a value, never an exception.
struct Status : AcdfError {
    Status() noexcept : AcdfError() {}
    /// Whether the file was loaded.
    bool ok() const noexcept { return code == ACDF_OK; }
};

/// Limits checked before anything is allocated; 0 stands for the default.
struct Limits {
    uint64_t max_file_bytes = uint64_t{1} << 32;
    uint64_t max_inflated_bytes = uint64_t{1} << 30; ///< sum over compressed chunks
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
using Text = AcdfText;

/// A checked file. Movable, not copyable.
class File {
public:
    File() noexcept = default;
    ~File() { acdf_close(opened_); }
    File(File&& other) noexcept : opened_(other.opened_) { other.opened_ = nullptr; }
    File& operator=(File&& other) noexcept {
        AcdfFile* const taken = other.opened_;
        other.opened_ = nullptr;
        acdf_close(opened_);
        opened_ = taken;
        return *this;
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    /// Reads and checks the regular file at `path`. On failure `file` is left empty.
    static Status open(const char* path, File& file, const LoadOptions& options = {}) noexcept {
        Status status;
        const AcdfLoadOptions given = of(options);
        file = File(acdf_open_with(path, &given, &status));
        return status;
    }
    /// Checks `size` bytes at `data`. They are used in place, and must outlive `file`, unless they are not
    /// aligned to 8 bytes (then copied). Compressed chunks are inflated into memory of the file's own.
    static Status from_memory(const void* data, size_t size, File& file, const LoadOptions& options = {}) noexcept {
        Status status;
        const AcdfLoadOptions given = of(options);
        file = File(acdf_from_memory_with(data, size, &given, &status));
        return status;
    }

    /// Whether no file was loaded: then only this may be asked.
    bool empty() const noexcept { return opened_ == nullptr; }
    // Everything below asks for a file that is not empty.
    /// The open file, for functions in C and of rooms beside the reader.
    const AcdfFile* get() const noexcept { return opened_; }
    /// Kind, and the parts of the file as they lie in it; axis i < axis_count. A tree of halvings has no bins.
    AcdfKind kind() const noexcept { return acdf_kind(opened_); }
    const AcdfHeader& header() const noexcept { return *acdf_header(opened_); }
    const AcdfDescription& description() const noexcept { return *acdf_description(opened_); }
    const AcdfAxis& axis(uint32_t i) const noexcept { return *acdf_axis(opened_, i); }
    const AcdfBin& bin(uint32_t i) const noexcept { return *acdf_bin(opened_, i); }
    bool has_bins() const noexcept { return acdf_bin(opened_, 0) != nullptr; }
    uint64_t size() const noexcept { return acdf_size(opened_); }
    /// What the file is to be combined with; null: it is to be used alone.
    const AcdfPartner* partner() const noexcept { return acdf_partner(opened_); }
    /// Bytes of the runtime tables; 0 where there are none: left out, of no use, or no memory for them.
    uint64_t table_bytes() const noexcept { return acdf_table_bytes(opened_); }

    /// Metadata pairs; `count` is 0 where the file carries none.
    uint32_t metadata_count() const noexcept { return acdf_metadata_count(opened_); }
    void metadata(uint32_t i, Text& key, Text& value) const noexcept {
        key = value = {nullptr, 0};
        acdf_metadata_pair(opened_, i, &key, &value);
    }
    /// The value of `key`, empty where absent.
    Text metadata(const char* key) const noexcept { return acdf_metadata_value(opened_, key); }

    /// The view of an environment file (acdf/environment_view.h): only where kind() == ACDF_KIND_ENVIRONMENT.
    EnvironmentView environment() const noexcept;
    // The views of the other kinds are in acdf/views.h.
    /// The view of a local environment file: only where kind() == ACDF_KIND_LOCAL.
    LocalEnvironmentView local() const noexcept;
    /// The view of a BRDF file: only where kind() == ACDF_KIND_BRDF.
    BrdfView brdf() const noexcept;
    /// The view of a table file: only where kind() == ACDF_KIND_TABLE.
    TableView table() const noexcept;
    /// The memory that views point into, to be copied: moves[ACDF_MAX_MOVES], `to` of which are null. Returns how
    /// many there are (acdf/moved.h).
    int memory(AcdfMove* moves) const noexcept { return acdf_memory(opened_, moves); }

private:
    explicit File(AcdfFile* opened) noexcept : opened_(opened) {}
    static AcdfLoadOptions of(const LoadOptions& options) noexcept {
        return {options.limits.max_file_bytes, options.limits.max_inflated_bytes, !options.tables, options.curves,
                options.allocator};
    }
    AcdfFile* opened_ = nullptr;
};

} // namespace acdf
