// Environments of several maps: which file has them, and the environment at some coordinates. C++17.
//
//   acdf::IndexedEnvironment day; // once
//   if (acdf::Status status = acdf::IndexedEnvironment::open(file, day); !status.ok()) { ... status.message ... }
//   const acdf::MixedEnvironment sky = day.at(9.5, 3.0); // each frame: time and turbidity
//   acdf::DirectionSample s = sky.sample(u0, u1);        // s.direction, s.pdf in sr^-1
//   float p = sky.pdf(s.direction);                      // exactly s.pdf
//
// In kernels an AcdfIndexed that was moved (acdf/indexed/moved.h) makes an AcdfMixed (acdf_indexed_at), and that a
// MixedEnvironment.
#pragma once

#include <acdf/environment_view.h>
#include <acdf/indexed/open.h>
#include <acdf/reader.h>

#include <cstdint>
#include <utility>

namespace acdf {

/// An environment at some coordinates of an IndexedEnvironment: up to eight of its maps, mixed. Half a KiB by
/// value.
class MixedEnvironment : public ViewOf<AcdfMixed> {
public:
    using ViewOf<AcdfMixed>::ViewOf;
    ACDF_METHOD bool empty() const noexcept { return data_.top == nullptr; }

    /// Samples a direction; u0 (azimuth) and u1 (elevation) in [0, 1]. pdf in sr^-1, finite, > 0.
    ACDF_INLINE_METHOD DirectionSample sample(double u0, double u1) const noexcept {
        return acdf_mixed_sample(&data_, u0, u1);
    }
    /// The pdf in sr^-1 of a unit direction; 0 where none falls, for NaN and for non-unit directions.
    ACDF_INLINE_METHOD float pdf(const float direction[3]) const noexcept {
        return acdf_mixed_pdf(&data_, direction);
    }
    /// Random numbers that sample `direction`; false where the pdf is 0.
    ACDF_METHOD bool invert(const float direction[3], double u[2]) const noexcept {
        return acdf_mixed_invert(&data_, direction, u) != 0;
    }
    /// Integral of the sampled function over the sphere, linear between maps.
    ACDF_METHOD double total() const noexcept { return data_.total; }
    /// The share of samples in the cone of the sun; 0 where there is none.
    ACDF_METHOD double sun_share() const noexcept { return data_.sun_share; }
};

/// Environments along one to three axes, such as the hours of a day. Owns its tables; movable, not copyable. It
/// ends with its File, and so does what at() returns, which ends with this, too.
class IndexedEnvironment {
public:
    IndexedEnvironment() noexcept = default;
    ~IndexedEnvironment() { acdf_indexed_close(&data_); }
    IndexedEnvironment(IndexedEnvironment&& other) noexcept : data_(std::exchange(other.data_, AcdfIndexed{})) {}
    IndexedEnvironment& operator=(IndexedEnvironment&& other) noexcept {
        std::swap(data_, other.data_);
        return *this;
    }
    IndexedEnvironment(const IndexedEnvironment&) = delete;
    IndexedEnvironment& operator=(const IndexedEnvironment&) = delete;

    /// The maps of a file that is not empty: checks them and makes tables, in time linear in the bytes of chunk
    /// MAPS, with memory of the file's allocator (acdf_indexed). `out` is empty where that fails: the file is of
    /// another kind, a rule is broken, or there is no memory.
    static Status open(const File& file, IndexedEnvironment& out) noexcept {
        Status status;
        out = IndexedEnvironment();
        acdf_indexed(file.get(), &out.data_, &status);
        return status;
    }

    /// Whether none was opened.
    bool empty() const noexcept { return data_.columns == 0; }
    /// The plain data, for functions in C, and to be moved elsewhere.
    const AcdfIndexed& data() const noexcept { return data_; }
    /// Bytes of the tables, beside those of the file.
    std::uint64_t table_bytes() const noexcept { return data_.tables.bytes; }

    // Everything below asks for one that is not empty.
    /// How many axes there are.
    std::uint32_t axes() const noexcept { return data_.axes; }
    /// The environment at coordinates[axes()], mixed of the maps around them. Beyond the first and the last of an
    /// axis these stand. Takes some microseconds: once a frame.
    MixedEnvironment at(const double* coordinates) const noexcept {
        AcdfMixed out;
        acdf_indexed_at(&data_, coordinates, &out);
        return MixedEnvironment(out);
    }
    /// The same of one, two or three axes: numbers that are left out are of no meaning where the axis is missing.
    MixedEnvironment at(double first, double second = 0.0, double third = 0.0) const noexcept {
        const double coordinates[3] = {first, second, third};
        return at(coordinates);
    }

private:
    AcdfIndexed data_ = {};
};

} // namespace acdf
