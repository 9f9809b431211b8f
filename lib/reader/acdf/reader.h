// Loads and checks .acdf files. C++17, no exceptions, no RTTI; needs zlib alone.
//
//   acdf::File file;
//   if (acdf::Status status = acdf::File::open("probe.acdf", file); !status.ok()) { ... status.message ... }
//   acdf::EnvironmentView sky = file.environment();
//   acdf::DirectionSample s = sky.sample(u0, u1);     // s.direction, s.pdf in sr^-1
//   float p = sky.pdf(s.direction);
//
// Safety: `open` and `from_memory` accept any bytes. They check every rule of format/SPEC.md that memory
// safety and a correct density need, in time linear in the size, and never read outside what they are given.
// A file that was accepted can be sampled for ever without reading outside it. Memory: at most four times the
// file and its inflated chunks, and 1 MiB; the limits are checked before any of it is allocated. Runtime tables
// take at most eight times the file and 1 MiB more, and as much again while they are made; LoadOptions leaves them
// out.
#pragma once

#include <acdf/brdf.h>
#include <acdf/local.h>
#include <acdf/sample.h>
#include <acdf/table.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

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
    /// Whether runtime tables are made: draws and densities take a fraction of the time. Without them nothing more
    /// is allocated, and the file's own trees are walked.
    bool tables = true;
};

using DirectionSample = AcdfDirectionSample;

/// A probability density over the sphere. A few words by value; valid while its File (and, for
/// `from_memory`, the bytes) lives. All functions are const, thread-safe, allocate and throw nothing.
class EnvironmentView {
public:
    explicit EnvironmentView(const AcdfEnvironment& data) noexcept : data_(data) {}

    /// Draws a direction; u0 (azimuth) and u1 (elevation) in [0, 1]. pdf in sr^-1, finite, > 0.
    DirectionSample sample(double u0, double u1) const noexcept { return acdf_environment_sample(&data_, u0, u1); }
    /// Density in sr^-1 of a unit direction; 0 where none falls, for NaN and for non-unit directions.
    float pdf(const float direction[3]) const noexcept { return acdf_environment_pdf(&data_, direction); }
    /// The random numbers that draw `direction`; false where the density is 0.
    bool invert(const float direction[3], double u[2]) const noexcept {
        return acdf_environment_invert(&data_, direction, u) != 0;
    }
    /// Integral of the sampled function over the sphere (luminance times sr): for light selection.
    double total() const noexcept { return data_.total; }
    /// Whether the density is 0 where another sampler is to cover the light: used alone it is biased.
    bool needs_company() const noexcept { return data_.company != nullptr; }
    /// Of the samples of both, in (0, 1]: how many to draw from this view; 1 where it is to be used alone.
    float recommended_share() const noexcept { return acdf_company_share(data_.company); }
    /// The plain data, for acdf/sample.h in another language or on a GPU.
    const AcdfEnvironment& data() const noexcept { return data_; }

private:
    AcdfEnvironment data_;
};

/// For each normal a probability density over the sphere that follows the light above its horizon, times the
/// cosine. A few words by value; valid while its File lives. All functions are const, thread-safe, allocate and
/// throw nothing. Normals are of any length > 0, in the frame of directions.
class LocalEnvironmentView {
public:
    explicit LocalEnvironmentView(const AcdfLocal& data) noexcept : data_(data) {}

    /// Draws a direction for a normal; u0 (azimuth) and u1 (elevation) in [0, 1]. pdf in sr^-1, finite and > 0; 0
    /// where the normal is zero or NaN or no light can reach it. A direction may lie below the horizon: it counts
    /// as 0.
    DirectionSample sample(const float normal[3], double u0, double u1) const noexcept {
        return acdf_local_sample(&data_, normal, u0, u1);
    }
    /// Density in sr^-1 of a unit direction for a normal; exactly that of `sample` for what it returned.
    float pdf(const float normal[3], const float direction[3]) const noexcept {
        return acdf_local_pdf(&data_, normal, direction);
    }
    /// Both for a shading point, whose normal is looked up once for all of its samples.
    AcdfLocalPoint at(const float normal[3]) const noexcept {
        AcdfLocalPoint point;
        acdf_local_at(&data_, normal, &point);
        return point;
    }
    DirectionSample sample(const AcdfLocalPoint& point, double u0, double u1) const noexcept {
        return acdf_local_sample_at(&data_, &point, u0, u1);
    }
    float pdf(const AcdfLocalPoint& point, const float direction[3]) const noexcept {
        return acdf_local_pdf_at(&data_, &point, direction);
    }
    /// Integral of the light above the horizon times the cosine (luminance times sr), about: where bins share tiles
    /// the root mean square of an estimate from their samples, interpolated, which is more by a few per cent or by
    /// as much as the samples are noisy; else that of the bin. For light selection. Where a normal's bins are not
    /// stored, that of all light, which is more; 0 for a normal that is zero or NaN.
    double irradiance(const float normal[3]) const noexcept { return acdf_local_irradiance(&data_, normal); }
    /// Whether densities are 0 where another sampler is to cover the light: used alone they are biased.
    bool needs_company() const noexcept { return data_.company != nullptr; }
    /// Of the samples of both at a normal, in (0, 1]: how many to draw from this view; 1 where it is to be used
    /// alone.
    float recommended_share(const float normal[3]) const noexcept {
        return acdf_local_recommended_share(&data_, normal);
    }
    /// Whether a normal has a density of its own; else it is served by that of the whole environment.
    bool stored(const float normal[3]) const noexcept { return acdf_local_stored(&data_, normal) != 0; }
    /// The density of the whole environment, whatever the normal.
    EnvironmentView environment() const noexcept { return EnvironmentView(data_.environment); }
    /// The plain data, for acdf/local.h in another language or on a GPU.
    const AcdfLocal& data() const noexcept { return data_; }

private:
    AcdfLocal data_;
};

/// For each view a probability density over the directions of light that a surface reflects to it, times the
/// cosine. A few words by value; valid while its File lives. All functions are const, thread-safe, allocate and
/// throw nothing. wo (towards the viewer) and wi (towards the light) are unit vectors in the surface's frame, z its
/// normal.
class BrdfView {
public:
    explicit BrdfView(const AcdfBrdf& data) noexcept : data_(data) {}

    /// Draws wi for wo; u0 (azimuth of the half-vector) and u1 (its elevation) in [0, 1]. pdf in sr^-1 of wi,
    /// finite and > 0; 0 where wo is not a unit vector above the surface. wi may lie below it: it counts as 0.
    DirectionSample sample(const float wo[3], double u0, double u1) const noexcept {
        return acdf_brdf_sample(&data_, wo, u0, u1);
    }
    /// Density in sr^-1 of wi for wo; exactly that of `sample` for what it returned, but where wo and wi are so
    /// nearly opposite that their half-vector is lost in rounding.
    float pdf(const float wo[3], const float wi[3]) const noexcept { return acdf_brdf_pdf(&data_, wo, wi); }
    /// The random numbers that draw wi for wo; false where the table's density is 0.
    bool invert(const float wo[3], const float wi[3], double u[2]) const noexcept {
        return acdf_brdf_invert(&data_, wo, wi, u) != 0;
    }
    /// Share of light that is reflected to wo, about: stored views are interpolated. To choose between lobes or
    /// layers.
    double albedo(const float wo[3]) const noexcept { return acdf_brdf_albedo(&data_, wo); }
    /// The plain data, for acdf/brdf.h in another language or on a GPU.
    const AcdfBrdf& data() const noexcept { return data_; }

private:
    AcdfBrdf data_;
};

/// A probability density over the sampled axes of a table, one for each bin of its indexed axes. A few words by
/// value; valid while its File lives. All functions are const, thread-safe, allocate and throw nothing.
/// `index` has one number a indexed axis, in [0, resolution), and may be null where there is none; u and x have one
/// number a sampled axis.
class TableView {
public:
    explicit TableView(const AcdfTable& data) noexcept : data_(data) {}

    std::uint32_t indexed_count() const noexcept { return data_.indexed_count; }
    std::uint32_t sampled_count() const noexcept { return acdf_table_sampled_count(&data_); }
    /// Sampled axis i: its name, range and steps.
    const AcdfAxis& sampled_axis(std::uint32_t i) const noexcept { return data_.axes[data_.indexed_count + i]; }

    /// Draws x, in the units of the axes; u in [0, 1]. Returns the density there, per product of those units,
    /// finite and > 0; 0 (and x unset) where the bin has no energy or an index is out of range.
    double sample(const std::uint32_t* index, const double* u, double* x) const noexcept {
        return acdf_table_sample(&data_, index, u, x);
    }
    /// Density of x; exactly that of `sample` for what it returned. 0 where none falls, outside the axes' ranges
    /// and for NaN.
    double pdf(const std::uint32_t* index, const double* x) const noexcept {
        return acdf_table_pdf(&data_, index, x);
    }
    /// The random numbers that draw x; false where the density is 0.
    bool invert(const std::uint32_t* index, const double* x, double* u) const noexcept {
        return acdf_table_invert(&data_, index, x, u) != 0;
    }
    /// Sum over the bins of the integral of the table over its sampled axes.
    double total() const noexcept { return data_.total; }
    /// Whether densities are 0 where another sampler is to cover the table: used alone they are biased.
    bool needs_company() const noexcept { return data_.company != nullptr; }
    /// Of the samples of both in a bin, in (0, 1]: how many to draw from this view; 1 where it is to be used alone,
    /// or an index is out of range.
    float recommended_share(const std::uint32_t* index) const noexcept {
        const AcdfBin* bin = acdf_table_bin(&data_, index);
        return bin ? acdf_company_bin_share(data_.company, static_cast<std::uint32_t>(bin - data_.bins)) : 1.0f;
    }
    /// What part of `total` a bin holds: to choose a bin by its energy. 0 where an index is out of range.
    double share(const std::uint32_t* index) const noexcept {
        const AcdfBin* bin = acdf_table_bin(&data_, index);
        return bin ? static_cast<double>(bin->share) : 0.0;
    }
    /// The plain data, for acdf/table.h in another language or on a GPU.
    const AcdfTable& data() const noexcept { return data_; }

private:
    AcdfTable data_;
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

    bool empty() const noexcept { return bytes_ == nullptr; }
    // Everything below asks for a file that is not empty.
    AcdfKind kind() const noexcept { return static_cast<AcdfKind>(header().kind); }
    const AcdfHeader& header() const noexcept { return *reinterpret_cast<const AcdfHeader*>(bytes_); }
    const AcdfDescription& description() const noexcept { return *description_; }
    const AcdfAxis& axis(std::uint32_t i) const noexcept { return axes_[i]; }
    const AcdfBin& bin(std::uint32_t i) const noexcept { return bins_[i]; }
    /// Chunk TREE, and its size in units of two bytes, in which offsets in it are counted.
    const std::uint8_t* tree() const noexcept { return tree_; }
    /// What bins share; `tiles` is null where each has a tree of its own.
    const AcdfBlend& blend() const noexcept { return blend_; }
    std::uint32_t tree_units() const noexcept { return tree_units_; }
    std::uint64_t size() const noexcept { return size_; }
    /// What the file is to be combined with; null: it is to be used alone.
    const AcdfCompany* company() const noexcept { return company_; }
    /// Bytes of the runtime tables; 0 where there are none: left out, of no use, or no memory for them.
    std::uint64_t table_bytes() const noexcept {
        return 4 * std::uint64_t{cells_ ? cells_->words : local_tables_ ? local_tables_->words : 0};
    }

    /// Metadata pairs; `count` is 0 where the file carries none.
    std::uint32_t metadata_count() const noexcept { return metadata_count_; }
    void metadata(std::uint32_t i, Text& key, Text& value) const noexcept;
    /// The value of `key`, empty where absent.
    Text metadata(const char* key) const noexcept;

    /// The view of an environment file: only where kind() == ACDF_KIND_ENVIRONMENT.
    EnvironmentView environment() const noexcept;
    /// The view of a local environment file: only where kind() == ACDF_KIND_LOCAL.
    LocalEnvironmentView local() const noexcept;
    /// The view of a BRDF file: only where kind() == ACDF_KIND_BRDF.
    BrdfView brdf() const noexcept;
    /// The view of a table file: only where kind() == ACDF_KIND_TABLE.
    TableView table() const noexcept;

private:
    const std::uint8_t* bytes_ = nullptr;
    std::uint64_t size_ = 0;
    const AcdfDescription* description_ = nullptr;
    const AcdfAxis* axes_ = nullptr;
    const AcdfBin* bins_ = nullptr;
    const std::uint8_t* tree_ = nullptr;
    std::uint32_t tree_units_ = 0;
    AcdfBlend blend_ = {};
    const AcdfLocalHeader* local_ = nullptr;
    const AcdfLight* lights_ = nullptr;
    const AcdfCompany* company_ = nullptr;
    const AcdfViews* views_ = nullptr;
    const float* nodes_ = nullptr;
    const std::uint8_t* metadata_ = nullptr;
    std::uint32_t metadata_count_ = 0;
    AcdfCells* cells_ = nullptr;
    AcdfLocalTables* local_tables_ = nullptr;
    void* owned_[3] = {nullptr, nullptr, nullptr}; // the file's bytes; inflated chunks; runtime tables

    void make_tables() noexcept;
};

} // namespace acdf
